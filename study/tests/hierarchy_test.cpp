// Traversals prepare start pairs and links from a hierarchy's links, for trees of any shape.
#include "study/traversal/hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "bullet_plugin/core/probe/bvh_layout.h"
#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
struct Tree
{
    std::vector<BvhNode> m_nodes;
    std::vector<std::uint32_t> m_order;
    std::uint32_t m_root = 0;

    Hierarchy hierarchy() const { return {m_nodes, m_root, m_order}; }
};

// The leaves below a node, in no order.
std::vector<std::uint32_t> leavesBelow(const Tree& tree, std::uint32_t root)
{
    std::vector<std::uint32_t> below = {root}, leaves;
    while (!below.empty())
    {
        const BvhNode& node = tree.m_nodes[below.back()];
        below.pop_back();
        if (node.m_count == 0) leaves.push_back(node.m_first);
        for (std::uint32_t i = 0; i < node.m_count; ++i)
            below.push_back(node.m_first + i);
    }
    return leaves;
}

Tree balancedTree(std::uint32_t leaves)
{
    const BvhLayout layout = makeBvhLayout(leaves);
    Tree tree = {makeBvhNodes(layout), std::vector<std::uint32_t>(leaves), layout.root()};
    std::iota(tree.m_order.rbegin(), tree.m_order.rend(), 0u);
    return tree;
}

// Root first; every inner node gets 2 … width children and leaves are shared out at random, at most half to one.
Tree randomTree(std::uint32_t leaves, std::uint32_t width, Random& random)
{
    Tree tree;
    tree.m_nodes.resize(1);
    tree.m_order.resize(leaves);
    std::iota(tree.m_order.rbegin(), tree.m_order.rend(), 0u);
    struct Open
    {
        std::uint32_t m_node, m_first, m_count;
    };
    std::vector<Open> open = {{0, 0, leaves}};
    while (!open.empty())
    {
        const Open now = open.back();
        open.pop_back();
        if (now.m_count == 1)
        {
            tree.m_nodes[now.m_node].m_first = now.m_first;
            tree.m_nodes[now.m_node].m_count = 0;
            continue;
        }
        const std::uint32_t children = std::min(now.m_count, 2 + random.below(width - 1));
        const std::uint32_t firstChild = std::uint32_t(tree.m_nodes.size());
        tree.m_nodes[now.m_node].m_first = firstChild;
        tree.m_nodes[now.m_node].m_count = children;
        tree.m_nodes.resize(firstChild + children);
        std::uint32_t first = now.m_first, left = now.m_count;
        for (std::uint32_t i = 0; i < children; ++i)
        {
            const std::uint32_t others = children - 1 - i;
            const std::uint32_t count = others == 0 ? left : 1 + random.below(std::max(1u, (left - others) / 2));
            open.push_back({firstChild + i, first, count});
            first += count;
            left -= count;
        }
    }
    return tree;
}

std::vector<Tree> someTrees()
{
    Random random(90);
    std::vector<Tree> trees;
    for (std::uint32_t leaves : {1u, 2u, 3u, 7u, 8u, 9u, 64u, 65u, 513u, 3001u})
    {
        trees.push_back(balancedTree(leaves));
        trees.push_back(randomTree(leaves, 2, random));
        trees.push_back(randomTree(leaves, 4, random));
    }
    return trees;
}
}  // namespace

TEST(Hierarchy, LinksLeadToTheRoot)
{
    SCOPED_TRACE("seed 90");
    for (const Tree& tree : someTrees())
    {
        const std::vector<BvhLink> links = makeLinks(tree.hierarchy());
        ASSERT_EQ(links.size(), tree.m_nodes.size());
        for (std::uint32_t first = 0; first < links.size(); ++first)
        {
            std::uint32_t node = first;
            for (std::uint32_t depth = links[node].m_depth; depth > 0; --depth)
            {
                const BvhNode& parent = tree.m_nodes[links[node].m_parent];
                ASSERT_TRUE(node >= parent.m_first && node < parent.m_first + parent.m_count);
                ASSERT_EQ(links[links[node].m_parent].m_depth, depth - 1);
                node = links[node].m_parent;
            }
            ASSERT_EQ(node, tree.m_root);
        }
    }
}

TEST(Hierarchy, StartPairsCoverEveryPairOfLeavesOnce)
{
    SCOPED_TRACE("seed 90");
    const std::vector<Tree> trees = someTrees();
    for (std::size_t i = 0; i + 5 < trees.size(); i += 2)
    {
        const Tree &cloth = trees[i], &obstacle = trees[trees.size() / 2 - i / 2];
        const std::size_t all = cloth.m_order.size() * obstacle.m_order.size();
        for (std::size_t wanted : {std::size_t(1), std::size_t(2), std::size_t(100), std::size_t(5000)})
        {
            const StartPairs start = makeStartPairs(cloth.hierarchy(), obstacle.hierarchy(), wanted);
            EXPECT_TRUE(start.m_pairs.size() >= wanted || start.m_pairs.size() == all);
            const std::vector<BvhLink> a = makeLinks(cloth.hierarchy()), b = makeLinks(obstacle.hierarchy());
            std::vector<std::uint8_t> covered(all);
            for (const NodePair& pair : start.m_pairs)
            {
                EXPECT_LE(a[pair.m_cloth].m_depth + b[pair.m_obstacle].m_depth, start.m_depth);
                for (std::uint32_t m : leavesBelow(cloth, pair.m_cloth))
                {
                    for (std::uint32_t n : leavesBelow(obstacle, pair.m_obstacle))
                        ++covered[m * obstacle.m_order.size() + n];
                }
            }
            EXPECT_EQ(std::size_t(std::count(covered.begin(), covered.end(), 1)), all);
        }
    }
}

TEST(Hierarchy, NothingComesOfNothing)
{
    const Tree none;
    EXPECT_TRUE(makeLinks(none.hierarchy()).empty());
}
}  // namespace drape::test
