#include "wide_nodes.h"

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
}  // namespace drape
