#include "study/trees/wide_nodes.h"

#include <algorithm>

#include "kernels/lib/geometry/dop.h"

namespace drape
{
namespace
{
// Leaves below every node; a tree's parents need not stand before their children.
std::vector<std::uint32_t> leavesBelow(const Tree& tree)
{
    std::vector<std::uint32_t> leaves(tree.m_nodes.size(), 1);
    forEachFromBelow(tree.m_nodes, tree.m_splits,
                     [&](std::uint32_t split, std::uint32_t place)
                     { leaves[place] = leaves[2 * split + 1] + leaves[2 * split + 2]; });
    return leaves;
}

// Appends what a node is replaced by: itself, or where `opens` says so what its children are replaced by.
template <typename Opens>
void appendOpened(const std::vector<BvhNode>& from, std::uint32_t node, std::uint32_t depth, Opens opens,
                  std::vector<std::uint32_t>& to)
{
    if (from[node].m_count == 0 || !opens(node, depth))
    {
        to.push_back(node);
        return;
    }
    for (std::uint32_t child = 0; child < from[node].m_count; ++child)
        appendOpened(from, from[node].m_first + child, depth + 1, opens, to);
}
}  // namespace

std::vector<BvhNode> reshape(const Tree& tree, std::uint32_t degree, std::uint32_t bundle)
{
    std::vector<BvhNode> wide;
    if (tree.m_nodes.empty()) return wide;
    const std::vector<std::uint32_t> leaves = leavesBelow(tree);
    wide.reserve(tree.m_nodes.size());
    std::vector<std::uint32_t> sources = {0};
    for (std::size_t i = 0; i < sources.size(); ++i)
    {
        wide.push_back(tree.m_nodes[sources[i]]);
        if (wide[i].m_count == 0) continue;
        const bool bundled = leaves[sources[i]] <= bundle;
        const auto opens = [&](std::uint32_t node, std::uint32_t depth)
        { return depth == 0 || bundled || (degree == 4 && depth == 1 && leaves[node] > bundle); };
        const std::size_t first = sources.size();
        appendOpened(tree.m_nodes, sources[i], 0, opens, sources);
        wide[i].m_first = std::uint32_t(first);
        wide[i].m_count = std::uint32_t(sources.size() - first);
    }
    return wide;
}

std::vector<BvhHeight> depthsOf(const std::vector<BvhNode>& nodes)
{
    std::vector<BvhHeight> depths;
    for (std::uint32_t first = 0, end = 1; first < nodes.size();)
    {
        std::uint32_t children = 0;
        for (std::uint32_t i = first; i < end; ++i)
            children += nodes[i].m_count;
        depths.push_back({first, end - first});
        first = end;
        end += children;
    }
    std::reverse(depths.begin(), depths.end());
    return depths;
}

void refitWideOnHost(std::vector<BvhNode>& nodes, const std::vector<std::uint32_t>& order,
                     const std::vector<Triangle>& triangles, const float* positions)
{
    for (std::uint32_t i = std::uint32_t(nodes.size()); i-- > 0;)
    {
        Dop dop;
        if (nodes[i].m_count == 0)
        {
            leafVolume(&dop, &triangles[order[nodes[i].m_first]], positions, positions, 0.0f);
            dopStore(&nodes[i], &dop);
        }
        else
            dopMergeChildren(nodes.data(), i);
    }
}

void WideRefitStage::create(Device& device, const ProgramLoader& load)
{
    m_leaves.create(device, load("wide_refit"), "refitWideLeaves");
    m_level.create(device, load("queries/refit"));
}

void WideRefitStage::enqueue(Device& device, const std::vector<BvhHeight>& depths, Buffer<BvhNode>& nodes,
                             Buffer<cl_uint>& order, Buffer<Triangle>& triangles, Buffer<float>& positions)
{
    constexpr std::size_t kGroup = 64;
    if (depths.empty()) return;
    const std::size_t count = depths.front().m_first + depths.front().m_count;
    m_leaves.launch(device, count, kGroup, nodes.handle(), order.handle(), triangles.handle(), positions.handle(),
                    cl_uint(count));
    for (std::size_t i = 1; i < depths.size(); ++i)
        m_level.launch(device, depths[i].m_count, kGroup, {depths[i].m_first, depths[i].m_count}, nodes);
}
}  // namespace drape
