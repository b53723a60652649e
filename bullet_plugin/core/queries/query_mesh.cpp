#include "query_mesh.h"

#include "bullet_plugin/core/bvh/morton_order.h"
#include "bullet_plugin/core/bvh/refit.h"

namespace drape
{
QueryMesh makeQueryMesh(const MeshDescription& description, const float* end)
{
    QueryMesh mesh;
    mesh.m_topology = buildTopology(description.m_triangles, description.m_triangleCount, description.m_vertexCount);
    mesh.m_order = mortonOrderOnHost(mesh.m_topology.m_triangles, description.m_positions);
    mesh.m_layout = makeBvhLayout(std::uint32_t(mesh.m_order.size()));
    mesh.m_nodes = makeBvhNodes(mesh.m_layout);
    mesh.m_start = description.m_positions;
    mesh.m_end = end;
    return mesh;
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
