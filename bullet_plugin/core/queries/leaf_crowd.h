// Properties that all leaves below a node of a hierarchy share, so that pairs of whole subtrees are counted at once. If
// all leaves of two subtrees overlap each other, their pairs are the product of their numbers. Host only.
#pragma once

#include <cstdint>

#include "kernels/lib/geometry/dop.h"

namespace drape
{
constexpr std::uint32_t kMixedMeshes = 0xffffffffu;

struct LeafCrowd
{
    float m_lowMost[DRAPE_DOP_DIRECTIONS];    // greatest lower bound of a leaf
    float m_highLeast[DRAPE_DOP_DIRECTIONS];  // least upper bound of a leaf
    std::uint64_t m_leaves = 0;
    std::uint32_t m_mesh = kMixedMeshes;  // slot of the one mesh that they belong to
};

LeafCrowd crowdOfLeaf(const BvhNode& leaf, std::uint32_t mesh);

void joinCrowd(LeafCrowd& crowd, const LeafCrowd& other);

// Every leaf of one overlaps every leaf of the other: in each direction the greatest lower bound of either is no more
// than the least upper bound of the other. Of a crowd with itself: all its leaves overlap each other.
bool allOverlap(const LeafCrowd& a, const LeafCrowd& b);
}  // namespace drape
