#include "query_mesh.h"

#include <utility>

#include "bullet_plugin/core/scene/morton_order.h"
#include "bullet_plugin/core/queries/refit.h"

namespace drape
{
namespace
{
// Adds the edges and numbers those that are kept, which stay in the given order.
void addNumberedEdges(Topology& topology, const MeshDescription& description)
{
    std::size_t kept = topology.m_triangles.size();
    addEdges(topology, description.m_edges, description.m_edgeCount);
    for (std::size_t i = 0; i < description.m_edgeCount && kept < topology.m_triangles.size(); ++i)
    {
        const std::uint32_t* const vertices = topology.m_triangles[kept].m_vertices;
        if (vertices[0] != std::uint32_t(description.m_edges[2 * i]) ||
            vertices[1] != std::uint32_t(description.m_edges[2 * i + 1]))
            continue;
        topology.m_sourceTriangle[kept++] = std::uint32_t(description.m_triangleCount + i);
    }
}

QueryMesh makeMesh(Topology topology, const MeshDescription& description, const float* end)
{
    QueryMesh mesh;
    mesh.m_topology = std::move(topology);
    mesh.m_order = mortonOrderOnHost(mesh.m_topology.m_triangles, description.m_positions);
    mesh.m_layout = makeBvhLayout(std::uint32_t(mesh.m_order.size()));
    mesh.m_nodes = makeBvhNodes(mesh.m_layout);
    mesh.m_start = description.m_positions;
    mesh.m_end = end;
    return mesh;
}

Topology topologyOf(const MeshDescription& description)
{
    return buildTopology(description.m_triangles, description.m_triangleCount, description.m_vertexCount);
}
}  // namespace

QueryMesh makeQueryMesh(const MeshDescription& description, const float* end)
{
    return makeMesh(topologyOf(description), description, end);
}

QueryMesh makeQueryMeshWithEdges(const MeshDescription& description, const float* end)
{
    Topology topology = topologyOf(description);
    addNumberedEdges(topology, description);
    return makeMesh(std::move(topology), description, end);
}

void refitBoth(QueryMesh& a, QueryMesh& b, float radius)
{
    const MeshRadii radii(a, b, radius);
    a.refit(radii.m_a);
    if (&a != &b) b.refit(radii.m_b);
}

std::uint32_t walkOf(const QueryMesh& a, const QueryMesh& b)
{
    return &a == &b ? DRAPE_WALK_SELF_APART : DRAPE_WALK_OTHER;
}

void QueryMesh::refit(float radius)
{
    std::size_t ignored = 0;  // bad vertices make no pairs
    refitOnHost(m_nodes, m_layout, m_order, m_topology.m_triangles, m_start, m_end, {radius}, ignored);
}
}  // namespace drape
