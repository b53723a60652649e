// The topology of a hierarchy over leaves in a given order, node by node from the leaves up: children lie before their
// parents, the root is last.
//
// By default pairs of neighbours, height by height: the leaves first, then the parents of leaves 2j and 2j + 1, and so
// on. A height with an odd count leaves its last node alone under its parent. A function of the leaf count only, so
// host and device agree, and a tree over n leaves is ⌈log2 n⌉ high. 2 n + O(log n) nodes.
//
// Joined out of meshes' own trees (joined_tree.h) it goes mesh by mesh, the nodes above the meshes behind them.
#pragma once

#include <cstdint>
#include <memory>
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

struct MeshTree;

// A mesh's nodes and leaves in a joined layout, up to where the next block's begin.
struct BvhBlock
{
    std::shared_ptr<const MeshTree> m_tree;
    std::uint32_t m_firstNode;
    std::uint32_t m_firstLeaf;
};

struct BvhLayout
{
    // A height's children lie in heights before it, the deepest first; empty for no leaves. Joined: those of the nodes
    // above the meshes alone.
    std::vector<BvhHeight> m_heights;
    // Of a tree of another shape: every node's links as BvhNode has them, and the node of every leaf. Empty for pairs
    // of neighbours, whose leaf i is node i.
    std::vector<BvhChildren> m_links;
    std::vector<std::uint32_t> m_leafNodes;
    std::vector<BvhBlock> m_blocks;  // by mesh slot; empty unless joined

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
    bool joined() const { return !m_blocks.empty(); }
    // Where the nodes above the meshes begin, of a joined layout.
    std::uint32_t top() const { return m_heights.empty() ? nodeCount() : m_heights[0].m_first; }
    // Where the nodes and the leaves of a block begin, or end for their number.
    std::uint32_t blockNode(std::size_t block) const
    {
        return block < m_blocks.size() ? m_blocks[block].m_firstNode : top();
    }
    std::uint32_t blockLeaf(std::size_t block) const
    {
        return block < m_blocks.size() ? m_blocks[block].m_firstLeaf : leafCount();
    }
};

BvhLayout makeBvhLayout(std::uint32_t leafCount);

// The tree of the given links height by height: a height is a depth, the deepest first. Leaves keep their numbers.
// Linear.
BvhLayout makeBvhLayout(const std::vector<BvhChildren>& links, std::uint32_t root);
// The same tree as a joined layout's, height by height; another layout as it is.
BvhLayout layoutByHeights(const BvhLayout& layout);

// Those of nodes alone.
std::vector<BvhChildren> linksOf(const std::vector<BvhNode>& nodes);

// Leading blocks in which two joined layouts are the same.
std::size_t sameBlocks(const std::vector<BvhBlock>& a, const std::vector<BvhBlock>& b);

// Nodes with their links set and volumes empty.
std::vector<BvhNode> makeBvhNodes(const BvhLayout& layout);
// The same from nodes of an earlier layout with the first so many blocks in common, whose nodes stay as they are.
void makeBvhNodes(const BvhLayout& layout, std::size_t keptBlocks, std::vector<BvhNode>& nodes);
}  // namespace drape
