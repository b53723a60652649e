#include "cloth_store.h"

#include "bullet_plugin/core/scene/patch_width.h"
#include "bullet_plugin/core/scene/patches.h"

namespace drape
{
namespace
{
// Number of floats whose transfer takes less time than the start of a transfer.
constexpr std::size_t kFloatsBetween = 1 << 16;
}  // namespace

void ClothStore::forget()
{
    m_revision = 0;
    m_sentRadius.clear();
    m_sentThickness.clear();
}

void ClothStore::update(Device& device, const Scene& scene)
{
    const MeshPool& cloths = scene.m_cloths;
    const std::size_t slot = cloths.firstSince(m_revision);
    const MeshOffsets first = cloths.begin(slot);
    m_revision = cloths.revision();
    // Neighbouring triangles are adjacent: packets of them traverse together.
    clusterMeshes(cloths, slot, patchWidth(device), m_clustered);
    m_triangles.demand(cloths.triangles().size(), first.m_triangle);
    m_edges.demand(cloths.edges().size(), first.m_edge);
    m_order.demand(m_clustered.size(), first.m_triangle);
    m_topology.make(device);
    m_triangles.append(device, cloths.triangles(), first.m_triangle);
    m_edges.append(device, cloths.edges(), first.m_edge);
    m_order.append(device, m_clustered, first.m_triangle);
    const std::size_t room = scene.m_clothNodes.room();
    m_nodes.reserve(device, 2 * room);
    m_layout = {m_triangles.word(),
                m_edges.word(),
                m_order.word(),
                cl_uint(room),
                cl_uint(cloths.vertexCount()),
                cl_uint(cloths.triangles().size()),
                cl_uint(cloths.edges().size())};
}

void ClothStore::writeNodes(Device& device, const Scene& scene, std::size_t first, std::size_t count)
{
    const ClothNodes& nodes = scene.m_clothNodes;
    // Transfers start and end together if the gap between them takes less time than a second transfer.
    if (count == scene.m_cloths.vertexCount() && nodes.room() - 3 * count <= kFloatsBetween)
    {
        m_nodes.write(device, nodes.start(), nodes.room() + 3 * count);
        return;
    }
    m_nodes.write(device, nodes.start() + 3 * first, 3 * count, 3 * first);
    m_nodes.write(device, nodes.end() + 3 * first, 3 * count, nodes.room() + 3 * first);
}

void ClothStore::writePairs(Device& device, const StepPairs& pairs)
{
    if (m_sentThickness != pairs.m_thickness)
    {
        m_sentThickness = pairs.m_thickness;
        m_thickness.assign(device, m_sentThickness);
    }
    if (!pairs.m_motions.empty())
    {
        m_sentMotions = pairs.m_motions;
        m_motions.assign(device, m_sentMotions);
    }
    else
        m_motions.reserve(device, 1);
    if (m_sentRadius != pairs.m_clothRadius)
    {
        m_sentRadius = pairs.m_clothRadius;
        m_radius.assign(device, m_sentRadius);
    }
}
}  // namespace drape
