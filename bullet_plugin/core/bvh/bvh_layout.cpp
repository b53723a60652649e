#include "bvh_layout.h"

#include <algorithm>
#include <limits>

#include "bullet_plugin/core/mesh/reserve_room.h"

namespace drape
{
BvhLayout makeBvhLayout(std::uint32_t leafCount)
{
    BvhLayout layout;
    std::uint32_t first = 0;
    for (std::uint32_t count = leafCount; count > 0; count = (count + 1) / 2)
    {
        layout.m_heights.push_back(BvhHeight{first, count});
        first += count;
        if (count == 1) break;
    }
    return layout;
}

std::vector<BvhChildren> linksOf(const std::vector<BvhNode>& nodes)
{
    std::vector<BvhChildren> links;
    links.reserve(nodes.size());
    for (const BvhNode& node : nodes)
        links.push_back({node.m_first, node.m_count});
    return links;
}

BvhLayout makeBvhLayout(const std::vector<BvhChildren>& tree, std::uint32_t root)
{
    BvhLayout layout;
    if (tree.empty()) return layout;
    // The tree's nodes by depth, the root first; in the layout they stand the other way round.
    std::vector<std::uint32_t> nodes = {root};
    std::vector<std::size_t> depthBegins;
    for (std::size_t begin = 0; begin < nodes.size();)
    {
        depthBegins.push_back(begin);
        const std::size_t end = nodes.size();
        for (; begin < end; ++begin)
        {
            const BvhChildren node = tree[nodes[begin]];
            for (std::uint32_t child = node.m_count; child-- > 0;)
                nodes.push_back(node.m_first + child);
        }
    }
    const std::uint32_t last = std::uint32_t(nodes.size() - 1);
    std::vector<std::uint32_t> places(tree.size());
    for (std::uint32_t i = 0; i <= last; ++i)
        places[nodes[i]] = last - i;
    layout.m_links.resize(nodes.size());
    layout.m_leafNodes.resize(nodes.size());
    std::uint32_t leaves = 0;
    for (std::uint32_t node : nodes)
    {
        const BvhChildren& from = tree[node];
        const bool leaf = from.m_count == 0;
        layout.m_links[places[node]] = {leaf ? from.m_first : places[from.m_first], from.m_count};
        if (!leaf) continue;
        layout.m_leafNodes[from.m_first] = places[node];
        ++leaves;
    }
    layout.m_leafNodes.resize(leaves);
    std::size_t end = nodes.size();
    for (std::size_t depth = depthBegins.size(); depth-- > 0; end = depthBegins[depth])
        layout.m_heights.push_back({std::uint32_t(nodes.size() - end), std::uint32_t(end - depthBegins[depth])});
    return layout;
}

BvhLayout layoutByHeights(const BvhLayout& layout)
{
    return layout.joined() && layout.nodeCount() > 0 ? makeBvhLayout(layout.m_links, layout.root()) : layout;
}

std::size_t sameBlocks(const std::vector<BvhBlock>& a, const std::vector<BvhBlock>& b)
{
    const auto sameTree = [](const BvhBlock& x, const BvhBlock& y) { return x.m_tree == y.m_tree; };
    return std::size_t(std::mismatch(a.begin(), a.end(), b.begin(), b.end(), sameTree).first - a.begin());
}

std::vector<BvhNode> makeBvhNodes(const BvhLayout& layout)
{
    std::vector<BvhNode> nodes;
    makeBvhNodes(layout, 0, nodes);
    return nodes;
}

void makeBvhNodes(const BvhLayout& layout, std::size_t keptBlocks, std::vector<BvhNode>& nodes)
{
    BvhNode empty = {};
    std::fill(empty.m_low, empty.m_low + DRAPE_DOP_DIRECTIONS, std::numeric_limits<float>::infinity());
    std::fill(empty.m_high, empty.m_high + DRAPE_DOP_DIRECTIONS, -std::numeric_limits<float>::infinity());
    const std::size_t kept = layout.blockNode(keptBlocks);
    nodes.resize(kept);
    reserveRoom(nodes, layout.nodeCount());
    nodes.resize(layout.nodeCount(), empty);
    for (std::size_t i = kept; i < layout.m_links.size(); ++i)
    {
        nodes[i].m_first = layout.m_links[i].m_first;
        nodes[i].m_count = layout.m_links[i].m_count;
    }
    if (!layout.m_links.empty()) return;
    for (std::size_t height = 0; height < layout.m_heights.size(); ++height)
    {
        const BvhHeight& level = layout.m_heights[height];
        for (std::uint32_t i = 0; i < level.m_count; ++i)
        {
            BvhNode& node = nodes[level.m_first + i];
            if (height == 0)
            {
                node.m_first = i;
                node.m_count = 0;
                continue;
            }
            const BvhHeight& below = layout.m_heights[height - 1];
            node.m_first = below.m_first + 2 * i;
            node.m_count = std::min(2u, below.m_count - 2 * i);
        }
    }
}
}  // namespace drape
