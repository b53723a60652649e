// Layout of the hierarchy: every leaf reachable once, links consistent, height logarithmic.
#include "bullet_plugin/core/probe/bvh_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
