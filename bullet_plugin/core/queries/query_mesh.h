// A mesh as the queries' stages take it: topology, leaf order and hierarchy, on the host.
#pragma once

#include <vector>

#include "bullet_plugin/core/mesh/topology.h"
#include "bullet_plugin/core/pipeline.h"
#include "bullet_plugin/core/self_collision/self_collision.h"

namespace drape
{
struct QueryMesh
{
    Topology m_topology;
    std::vector<std::uint32_t> m_order;
    BvhLayout m_layout;
    std::vector<BvhNode> m_nodes;  // volumes empty until the host refits them
    const float* m_start = nullptr;
    const float* m_end = nullptr;  // the same for a mesh at rest

    HostTree tree() const { return {m_nodes, m_layout, m_order, m_topology.m_triangles}; }
    // Volumes grown by the radius.
    void refit(float radius);
};

// Positions are not copied.
QueryMesh makeQueryMesh(const MeshDescription& description, const float* end);
}  // namespace drape
