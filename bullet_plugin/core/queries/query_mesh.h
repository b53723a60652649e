// A mesh for the queries' stages: topology, leaf order and hierarchy, on the host.
#pragma once

#include <vector>

#include "bullet_plugin/core/scene/topology.h"
#include "bullet_plugin/core/queries/self_collision.h"
#include "drape/mesh_description.h"

namespace drape
{
struct QueryMesh
{
    Topology m_topology;
    std::vector<std::uint32_t> m_order;
    BvhLayout m_layout;
    std::vector<BvhNode> m_nodes;  // volumes empty until the host refits them
    const float* m_start = nullptr;
    const float* m_end = nullptr;  // equal to the start for a mesh at rest

    HostTree tree() const { return {m_nodes, m_layout, m_order, m_topology.m_triangles}; }
    // Volumes grown by the radius.
    void refit(float radius);
};

// Growth (m) of two meshes' volumes that makes them overlap wherever the meshes come within the radius; a and b may
// be the same mesh.
struct MeshRadii
{
    MeshRadii(const QueryMesh& a, const QueryMesh& b, float radius)
        : m_a(&a == &b ? 0.5f * radius : radius), m_b(&a == &b ? m_a : 0.0f)
    {
    }
    float m_a, m_b;
};

// Refits both meshes on the host with these radii.
void refitBoth(QueryMesh& a, QueryMesh& b, float radius);

// Returns which triangle pairs are queried: DRAPE_WALK_…
std::uint32_t walkOf(const QueryMesh& a, const QueryMesh& b);

// Makes the mesh without the description's edges. Does not copy positions.
QueryMesh makeQueryMesh(const MeshDescription& description, const float* end);

// Makes the mesh with its edges, as triangles without area, numbered behind the triangles.
QueryMesh makeQueryMeshWithEdges(const MeshDescription& description, const float* end);
}  // namespace drape
