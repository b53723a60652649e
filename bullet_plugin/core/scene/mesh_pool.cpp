#include "mesh_pool.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "growing_arrays.h"

namespace drape
{
namespace
{
// Vacant slots that are always kept, whatever their size: each costs an entry in every table of meshes.
constexpr std::size_t kVacantKept = 64;
}  // namespace

bool anyTriangleIn(const PooledMesh& mesh, const float low[3], const float high[3])
{
    for (int axis = 0; axis < 3; ++axis)
        if (!(mesh.m_box.m_low[axis] <= high[axis] && mesh.m_box.m_high[axis] >= low[axis])) return false;
    const float* const positions = mesh.m_positions.data();
    const auto reachesIn = [&](const Triangle& triangle)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const float a = positions[3 * std::size_t(triangle.m_vertices[0]) + axis];
            const float b = positions[3 * std::size_t(triangle.m_vertices[1]) + axis];
            const float c = positions[3 * std::size_t(triangle.m_vertices[2]) + axis];
            if (std::min(std::min(a, b), c) > high[axis] || std::max(std::max(a, b), c) < low[axis]) return false;
        }
        return true;
    };
    return std::any_of(mesh.m_topology.m_triangles.begin(), mesh.m_topology.m_triangles.end(), reachesIn);
}

void MeshPool::add(PooledMesh mesh)
{
    m_triangleCount += mesh.m_topology.m_triangles.size();
    m_faceCount += mesh.m_topology.m_faceCount;
    m_ids.push_back(mesh.m_id);
    m_meshes.push_back(std::move(mesh));
    m_changed = true;
}

bool MeshPool::remove(MeshId id)
{
    const std::size_t found = slot(id);
    if (found == m_meshes.size()) return false;
    PooledMesh& mesh = m_meshes[found];
    mesh.m_vacant = true;
    m_vacantTriangles += mesh.m_topology.m_triangles.size();
    m_faceCount -= mesh.m_topology.m_faceCount;
    ++m_vacantCount;
    return true;
}

bool MeshPool::hasWideGaps() const
{
    const std::size_t present = m_meshes.size() - m_vacantCount;
    return m_vacantTriangles > presentTriangles() || m_vacantCount > present + kVacantKept ||
           (m_vacantCount > 0 && present == 0);
}

void MeshPool::forget(const PooledMesh& vacant)
{
    m_triangleCount -= vacant.m_topology.m_triangles.size();
    m_vacantTriangles -= vacant.m_topology.m_triangles.size();
    --m_vacantCount;
}

void MeshPool::closeGaps()
{
    std::size_t kept = 0;
    for (std::size_t slot = 0; slot < m_meshes.size(); ++slot)
    {
        if (m_meshes[slot].m_vacant)
        {
            forget(m_meshes[slot]);
            m_placed = std::min(m_placed, kept);
            continue;
        }
        if (kept != slot) m_meshes[kept] = std::move(m_meshes[slot]);
        m_ids[kept++] = m_ids[slot];
    }
    m_meshes.resize(kept);
    m_ids.resize(kept);
    m_changed = true;
}

void MeshPool::dropLastVacant()
{
    std::size_t kept = m_placed;
    while (kept > 0 && m_meshes[kept - 1].m_vacant)
        forget(m_meshes[--kept]);
    const auto erase = [&](auto& all)
    { all.erase(all.begin() + std::ptrdiff_t(kept), all.begin() + std::ptrdiff_t(m_placed)); };
    erase(m_meshes);
    erase(m_ids);
    m_placed = kept;
}

std::size_t MeshPool::slot(MeshId id) const
{
    // Ids are given in rising order, and meshes keep that order: they are consecutive until a mesh is removed.
    std::size_t slot = m_ids.empty() ? 0 : std::size_t(id) - std::size_t(m_ids.front());
    if (slot >= m_ids.size() || m_ids[slot] != id)
        slot = std::size_t(std::lower_bound(m_ids.begin(), m_ids.end(), id) - m_ids.begin());
    return slot < m_ids.size() && m_ids[slot] == id && !m_meshes[slot].m_vacant ? slot : m_ids.size();
}

std::size_t MeshPool::existingSlot(MeshId id) const
{
    const std::size_t found = slot(id);
    assert(found < meshCount());
    return found;
}

std::size_t MeshPool::slotOfVertex(std::uint32_t vertex) const
{
    if (m_placed == 1) return 0;
    const auto after = std::upper_bound(m_meshes.begin(), m_meshes.begin() + std::ptrdiff_t(m_placed), vertex,
                                        [](std::uint32_t v, const PooledMesh& mesh) { return v < mesh.m_firstVertex; });
    return std::size_t(after - m_meshes.begin()) - 1;
}

std::size_t MeshPool::slotOfEdge(std::uint32_t edge) const
{
    if (m_placed == 1) return 0;
    const auto after = std::upper_bound(m_meshes.begin(), m_meshes.begin() + std::ptrdiff_t(m_placed), edge,
                                        [](std::uint32_t e, const PooledMesh& mesh) { return e < mesh.m_firstEdge; });
    return std::size_t(after - m_meshes.begin()) - 1;
}

std::size_t MeshPool::firstSince(std::uint32_t revision) const
{
    // Slots are placed in order, so m_joined is sorted.
    const auto later = [](std::uint32_t r, const PooledMesh& mesh) { return r < mesh.m_joined; };
    return std::size_t(std::upper_bound(m_meshes.begin(), m_meshes.end(), revision, later) - m_meshes.begin());
}

MeshOffsets MeshPool::begin(std::size_t slot) const
{
    if (slot < m_firsts.size()) return m_firsts[slot];
    return MeshOffsets{std::uint32_t(m_vertexCount), std::uint32_t(m_triangles.size()), std::uint32_t(m_edges.size())};
}

void MeshPool::join(std::size_t slot)
{
    PooledMesh& mesh = m_meshes[slot];
    mesh.m_joined = m_revision;
    mesh.m_firstVertex = std::uint32_t(m_vertexCount);
    mesh.m_firstTriangle = std::uint32_t(m_triangles.size());
    mesh.m_firstEdge = std::uint32_t(m_edges.size());
    m_firsts.push_back(MeshOffsets{mesh.m_firstVertex, mesh.m_firstTriangle, mesh.m_firstEdge});
    for (Triangle triangle : mesh.m_topology.m_triangles)
    {
        for (std::uint32_t& vertex : triangle.m_vertices)
            vertex += mesh.m_firstVertex;
        for (std::uint32_t& edge : triangle.m_edges)
            edge += mesh.m_firstEdge;
        triangle.m_mesh = std::uint32_t(slot);
        m_triangles.push_back(triangle);
    }
    reserveGrowing(m_edges, m_edges.size() + mesh.m_topology.m_edges.size());
    for (Edge edge : mesh.m_topology.m_edges)
    {
        for (std::uint32_t& vertex : edge.m_vertices)
            vertex += mesh.m_firstVertex;
        for (std::uint32_t& vertex : edge.m_opposite)
            vertex += mesh.m_firstVertex;
        m_edges.push_back(edge);
    }
    m_vertexCount += mesh.m_topology.m_vertexCount;
}

void MeshPool::update()
{
    if (hasWideGaps()) closeGaps();
    if (!m_changed) return;
    m_changed = false;
    ++m_revision;
    dropLastVacant();
    const MeshOffsets end = begin(m_placed);
    m_vertexCount = end.m_vertex;
    m_triangles.resize(end.m_triangle);
    m_edges.resize(end.m_edge);
    m_firsts.resize(m_placed);
    reserveGrowing(m_triangles, m_triangleCount);
    for (std::size_t slot = m_placed; slot < m_meshes.size(); ++slot)
        join(slot);
    m_placed = m_meshes.size();
}

void MeshPool::giveBackRoom()
{
    shrinkSparse(m_meshes);
    shrinkSparse(m_ids);
    shrinkSparse(m_triangles);
    shrinkSparse(m_edges);
    shrinkSparse(m_firsts);
}
}  // namespace drape
