#include "study/trees/tree.h"

#include <algorithm>

namespace drape
{
void resizeTree(Tree& tree, std::uint32_t leafCount)
{
    tree.m_nodes.assign(leafCount == 0 ? 0 : 2 * std::size_t(leafCount) - 1, BvhNode{});
    tree.m_splits.assign(leafCount == 0 ? 0 : leafCount - 1, 0u);
    tree.m_order.resize(leafCount);
}

TreeHeights heightsOf(const Tree& tree)
{
    TreeHeights heights;
    if (tree.m_splits.empty()) return heights;
    std::vector<std::uint32_t> ofPlace(tree.m_nodes.size(), 0), ofSplit(tree.m_splits.size());
    forEachFromBelow(tree.m_nodes, tree.m_splits,
                     [&](std::uint32_t split, std::uint32_t place)
                     {
                         const std::uint32_t height = 1 + std::max(ofPlace[2 * split + 1], ofPlace[2 * split + 2]);
                         ofPlace[place] = ofSplit[split] = height;
                         if (heights.m_ranges.size() < height) heights.m_ranges.resize(height);
                         ++heights.m_ranges[height - 1].m_count;
                     });
    std::uint32_t first = 0;
    for (BvhHeight& range : heights.m_ranges)
    {
        range.m_first = first;
        first += range.m_count;
    }
    std::vector<BvhHeight> next = heights.m_ranges;
    heights.m_splits.resize(tree.m_splits.size());
    for (std::uint32_t split = 0; split < ofSplit.size(); ++split)
        heights.m_splits[next[ofSplit[split] - 1].m_first++] = split;
    return heights;
}

void DeviceTree::reserve(Device& device, cl_uint leafCount)
{
    m_leafCount = leafCount;
    m_nodes.reserve(device, leafCount == 0 ? 0 : 2 * std::size_t(leafCount) - 1);
    m_splits.reserve(device, leafCount);
    m_order.reserve(device, leafCount);
    // At each of the tree's heights at most n / 2,048 nodes span more than 2,048 leaves.
    const std::size_t groves = leafCount / DRAPE_GROVE_LEAVES;
    m_tops.reserve(device, 1 + std::min<std::size_t>(leafCount, groves * DRAPE_TREE_HEIGHT));
}

void DeviceTree::upload(Device& device, const Tree& tree)
{
    reserve(device, tree.leafCount());
    m_nodes.write(device, tree.m_nodes.data(), tree.m_nodes.size());
    m_splits.write(device, tree.m_splits.data(), tree.m_splits.size());
    m_order.write(device, tree.m_order.data(), tree.m_order.size());
    device.wait();
}

Tree DeviceTree::download(Device& device)
{
    Tree tree;
    resizeTree(tree, m_leafCount);
    m_nodes.read(device, tree.m_nodes.data(), tree.m_nodes.size());
    m_splits.read(device, tree.m_splits.data(), tree.m_splits.size());
    m_order.read(device, tree.m_order.data(), tree.m_order.size());
    device.wait();
    return tree;
}
}  // namespace drape
