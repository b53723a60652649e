// The topology of a hierarchy over leaves in a given order, node by node from the leaves up.
//
// Nodes lie in heights: children lie in a height before their parent's, the root is last. By default pairs of
// neighbours, height by height: the leaves first, then the parents of leaves 2j and 2j + 1, and so on. A height with an
// odd count leaves its last node alone under its parent. A function of the leaf count only, so host and device agree,
// and a tree over n leaves is ⌈log2 n⌉ high. 2 n + O(log n) nodes.
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

struct BvhChildren
{
    std::uint32_t m_first;
    std::uint32_t m_count;
};

struct BvhLayout
{
    std::vector<BvhHeight> m_heights;  // deepest nodes first; empty for no leaves
    // Of a tree of another shape: every node's links as BvhNode has them, and the node of every leaf. Empty for pairs
    // of neighbours, whose leaf i is node i.
    std::vector<BvhChildren> m_links;
    std::vector<std::uint32_t> m_leafNodes;

    std::uint32_t nodeCount() const
    {
        return m_heights.empty() ? 0 : m_heights.back().m_first + m_heights.back().m_count;
    }
    std::uint32_t leafCount() const
    {
        if (!m_leafNodes.empty()) return std::uint32_t(m_leafNodes.size());
        return m_heights.empty() ? 0 : m_heights[0].m_count;
    }
    std::uint32_t leafNode(std::uint32_t leaf) const { return m_leafNodes.empty() ? leaf : m_leafNodes[leaf]; }
    std::uint32_t root() const { return nodeCount() - 1; }
};

BvhLayout makeBvhLayout(std::uint32_t leafCount);

// The tree of the given links in a layout's order: a height is a depth, the deepest first. Leaves keep their numbers.
// Linear.
BvhLayout makeBvhLayout(const std::vector<BvhChildren>& links, std::uint32_t root);

// Those of nodes alone.
std::vector<BvhChildren> linksOf(const std::vector<BvhNode>& nodes);

// Of every node; the root, which no node has for a child, is its own.
std::vector<std::uint32_t> parentsOf(const std::vector<BvhNode>& nodes);

// Nodes with their links set and volumes empty.
std::vector<BvhNode> makeBvhNodes(const BvhLayout& layout);
}  // namespace drape
