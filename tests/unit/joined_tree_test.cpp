// A side's hierarchy joined out of meshes' trees: what stays while meshes come and go is as if all were joined anew.
#include "bullet_plugin/core/bvh/joined_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_plugin/core/broad_phase/hierarchy.h"
#include "bullet_plugin/core/bvh/refit.h"
#include "bullet_plugin/core/bvh/tree_quality.h"
#include "bullet_plugin/core/mesh/topology.h"
#include "scenes/shapes.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr std::uint32_t kMeshDepth = 20;  // of meshes' roots

// Soups of triangles with their trees, and what is kept of their hierarchy from one list of them to the next.
class JoinedTreeTest : public testing::Test
{
protected:
    JoinedTreeTest() { m_methods.m_builder = TreeBuilder::Radix; }

    void add(int triangles)
    {
        TriangleMesh soup = makeSoup(1.0f, 0.1f, triangles, 60 + m_made++);
        const Topology topology = buildTopology(soup.m_triangles.data(), soup.triangleCount(), soup.vertexCount());
        m_trees.push_back(
            std::make_shared<const MeshTree>(buildMeshTree(m_methods, topology.m_triangles, soup.m_positions.data())));
        m_meshes.push_back(std::move(soup));
        m_moved.push_back(true);
    }
    void remove(std::size_t slot)
    {
        m_trees.erase(m_trees.begin() + std::ptrdiff_t(slot));
        m_meshes.erase(m_meshes.begin() + std::ptrdiff_t(slot));
        m_moved.erase(m_moved.begin() + std::ptrdiff_t(slot));
    }
    void move(std::size_t slot)
    {
        for (float& coordinate : m_meshes[slot].m_positions)
            coordinate += 0.5f;
        m_moved[slot] = true;
    }

    // Joins, refits and links what is new or moved, and compares with all anew. Returns the blocks that were kept.
    std::size_t joinAndCompare()
    {
        const Side side = makeSide(m_meshes);
        std::vector<std::uint32_t> order;
        for (std::size_t slot = 0; slot < m_meshes.size(); ++slot)
            for (const std::uint32_t triangle : m_trees[slot]->m_order)
                order.push_back(triangle + side.m_pool.begin(slot).m_triangle);
        const std::vector<BvhBlock> before = m_layout.m_blocks;
        joinTrees(m_trees, m_layout);
        const std::size_t kept = sameBlocks(before, m_layout.m_blocks);
        makeBvhNodes(m_layout, kept, m_nodes);
        for (std::size_t slot = 0; slot < m_meshes.size(); ++slot)
        {
            if (slot < kept && !m_moved[slot]) continue;
            refitMeshOnHost(m_nodes, m_layout, slot, order, side.m_pool.triangles(), side.m_start.data());
            m_moved[slot] = false;
        }
        refitTopOnHost(m_nodes, m_layout);
        extendLinks(m_nodes, m_layout.blockNode(kept), rootDepth(), m_links);
        expectAsAnew(side, order);
        return kept;
    }

    BvhLayout m_layout;
    std::vector<BvhNode> m_nodes;
    std::vector<BvhLink> m_links;
    std::vector<TriangleMesh> m_meshes;
    std::vector<std::shared_ptr<const MeshTree>> m_trees;

private:
    std::uint32_t rootDepth() const { return kMeshDepth - std::uint32_t(m_layout.m_heights.size()); }

    void expectAsAnew(const Side& side, const std::vector<std::uint32_t>& order) const
    {
        BvhLayout anew;
        joinTrees(m_trees, anew);
        EXPECT_TRUE(sameBytes(m_layout.m_links, anew.m_links));
        EXPECT_TRUE(m_layout.m_leafNodes == anew.m_leafNodes);
        EXPECT_TRUE(sameBytes(m_layout.m_heights, anew.m_heights));
        ASSERT_EQ(m_layout.leafCount(), order.size());
        ASSERT_EQ(m_layout.m_blocks.size(), m_meshes.size());
        if (order.empty()) return;
        const std::vector<float> noRadius(m_meshes.size(), 0.0f);
        std::vector<BvhNode> nodes = makeBvhNodes(anew);
        std::size_t invalid = 0;
        refitOnHost(nodes, anew, order, side.m_pool.triangles(), side.m_start.data(), side.m_start.data(), noRadius,
                    invalid);
        EXPECT_TRUE(sameBytes(m_nodes, nodes));
        std::vector<BvhLink> links = makeLinks({nodes, anew.root(), order});
        for (BvhLink& link : links)
            link.m_depth += rootDepth();
        EXPECT_TRUE(sameBytes(m_links, links));
        for (std::uint32_t node = 0; node < nodes.size(); ++node)
            ASSERT_TRUE(nodes[node].m_count == 0 || nodes[node].m_first + nodes[node].m_count <= node);
        EXPECT_EQ(whyInvalid(nodes, anew.root(), order, side.m_pool.triangles(), side.m_start.data(), noRadius), "");
        for (std::size_t slot = 0; slot < m_meshes.size(); ++slot)
        {
            if (m_layout.blockNode(slot) == m_layout.blockNode(slot + 1)) continue;
            EXPECT_EQ(m_links[m_layout.blockNode(slot + 1) - 1].m_depth, kMeshDepth);
        }
    }

    TreeMethods m_methods;
    std::vector<bool> m_moved;
    int m_made = 0;
};
}  // namespace

TEST_F(JoinedTreeTest, WhatStaysIsAsIfAllWereJoinedAnew)
{
    SCOPED_TRACE("seeds 60 to 68");
    for (const int triangles : {77, 0, 1, 200})
        add(triangles);
    EXPECT_EQ(joinAndCompare(), 0u);
    EXPECT_EQ(joinAndCompare(), 4u) << "nothing happened";
    add(50);
    EXPECT_EQ(joinAndCompare(), 4u) << "one came";
    move(0);
    move(2);
    EXPECT_EQ(joinAndCompare(), 5u) << "two moved";
    add(1);
    add(0);
    move(3);
    EXPECT_EQ(joinAndCompare(), 5u) << "two came and one moved";
    remove(6);
    EXPECT_EQ(joinAndCompare(), 6u) << "the last one went";
    remove(1);
    EXPECT_EQ(joinAndCompare(), 1u) << "those behind one that went have moved up";
    remove(0);
    add(300);
    add(2);
    EXPECT_EQ(joinAndCompare(), 0u) << "the first one went and two came";
}

TEST_F(JoinedTreeTest, WithoutTrianglesThereAreNoNodes)
{
    add(0);
    add(0);
    EXPECT_EQ(joinAndCompare(), 0u);
    EXPECT_EQ(m_layout.nodeCount(), 0u);
    EXPECT_EQ(layoutByHeights(m_layout).nodeCount(), 0u);
    add(1);
    EXPECT_EQ(joinAndCompare(), 2u);
    while (!m_meshes.empty())
        remove(0);
    EXPECT_EQ(joinAndCompare(), 0u);
    EXPECT_FALSE(m_layout.joined());
}

// As a refit by heights takes it.
TEST_F(JoinedTreeTest, ByHeightsItIsTheSameTree)
{
    SCOPED_TRACE("seeds 60 to 64");
    for (const int triangles : {77, 1, 0, 200, 13})
        add(triangles);
    joinAndCompare();
    const BvhLayout layout = layoutByHeights(m_layout);
    EXPECT_FALSE(layout.joined());
    ASSERT_EQ(layout.nodeCount(), m_layout.nodeCount());
    ASSERT_EQ(layout.leafCount(), m_layout.leafCount());
    const std::vector<BvhNode> nodes = makeBvhNodes(layout);
    for (const BvhHeight& height : layout.m_heights)
        for (std::uint32_t i = height.m_first; i < height.m_first + height.m_count; ++i)
            ASSERT_TRUE(nodes[i].m_count == 0 || nodes[i].m_first + nodes[i].m_count <= height.m_first);
    const std::vector<std::uint32_t> order(layout.leafCount());
    std::vector<BvhLink> links = makeLinks({nodes, layout.root(), order});
    const std::uint32_t down = m_links[m_layout.root()].m_depth;
    for (std::uint32_t leaf = 0; leaf < layout.leafCount(); ++leaf)
        EXPECT_EQ(links[layout.leafNode(leaf)].m_depth + down, m_links[m_layout.leafNode(leaf)].m_depth);
}
}  // namespace drape::test
