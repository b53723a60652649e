// A binary hierarchy of any shape over ordered leaves, on the host and on a device.
//
// kernels/lib/tree_layout.h says where nodes lie. A tree over no leaves has no nodes; one over one leaf is that leaf.
// Every builder makes the same tree, bit for bit, on the host and on every device.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/probe/bvh_layout.h"
#include "study/kernels/lib/tree_layout.h"

namespace drape
{
struct Tree
{
    std::vector<BvhNode> m_nodes;         // 2 n - 1
    std::vector<std::uint32_t> m_splits;  // n - 1, see tree_layout.h
    std::vector<std::uint32_t> m_order;   // triangle per leaf

    std::uint32_t leafCount() const { return std::uint32_t(m_order.size()); }
};

// Nodes and splits for that many leaves, not linked yet.
void resizeTree(Tree& tree, std::uint32_t leafCount);

// Calls visit(split, place) for every inner node, children before parents.
template <typename Visit>
void forEachFromBelow(const std::vector<BvhNode>& nodes, const std::vector<std::uint32_t>& splits, Visit visit)
{
    const std::uint32_t leafCount = std::uint32_t(splits.size() + 1);
    for (std::uint32_t leaf = 0; leaf < leafCount; ++leaf)
    {
        // A right child is its parent's last: see kernels/lib/tree_refit.h.
        for (std::uint32_t place = leafPlace(nodes.data(), leaf, leafCount); place != 0 && place % 2 == 0;)
        {
            const std::uint32_t split = place / 2 - 1;
            place = splitPlace(splits[split]);
            visit(split, place);
        }
    }
}

// Splits by their nodes' height above the leaves, lowest first: what a refit with a launch per height goes through.
struct TreeHeights
{
    std::vector<std::uint32_t> m_splits;
    std::vector<BvhHeight> m_ranges;  // into m_splits
};
TreeHeights heightsOf(const Tree& tree);

struct DeviceTree
{
    Buffer<BvhNode> m_nodes;
    Buffer<cl_uint> m_splits;
    Buffer<cl_uint> m_order;
    Buffer<cl_uint> m_tops;  // see refitTopsSerial in study/kernels/tree_refit.cl
    // Splits by height, see TreeHeights; only if the tree is refitted by levels.
    Buffer<cl_uint> m_heightSplits;
    std::vector<BvhHeight> m_heights;
    cl_uint m_leafCount = 0;

    void reserve(Device& device, cl_uint leafCount);
    void upload(Device& device, const Tree& tree);  // waits
    Tree download(Device& device);                  // waits
};
}  // namespace drape
