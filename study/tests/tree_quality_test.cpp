// Validity and width of trees on the host; whyInvalid must find what is wrong.
#include "study/trees/tree_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "study/trees/tree_builder.h"
#include "study/trees/wide_nodes.h"
#include "scenes/shapes.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
class TreeQualityTest : public testing::Test
{
protected:
    TreeQualityTest() : m_side(makeSide({makeSoup(1.0f, 0.1f, 333, 4)})) { m_tree = build(TreeBuilder::Radix); }

    Tree build(TreeBuilder builder) const
    {
        TreeMethods methods;
        methods.m_builder = builder;
        return buildTreeOnHost(methods, m_side.m_pool.triangles(), m_side.m_start.data(), 1);
    }
    std::string whyInvalid(const std::vector<BvhNode>& nodes, const std::vector<std::uint32_t>& order) const
    {
        return drape::whyInvalid(nodes, 0, order, m_side.m_pool.triangles(), m_side.m_start.data(), {0.0f});
    }

    Side m_side;
    Tree m_tree;
};
}  // namespace

TEST_F(TreeQualityTest, FaultsAreFound)
{
    ASSERT_EQ(whyInvalid(m_tree.m_nodes, m_tree.m_order), "");
    Tree tree = m_tree;
    tree.m_nodes[5].m_high[3] += 1e-3f;
    EXPECT_NE(whyInvalid(tree.m_nodes, tree.m_order), "") << "a volume too large";
    tree = m_tree;
    std::swap(tree.m_order[3], tree.m_order[200]);
    EXPECT_NE(whyInvalid(tree.m_nodes, tree.m_order), "") << "leaves exchanged";
    tree = m_tree;
    tree.m_order[3] = tree.m_order[4];
    EXPECT_NE(whyInvalid(tree.m_nodes, tree.m_order), "") << "a triangle missing";
    tree = m_tree;
    tree.m_nodes[2].m_first = tree.m_nodes[1].m_first;
    EXPECT_NE(whyInvalid(tree.m_nodes, tree.m_order), "") << "a node with two parents";
}

TEST_F(TreeQualityTest, WideNodesHoldTheSameLeaves)
{
    const std::vector<BvhNode> wide = reshape(m_tree, 4);
    EXPECT_EQ(whyInvalid(wide, m_tree.m_order), "");
    const TreeQuality narrow = measureTree(m_tree.m_nodes, 0), collapsed = measureTree(wide, 0);
    EXPECT_LT(collapsed.m_nodes, narrow.m_nodes);
    EXPECT_LE(collapsed.m_height, (narrow.m_height + 1) / 2);
    EXPECT_TRUE(reshape(Tree(), 4).empty());
}

// Nodes of any degree are refitted to the bits of the binary tree's.
TEST_F(TreeQualityTest, EveryShapeHoldsTheSameLeaves)
{
    for (const std::uint32_t degree : {2u, 4u})
    {
        for (const std::uint32_t bundle : {1u, 2u, 4u, 8u, 16u})
        {
            SCOPED_TRACE(std::to_string(degree) + " children, leaves of " + std::to_string(bundle));
            const std::vector<BvhNode> shaped = reshape(m_tree, degree, bundle);
            EXPECT_EQ(whyInvalid(shaped, m_tree.m_order), "");
            for (const BvhNode& node : shaped)
                EXPECT_LE(node.m_count, std::max(degree, bundle));
            EXPECT_EQ(shaped.size() < m_tree.m_nodes.size(), degree == 4 || bundle > 2);
            std::vector<BvhNode> nodes = shaped;
            for (BvhNode& node : nodes)
                std::fill(std::begin(node.m_low), std::end(node.m_low), 1e9f);
            refitWideOnHost(nodes, m_tree.m_order, m_side.m_pool.triangles(), m_side.m_start.data());
            EXPECT_TRUE(sameBytes(nodes, shaped));
        }
    }
}

TEST_F(TreeQualityTest, BuildersOfQualityCostLess)
{
    const double balanced = measureTree(build(TreeBuilder::Balanced).m_nodes, 0).m_cost;
    EXPECT_LT(measureTree(build(TreeBuilder::Ploc).m_nodes, 0).m_cost, balanced);
    EXPECT_LT(measureTree(build(TreeBuilder::TopDown).m_nodes, 0).m_cost, balanced);
}
}  // namespace drape::test
