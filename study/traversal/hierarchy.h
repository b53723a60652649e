// A hierarchy's links as the traversals prepare for it, whoever built it: where they start, and where its nodes hang.
//
// Links only: volumes may be anything. Leaves hold one triangle and are numbered by their place in the order. Cost:
// linear.
#pragma once

#include <vector>

#include "study/kernels/shared/traversal.h"

namespace drape
{
// Most pairs of triangles that a step can list: all fifteen feature tests of each stay countable in 32 bits.
constexpr std::size_t kMostPairs = std::size_t(1) << 28;

struct Hierarchy
{
    const std::vector<BvhNode>& m_nodes;
    std::uint32_t m_root;
    const std::vector<std::uint32_t>& m_order;  // triangle per leaf

    bool empty() const { return m_order.empty(); }
};

// Parent and depth of every node.
std::vector<BvhLink> makeLinks(const Hierarchy& hierarchy);
// Pairs of nodes that together cover every pair of leaves once.
struct StartPairs
{
    std::vector<NodePair> m_pairs;
    std::uint32_t
        m_depth;  // depth of the pairs that can open: the sum of their nodes' depths. Pairs of leaves may be higher
};

// Follows the rule of clothOpens() down from the roots until there are at least `wanted` pairs, or no more to open.
// Neither hierarchy may be empty.
StartPairs makeStartPairs(const Hierarchy& cloth, const Hierarchy& obstacle, std::size_t wanted);
}  // namespace drape
