// Whether a hierarchy is valid, and how good it is. Host only; for tests and studies.
#pragma once

#include <string>
#include <vector>

#include "kernels/shared/mesh.h"

namespace drape
{
struct TreeQuality
{
    // Sum over all nodes of the surface area of the volume's box over that of the root's, leaves and inner nodes
    // counted once each: the surface-area heuristic with equal costs, proportional to the nodes a small query meets.
    double m_cost = 0;
    double m_volume = 0;         // of the nodes' boxes, summed, m³
    std::uint32_t m_height = 0;  // links from the root to the deepest leaf
    std::uint32_t m_stack = 0;   // entries a traversal of this tree alone needs at most
    std::uint32_t m_nodes = 0;   // that the root reaches
};
TreeQuality measureTree(const std::vector<BvhNode>& nodes, std::uint32_t root);

// Empty when every triangle is in exactly one leaf, every node's volume is exactly the hull of its children's, leaves
// hold their triangles' volumes exactly (positions at rest, radius m per mesh), and the height is bounded; else what is
// wrong.
std::string whyInvalid(const std::vector<BvhNode>& nodes, std::uint32_t root, const std::vector<std::uint32_t>& order,
                       const std::vector<Triangle>& triangles, const float* positions,
                       const std::vector<float>& meshRadius);
}  // namespace drape
