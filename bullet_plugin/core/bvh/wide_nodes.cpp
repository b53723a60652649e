#include "wide_nodes.h"

#include "kernels/lib/dop.h"

namespace drape
{
namespace
{
// The node itself where it is a leaf, else its children.
void appendOpened(const std::vector<BvhNode>& from, const BvhNode& node, std::vector<BvhNode>& to)
{
    if (node.m_count == 0) to.push_back(node);
    for (std::uint32_t child = node.m_first; child < node.m_first + node.m_count; ++child)
        to.push_back(from[child]);
}
}  // namespace

std::vector<BvhNode> collapseToFour(const Tree& tree)
{
    std::vector<BvhNode> wide;
    if (tree.m_nodes.empty()) return wide;
    wide.reserve(tree.m_nodes.size());
    wide.push_back(tree.m_nodes[0]);
    // Nodes behind i still have the binary tree's links.
    for (std::size_t i = 0; i < wide.size(); ++i)
    {
        const BvhNode node = wide[i];
        if (node.m_count == 0) continue;
        const std::size_t first = wide.size();
        for (std::uint32_t child = node.m_first; child < node.m_first + node.m_count; ++child)
            appendOpened(tree.m_nodes, tree.m_nodes[child], wide);
        wide[i].m_first = std::uint32_t(first);
        wide[i].m_count = std::uint32_t(wide.size() - first);
    }
    return wide;
}

void refitWideNodes(std::vector<BvhNode>& nodes)
{
    for (std::size_t i = nodes.size(); i-- > 0;)
    {
        if (nodes[i].m_count > 0) dopMergeChildren(nodes.data(), std::uint32_t(i));
    }
}
}  // namespace drape
