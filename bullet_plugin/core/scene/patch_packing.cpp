#include "patch_packing.h"

#include <algorithm>

#include "patch_width.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
}  // namespace

void PatchPacking::create(Device& device, const cl::Program& program)
{
    m_packFaces.create(device, program);
    m_packVertices.create(device, program);
    m_packEdges.create(device, program);
    m_packVolumes.create(device, program);
    m_widen.create(device, program);
}

void PatchPacking::setTopology(Device& device, const MeshPool& obstacles, std::size_t firstSlot)
{
    const std::uint32_t lanes = patchWidth(device);
    keepPatches(m_layout, firstSlot, lanes);
    const std::size_t patches = m_layout.m_patches.size();
    const PatchLanes kept = {
        {0, m_layout.m_faceOwners.size()}, {0, m_layout.m_vertexOwners.size()}, {0, m_layout.m_edgeOwners.size()}};
    for (std::size_t slot = firstSlot; slot < obstacles.meshCount(); ++slot)
        appendPatches(m_layout, obstacles, slot, obstacles.mesh(slot).m_positions.data(), lanes);
    makeLevels(m_layout, lanes);
    m_levelsMoved = true;
    demandRoom(device, patches, kept);
    m_patches.append(device, m_layout.m_patches, patches);
    m_levels.append(device, m_layout.m_levels);
    m_faceIds.append(device, m_layout.m_faceOwners, kept.m_faces.m_last);
    if (device.isGpu()) m_faceFeatures.append(device, m_layout.m_faceFeatures, kept.m_faces.m_last);
    m_vertexOwnersHeld.m_last = std::min(m_vertexOwnersHeld.m_last, kept.m_vertices.m_last);
    m_edgeOwnersHeld.m_last = std::min(m_edgeOwnersHeld.m_last, kept.m_edges.m_last);
}

// patches, kept: the patches and lanes that stay.
void PatchPacking::demandRoom(Device& device, std::size_t patches, const PatchLanes& kept)
{
    const std::uint32_t lanes = patchWidth(device);
    const std::size_t faces = kept.m_faces.m_last, vertices = kept.m_vertices.m_last, edges = kept.m_edges.m_last;
    m_patches.demand(m_layout.m_patches.size(), patches);
    m_sizes.demand(m_layout.m_patches.size(), patches);
    // A vector of lanes is loaded from it; some of them lie behind the last patch's.
    m_volumes.demand(device.isGpu() ? 1 : m_layout.m_patches.size() * DRAPE_WIDE_NODE_FLOATS + lanes,
                     patches * DRAPE_WIDE_NODE_FLOATS);
    // Keeps the lowest level, which comes first: one position per patch, in nodes of `lanes` patches.
    m_wideNodes.demand(m_layout.m_levels.back() * DRAPE_WIDE_NODE_FLOATS * lanes,
                       (patches + lanes - 1) / lanes * lanes * DRAPE_WIDE_NODE_FLOATS);
    m_levels.demand(m_layout.m_levels.size());
    m_faces.demand(m_layout.m_faceOwners.size() * DRAPE_FACE_FLOATS, faces * DRAPE_FACE_FLOATS);
    m_vertices.demand(m_layout.m_vertexOwners.size() * DRAPE_VERTEX_FLOATS, vertices * DRAPE_VERTEX_FLOATS);
    m_edges.demand(m_layout.m_edgeOwners.size() * DRAPE_EDGE_FLOATS, edges * DRAPE_EDGE_FLOATS);
    m_faceIds.demand(m_layout.m_faceOwners.size(), faces);
    m_vertexIds.demand(m_layout.m_vertexOwners.size(), vertices);
    m_edgeIds.demand(m_layout.m_edgeOwners.size(), edges);
    m_faceFeatures.demand(device.isGpu() ? m_layout.m_faceOwners.size() : 1, faces);
    m_arena.make(device);
}

void PatchPacking::releasePacking()
{
    m_vertexOwners.release();
    m_edgeOwners.release();
    m_vertexOwnersHeld = m_edgeOwnersHeld = {0, 0};
}

void PatchPacking::bringOwners(Device& device, ItemRange vertices, ItemRange edges)
{
    const auto bring =
        [&](Buffer<cl_uint>& buffer, const std::vector<std::uint32_t>& owners, ItemRange& held, ItemRange wanted)
    {
        if (held.m_first <= wanted.m_first && wanted.m_last <= held.m_last) return;
        ItemRange all = wanted;
        if (!held.empty()) all = {std::min(held.m_first, wanted.m_first), std::max(held.m_last, wanted.m_last)};
        buffer.extend(device, all.m_last, held.empty() ? 0 : held.m_last);
        // Uploads the whole range again if it grows at its beginning.
        const std::size_t first = held.empty() || all.m_first < held.m_first ? all.m_first : held.m_last;
        buffer.write(device, owners.data() + first, all.m_last - first, first);
        held = all;
    };
    bring(m_vertexOwners, m_layout.m_vertexOwners, m_vertexOwnersHeld, vertices);
    bring(m_edgeOwners, m_layout.m_edgeOwners, m_edgeOwnersHeld, edges);
}

void PatchPacking::pack(Device& device, SlotRange slots, const ObstacleBuffers& obstacles)
{
    const ItemRange patches = patchesOf(m_layout, slots);
    if (m_layout.m_patches.empty() || (patches.count() == 0 && !m_levelsMoved)) return;
    if (patches.count() > 0) packFeatures(device, patches, obstacles);
    packVolumes(device, patches, obstacles);
    m_levelsMoved = false;
}

PackValues PatchPacking::packValues(const ObstacleBuffers& obstacles, ItemRange range, std::size_t count) const
{
    return {obstacles.m_layout, layout(), range.first(), range.last(), cl_uint(count)};
}

void PatchPacking::packFeatures(Device& device, ItemRange patches, const ObstacleBuffers& obstacles)
{
    const PatchLanes lanes = lanesOf(m_layout, patches, patchWidth(device));
    bringOwners(device, lanes.m_vertices, lanes.m_edges);
    m_packFaces.launch(device, lanes.m_faces.count(), kGroup, packValues(obstacles, lanes.m_faces, 0),
                       obstacles.m_geometry, m_arena);
    m_packVertices.launch(device, lanes.m_vertices.count(), kGroup, packValues(obstacles, lanes.m_vertices, 0),
                          m_vertexOwners, obstacles.m_geometry, m_arena);
    m_packEdges.launch(device, lanes.m_edges.count(), kGroup, packValues(obstacles, lanes.m_edges, 0), m_edgeOwners,
                       obstacles.m_geometry, m_arena);
}

// Packs the volumes of the patches and of the wide nodes above them.
void PatchPacking::packVolumes(Device& device, ItemRange patches, const ObstacleBuffers& obstacles)
{
    for (const LevelPlaces& changed : changedPlaces(m_layout, patches, m_levelsMoved, patchWidth(device)))
    {
        const ItemRange entries = changed.m_entries;
        if (changed.m_level == 0)
        {
            m_packVolumes.launch(device, entries.count(), kGroup, packValues(obstacles, entries, changed.m_children),
                                 obstacles.m_geometry, m_arena);
            continue;
        }
        const WidenValues values = {m_wideNodes.word(),
                                    m_layout.m_levels[changed.m_level - 1],
                                    cl_uint(changed.m_children),
                                    m_layout.m_levels[changed.m_level],
                                    entries.first(),
                                    entries.last()};
        m_widen.launch(device, entries.count() * DRAPE_WIDE_NODE_FLOATS, kGroup, values, m_arena);
    }
}

PatchLayout PatchPacking::layout() const
{
    return {
        m_patches.word(),     m_sizes.word(),     m_volumes.word(),
        m_wideNodes.word(),   m_levels.word(),    cl_uint(m_layout.m_levels.empty() ? 0 : m_layout.m_levels.size() - 1),
        m_faces.word(),       m_vertices.word(),  m_edges.word(),
        m_faceIds.word(),     m_vertexIds.word(), m_edgeIds.word(),
        m_faceFeatures.word()};
}

PatchBuffers PatchPacking::patches() const
{
    return {m_arena, layout(), m_layout.m_patches.size()};
}
}  // namespace drape
