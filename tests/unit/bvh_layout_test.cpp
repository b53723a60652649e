// Layout of the hierarchy: every leaf reachable once, links consistent, height logarithmic.
#include "bullet_plugin/core/bvh/bvh_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_plugin/core/bvh/refit.h"
#include "bullet_plugin/core/bvh/tree_builder.h"
#include "bullet_plugin/core/bvh/tree_quality.h"
#include "scenes/shapes.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
// Visits as a traversal does; returns the deepest stack.
std::size_t countVisits(const BvhLayout& layout, const std::vector<BvhNode>& nodes, std::vector<int>& leafVisits,
                        std::vector<int>& nodeVisits)
{
    std::vector<std::uint32_t> stack = {layout.root()};
    std::size_t deepest = 0;
    while (!stack.empty())
    {
        deepest = std::max(deepest, stack.size());
        const std::uint32_t index = stack.back();
        stack.pop_back();
        ++nodeVisits[index];
        const BvhNode& node = nodes[index];
        if (node.m_count == 0) ++leafVisits[node.m_first];
        for (std::uint32_t i = 0; i < node.m_count; ++i)
            stack.push_back(node.m_first + i);
    }
    return deepest;
}
}  // namespace

class BvhLayoutSizes : public testing::TestWithParam<std::uint32_t>
{
};

TEST_P(BvhLayoutSizes, EveryLeafIsReachedOnce)
{
    const BvhLayout layout = makeBvhLayout(GetParam());
    const std::vector<BvhNode> nodes = makeBvhNodes(layout);
    ASSERT_EQ(nodes.size(), layout.nodeCount());
    ASSERT_EQ(layout.leafCount(), GetParam());
    std::vector<int> leafVisits(GetParam(), 0), nodeVisits(nodes.size(), 0);
    const std::size_t deepest = countVisits(layout, nodes, leafVisits, nodeVisits);
    for (int visits : leafVisits)
        ASSERT_EQ(visits, 1);
    for (int visits : nodeVisits)
        ASSERT_EQ(visits, 1);
    EXPECT_LE(deepest, std::size_t(DRAPE_STACK_DEPTH));
    EXPECT_LE(layout.m_heights.size(), 2 + std::size_t(std::ceil(std::log2(double(GetParam())))));
    EXPECT_LE(layout.nodeCount(), 2 * GetParam() + layout.m_heights.size());
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
    {
        if (nodes[i].m_count == 0) continue;
        ASSERT_LE(nodes[i].m_first + nodes[i].m_count, i) << "children come before parents";
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, BvhLayoutSizes,
                         testing::Values(1, 2, 3, 4, 5, 7, 8, 9, 63, 64, 65, 1023, 1025, 3001, 100003));

// Any tree, root first as builders make them: the same parents above the same leaves, children before parents.
TEST_P(BvhLayoutSizes, TreesOfAnyShapeKeepTheirShape)
{
    const Side side = makeSide({makeSoup(1.0f, 0.1f, int(GetParam()), GetParam())});
    for (TreeBuilder builder : {TreeBuilder::Radix, TreeBuilder::TopDown})
    {
        TreeMethods methods;
        methods.m_builder = builder;
        const Tree tree = buildTreeOnHost(methods, side.m_pool.triangles(), side.m_start.data(), 1);
        const BvhLayout layout = makeBvhLayout(linksOf(tree.m_nodes), 0);
        std::vector<BvhNode> nodes = makeBvhNodes(layout);
        ASSERT_EQ(layout.leafCount(), GetParam());
        ASSERT_EQ(nodes.size(), tree.m_nodes.size());
        for (const BvhHeight& height : layout.m_heights)
        {
            for (std::uint32_t i = height.m_first; i < height.m_first + height.m_count; ++i)
                ASSERT_TRUE(nodes[i].m_count == 0 || nodes[i].m_first + nodes[i].m_count <= height.m_first);
        }
        std::size_t invalid = 0;
        refitOnHost(nodes, layout, tree.m_order, side.m_pool.triangles(), side.m_start.data(), side.m_start.data(),
                    {0.0f}, invalid);
        EXPECT_EQ(whyInvalid(nodes, layout.root(), tree.m_order, side.m_pool.triangles(), side.m_start.data(), {0.0f}),
                  "");
        const TreeQuality before = measureTree(tree.m_nodes, 0), after = measureTree(nodes, layout.root());
        EXPECT_EQ(after.m_height, before.m_height);
        EXPECT_EQ(after.m_nodes, before.m_nodes);
        EXPECT_NEAR(after.m_cost, before.m_cost, 1e-9 * before.m_cost);
    }
}

TEST(BvhLayout, UnusedVerticesWidenNoVolume)
{
    const TriangleMesh soup = makeSoup(1.0f, 0.1f, 100, 12);
    TriangleMesh strewn = soup;
    strewn.m_positions.insert(strewn.m_positions.end(), {50, 60, 70, -80, -90, -100});
    Side side = makeSide({soup}), wider = makeSide({strewn});
    refitSide(side, {0.01f});
    refitSide(wider, {0.01f});
    EXPECT_TRUE(wider.m_order == side.m_order);
    EXPECT_TRUE(sameBytes(wider.m_nodes, side.m_nodes)) << "seed 12";
    EXPECT_LT(wider.m_nodes[wider.m_layout.root()].m_high[0], 2.0f);
}

TEST(BvhLayout, NoLeavesNoNodes)
{
    const BvhLayout layout = makeBvhLayout(0);
    EXPECT_EQ(layout.nodeCount(), 0u);
    EXPECT_EQ(layout.leafCount(), 0u);
    EXPECT_TRUE(makeBvhNodes(layout).empty());
    EXPECT_EQ(makeBvhLayout({}, 0).nodeCount(), 0u);
}

TEST(BvhLayout, VolumesBeginEmpty)
{
    for (const BvhNode& node : makeBvhNodes(makeBvhLayout(5)))
    {
        for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
            EXPECT_TRUE(std::isinf(node.m_low[i]) && node.m_low[i] > node.m_high[i]);
    }
}
}  // namespace drape::test
