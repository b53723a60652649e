// The topology of a hierarchy over leaves in a given order: pairs of neighbours, height by height. The leaves come
// first, then the parents of leaves 2j and 2j + 1, and so on; the root is last. Leaf i is node i.
//
// A height with an odd count leaves its last node alone under its parent. The topology depends on the leaf count alone,
// so host and device agree. A tree over n leaves is ⌈log2 n⌉ high and has 2 n + O(log n) nodes.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/shared/mesh.h"

namespace drape
{
struct BvhHeight
{
    std::uint32_t m_first;
    std::uint32_t m_count;
};

struct BvhLayout
{
    std::vector<BvhHeight> m_heights;  // the leaves' first; empty for no leaves

    std::uint32_t nodeCount() const
    {
        return m_heights.empty() ? 0 : m_heights.back().m_first + m_heights.back().m_count;
    }
    std::uint32_t leafCount() const { return m_heights.empty() ? 0 : m_heights[0].m_count; }
    std::uint32_t root() const { return nodeCount() - 1; }
};

BvhLayout makeBvhLayout(std::uint32_t leafCount);

// Returns nodes with their links set and volumes empty.
std::vector<BvhNode> makeBvhNodes(const BvhLayout& layout);
}  // namespace drape
