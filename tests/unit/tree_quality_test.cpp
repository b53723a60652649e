// Validity, cost and width of trees on the host; whyInvalid must find what is wrong.
#include "bullet_plugin/core/bvh/tree_quality.h"

#include <gtest/gtest.h>

#include "bullet_plugin/core/bvh/refit.h"
#include "bullet_plugin/core/bvh/tree_builder.h"
#include "bullet_plugin/core/bvh/tree_cost.h"
#include "bullet_plugin/core/bvh/wide_nodes.h"
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

// Nodes of any degree are refitted from a layout of theirs, to the bits of the binary tree's.
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
            const BvhLayout layout = makeBvhLayout(linksOf(shaped), 0);
            std::vector<BvhNode> nodes = makeBvhNodes(layout);
            std::size_t invalid = 0;
            refitOnHost(nodes, layout, m_tree.m_order, m_side.m_pool.triangles(), m_side.m_start.data(),
                        m_side.m_start.data(), {0.0f}, invalid);
            EXPECT_EQ(drape::whyInvalid(nodes, layout.root(), m_tree.m_order, m_side.m_pool.triangles(),
                                        m_side.m_start.data(), {0.0f}),
                      "");
        }
    }
}

TEST_F(TreeQualityTest, CostIsTheSumOfAreas)
{
    // Each of the 665 nodes' shares is rounded down to 2^-30, and its float quotient errs by some 2^-22 of itself.
    const double cost = measureTree(m_tree.m_nodes, 0).m_cost;
    EXPECT_NEAR(treeCostOnHost(m_tree.m_nodes, 0), cost, 1e-6 * cost);
    EXPECT_EQ(treeCostOnHost({}, 0), 0.0);
}

TEST_F(TreeQualityTest, ScatteringTrianglesDecaysATree)
{
    const double atBuild = treeCostOnHost(m_tree.m_nodes, 0);
    std::vector<float> positions = m_side.m_start;
    for (std::size_t i = 0; i < positions.size(); i += 18)  // every second triangle moves across
        for (std::size_t k = i; k < std::min(i + 9, positions.size()); ++k)
            positions[k] = 1.0f - positions[k];
    std::size_t invalid = 0;
    refitTreeOnHost(m_tree, m_side.m_pool.triangles(), positions.data(), positions.data(), {0.0f}, invalid);
    const double now = treeCostOnHost(m_tree.m_nodes, 0);
    EXPECT_TRUE(isDecayed(now, atBuild, 1.5f)) << now << " was " << atBuild;
    EXPECT_FALSE(isDecayed(atBuild, atBuild, 1.5f));
    EXPECT_FALSE(isDecayed(now, atBuild, 0.0f)) << "never";
}

TEST_F(TreeQualityTest, BuildersOfQualityCostLess)
{
    const double balanced = measureTree(build(TreeBuilder::Balanced).m_nodes, 0).m_cost;
    EXPECT_LT(measureTree(build(TreeBuilder::Ploc).m_nodes, 0).m_cost, balanced);
    EXPECT_LT(measureTree(build(TreeBuilder::TopDown).m_nodes, 0).m_cost, balanced);
}
}  // namespace drape::test
