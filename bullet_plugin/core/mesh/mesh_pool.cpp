#include "mesh_pool.h"

#include <algorithm>
#include <utility>

namespace drape
{
void MeshPool::add(PooledMesh mesh)
{
    m_ids.push_back(mesh.m_id);
    m_meshes.push_back(std::move(mesh));
    m_changed = true;
}

bool MeshPool::remove(MeshId id)
{
    const std::size_t found = slot(id);
    if (found == m_meshes.size()) return false;
    m_meshes.erase(m_meshes.begin() + std::ptrdiff_t(found));
    m_ids.erase(m_ids.begin() + std::ptrdiff_t(found));
    m_changed = true;
    return true;
}

std::size_t MeshPool::slot(MeshId id) const
{
    // Ids are handed out in rising order and meshes keep it.
    const auto found = std::lower_bound(m_ids.begin(), m_ids.end(), id);
    return found != m_ids.end() && *found == id ? std::size_t(found - m_ids.begin()) : m_ids.size();
}

std::size_t MeshPool::slotOfVertex(std::uint32_t vertex) const
{
    if (m_meshes.size() == 1) return 0;
    const auto after = std::upper_bound(m_meshes.begin(), m_meshes.end(), vertex,
                                        [](std::uint32_t v, const PooledMesh& mesh) { return v < mesh.m_firstVertex; });
    return std::size_t(after - m_meshes.begin()) - 1;
}

std::size_t MeshPool::slotOfEdge(std::uint32_t edge) const
{
    if (m_meshes.size() == 1) return 0;
    const auto after = std::upper_bound(m_meshes.begin(), m_meshes.end(), edge,
                                        [](std::uint32_t e, const PooledMesh& mesh) { return e < mesh.m_firstEdge; });
    return std::size_t(after - m_meshes.begin()) - 1;
}

void MeshPool::update()
{
    if (!m_changed) return;
    m_changed = false;
    ++m_revision;
    m_triangles.clear();
    m_edges.clear();
    m_order.clear();
    m_firsts.clear();
    m_vertexCount = 0;
    for (std::size_t slot = 0; slot < m_meshes.size(); ++slot)
    {
        PooledMesh& mesh = m_meshes[slot];
        mesh.m_firstVertex = std::uint32_t(m_vertexCount);
        mesh.m_firstTriangle = std::uint32_t(m_triangles.size());
        mesh.m_firstEdge = std::uint32_t(m_edges.size());
        m_firsts.push_back(MeshFirsts{mesh.m_firstVertex, mesh.m_firstTriangle, mesh.m_firstEdge});
        for (Triangle triangle : mesh.m_topology.m_triangles)
        {
            for (std::uint32_t& vertex : triangle.m_vertices)
                vertex += mesh.m_firstVertex;
            for (std::uint32_t& edge : triangle.m_edges)
                edge += mesh.m_firstEdge;
            triangle.m_mesh = std::uint32_t(slot);
            m_triangles.push_back(triangle);
        }
        for (Edge edge : mesh.m_topology.m_edges)
        {
            for (std::uint32_t& vertex : edge.m_vertices)
                vertex += mesh.m_firstVertex;
            for (std::uint32_t& vertex : edge.m_opposite)
                vertex += mesh.m_firstVertex;
            m_edges.push_back(edge);
        }
        for (std::uint32_t triangle : mesh.m_order)
            m_order.push_back(triangle + mesh.m_firstTriangle);
        m_vertexCount += mesh.m_topology.m_vertexCount;
    }
}

void MeshPool::reorder(std::vector<std::uint32_t> order)
{
    m_order = std::move(order);
    ++m_revision;
}
}  // namespace drape
