// Determines whether a hierarchy is valid, and how good it is. Host only; for tests and studies.
#pragma once

#include <string>
#include <vector>

#include "kernels/shared/mesh.h"

namespace drape
{
struct TreeQuality
{
    // Sum over all nodes, each once, of the surface area of the volume's box over that of the root's. This is the
    // surface-area heuristic with equal costs. It is proportional to the nodes that a small query meets.
    double m_cost = 0;
    double m_volume = 0;         // sum of the volumes of the nodes' boxes, m³
    std::uint32_t m_height = 0;  // links from the root to the deepest leaf
    std::uint32_t m_stack = 0;   // entries a traversal of this tree alone needs at most
    std::uint32_t m_nodes = 0;   // nodes that the root reaches
};
TreeQuality measureTree(const std::vector<BvhNode>& nodes, std::uint32_t root);

// Returns what is wrong with a hierarchy, or an empty string. Every triangle must be in exactly one leaf. Every node's
// volume must be exactly the hull of its children's, and a leaf's that of its triangles (positions at rest, radius in m
// per mesh). The height must be bounded.
std::string whyInvalid(const std::vector<BvhNode>& nodes, std::uint32_t root, const std::vector<std::uint32_t>& order,
                       const std::vector<Triangle>& triangles, const float* positions,
                       const std::vector<float>& meshRadius);
}  // namespace drape
