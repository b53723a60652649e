// What traversals prepare from a hierarchy's links: start pairs, links, wide nodes; for trees of any shape.
#include "bullet_plugin/core/broad_phase/hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "bullet_plugin/core/broad_phase/wide_layout.h"
#include "bullet_plugin/core/bvh/bvh_layout.h"
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

// Levels from the root down to every node.
std::vector<int> depths(const Tree& tree)
{
    std::vector<int> depth(tree.m_nodes.size());
    std::vector<std::uint32_t> open = {tree.m_root};
    while (!open.empty())
    {
        const std::uint32_t node = open.back();
        open.pop_back();
        for (std::uint32_t i = 0; i < tree.m_nodes[node].m_count; ++i)
        {
            depth[tree.m_nodes[node].m_first + i] = depth[node] + 1;
            open.push_back(tree.m_nodes[node].m_first + i);
        }
    }
    return depth;
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
        const std::vector<std::uint32_t> leaves = leafNodes(tree.hierarchy());
        ASSERT_EQ(leaves.size(), tree.m_order.size());
        for (std::uint32_t leaf = 0; leaf < leaves.size(); ++leaf)
        {
            ASSERT_EQ(tree.m_nodes[leaves[leaf]].m_first, leaf);
            ASSERT_EQ(tree.m_nodes[leaves[leaf]].m_count, 0u);
            std::uint32_t node = leaves[leaf];
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

// Every triangle is in one slot, and a slot's node holds exactly what hangs below it.
TEST(Hierarchy, WideNodesHoldTheSameTree)
{
    SCOPED_TRACE("seed 90");
    for (const Tree& tree : someTrees())
    {
        const WideLayout wide = makeWideLayout(tree.hierarchy());
        ASSERT_EQ(wide.m_sources.size(), wide.m_nodes.size() * DRAPE_WIDE);
        std::vector<int> seen(tree.m_order.size()), reached(wide.m_nodes.size());
        std::size_t slots = 0;
        for (std::size_t i = 0; i < wide.m_sources.size(); ++i)
        {
            const std::uint32_t child = wide.m_nodes[i / DRAPE_WIDE].m_child[i % DRAPE_WIDE];
            ASSERT_EQ(child == DRAPE_WIDE_NONE, wide.m_sources[i] == DRAPE_WIDE_NONE);
            EXPECT_GT(wide.m_nodes[i / DRAPE_WIDE].m_low[0][i % DRAPE_WIDE], 1e38f) << "empty until it is gathered";
            if (child == DRAPE_WIDE_NONE) continue;
            ++slots;
            const BvhNode& source = tree.m_nodes[wide.m_sources[i]];
            if (child & DRAPE_WIDE_LEAF)
            {
                ASSERT_EQ(source.m_count, 0u);
                ASSERT_EQ(child & ~DRAPE_WIDE_LEAF, tree.m_order[source.m_first]);
                ++seen[child & ~DRAPE_WIDE_LEAF];
                continue;
            }
            ASSERT_GT(child, i / DRAPE_WIDE);
            ++reached[child];
            std::size_t below = 0;
            for (std::size_t slot = 0; slot < DRAPE_WIDE; ++slot)
            {
                const std::uint32_t node = wide.m_sources[child * DRAPE_WIDE + slot];
                if (node != DRAPE_WIDE_NONE) below += leavesBelow(tree, node).size();
            }
            EXPECT_EQ(below, leavesBelow(tree, wide.m_sources[i]).size());
        }
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(seen.size()));
        EXPECT_EQ(std::count(reached.begin() + 1, reached.end(), 1), std::ptrdiff_t(reached.size() - 1));
        EXPECT_LE(slots, 2 * tree.m_order.size());
    }
}

// What the depth of the wide traversal's stack counts on.
TEST(Hierarchy, AWideHeightTakesThePlaceOfThreeBinaryOnes)
{
    SCOPED_TRACE("seed 91");
    Random random(91);
    for (std::uint32_t leaves : {9u, 64u, 513u, 3001u})
    {
        const Tree tree = randomTree(leaves, 2, random);
        const std::vector<int> depth = depths(tree);
        const WideLayout wide = makeWideLayout(tree.hierarchy());
        std::vector<std::uint32_t> source(wide.m_nodes.size(), tree.m_root);  // of each wide node; parents come first
        for (std::size_t i = 0; i < wide.m_sources.size(); ++i)
        {
            const std::uint32_t child = wide.m_nodes[i / DRAPE_WIDE].m_child[i % DRAPE_WIDE];
            if (child == DRAPE_WIDE_NONE || (child & DRAPE_WIDE_LEAF)) continue;
            source[child] = wide.m_sources[i];
            EXPECT_GE(depth[source[child]], depth[source[i / DRAPE_WIDE]] + 3);
        }
        EXPECT_GT(wide.m_nodes.size(), 1u);
    }
}

TEST(Hierarchy, NothingComesOfNothing)
{
    const Tree none;
    EXPECT_TRUE(makeLinks(none.hierarchy()).empty());
    EXPECT_TRUE(leafNodes(none.hierarchy()).empty());
    EXPECT_TRUE(makeWideLayout(none.hierarchy()).m_nodes.empty());
}
}  // namespace drape::test
