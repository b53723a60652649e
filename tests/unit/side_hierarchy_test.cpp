// A side's hierarchy: built when it is walked, of trees that meshes keep.
#include "bullet_plugin/core/pipeline/side_hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "bullet_plugin/core/bvh/refit.h"
#include "bullet_plugin/core/bvh/tree_quality.h"
#include "bullet_plugin/core/mesh/topology.h"
#include "scenes/shapes.h"

namespace drape::test
{
namespace
{
class SideHierarchyTest : public testing::TestWithParam<TreeBuilder>
{
protected:
    SideHierarchyTest() { m_methods.m_builder = GetParam(); }

    void add(int triangles)
    {
        const TriangleMesh soup = makeSoup(1.0f, 0.1f, triangles, 40 + m_next);
        PooledMesh mesh;
        mesh.m_id = m_next++;
        mesh.m_topology = buildTopology(soup.m_triangles.data(), soup.triangleCount(), soup.vertexCount());
        mesh.m_positions = soup.m_positions;
        for (std::uint32_t i = 0; i < std::uint32_t(triangles); ++i)
            mesh.m_order.push_back(i);
        m_pool.add(mesh);
        m_pool.update();
        m_hierarchy.begin(m_pool);
        m_hierarchy.layOut(m_pool, m_layout);
    }

    bool build() { return m_hierarchy.build(m_methods, m_pool, m_layout); }

    // Whole, over every triangle once, and a mesh's triangles have a subtree of their own. filled: meshes with
    // triangles, one or two.
    void expectValid(std::size_t filled = 1) const
    {
        std::vector<float> positions;
        for (std::size_t slot = 0; slot < m_pool.meshCount(); ++slot)
        {
            const std::vector<float>& own = m_pool.mesh(slot).m_positions;
            positions.insert(positions.end(), own.begin(), own.end());
        }
        const std::vector<float> noRadius(m_pool.meshCount(), 0.0f);
        std::vector<BvhNode> nodes = makeBvhNodes(m_layout);
        std::size_t invalid = 0;
        refitOnHost(nodes, m_layout, m_pool.order(), m_pool.triangles(), positions.data(), positions.data(), noRadius,
                    invalid);
        EXPECT_EQ(whyInvalid(nodes, m_layout.root(), m_pool.order(), m_pool.triangles(), positions.data(), noRadius),
                  "");
        const std::size_t mixed = mixedNodes(nodes);
        EXPECT_TRUE(GetParam() == TreeBuilder::Balanced || mixed == (filled > 1 ? 1u : 0u)) << mixed;
    }

    TreeMethods m_methods;
    MeshPool m_pool;
    SideHierarchy m_hierarchy;
    BvhLayout m_layout;
    MeshId m_next = 0;

private:
    // Nodes over triangles of several meshes.
    std::size_t mixedNodes(const std::vector<BvhNode>& nodes) const
    {
        std::vector<std::set<std::uint32_t>> meshes(nodes.size());
        std::size_t mixed = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i)  // children before parents
        {
            if (nodes[i].m_count == 0) meshes[i] = {m_pool.triangles()[m_pool.order()[nodes[i].m_first]].m_mesh};
            for (std::uint32_t child = 0; child < nodes[i].m_count; ++child)
                meshes[i].insert(meshes[nodes[i].m_first + child].begin(), meshes[nodes[i].m_first + child].end());
            mixed += meshes[i].size() > 1;
        }
        return mixed;
    }
};

TEST_P(SideHierarchyTest, IsBuiltWhenItIsWalkedAndOnlyThen)
{
    add(200);
    EXPECT_EQ(m_layout.nodeCount(), makeBvhLayout(200).nodeCount()) << "pairs of neighbours until then";
    const std::uint32_t before = m_pool.revision();
    EXPECT_EQ(build(), GetParam() != TreeBuilder::Balanced);
    EXPECT_EQ(m_pool.revision() != before, GetParam() != TreeBuilder::Balanced);
    EXPECT_FALSE(build()) << "it is there";
    expectValid();
}

TEST_P(SideHierarchyTest, MeshesWithoutTrianglesAndOfOneAreJoined)
{
    for (const int triangles : {0, 1, 0, 333})
        add(triangles);
    build();
    EXPECT_EQ(m_layout.leafCount(), 334u);
    expectValid(2);
}

TEST_P(SideHierarchyTest, AMeshThatComesLeavesTheOthersTreesAsTheyWere)
{
    add(300);
    build();
    const std::vector<std::uint32_t> alone = m_pool.order();
    // What is under the kept mesh's name now is not looked at again.
    m_pool.mesh(0).m_positions.assign(m_pool.mesh(0).m_positions.size(), 0.0f);
    add(50);
    build();
    const bool kept = std::equal(alone.begin(), alone.end(), m_pool.order().begin());
    EXPECT_TRUE(kept || GetParam() == TreeBuilder::Balanced);
    m_pool.remove(0);
    m_pool.update();
    m_hierarchy.begin(m_pool);
    m_hierarchy.layOut(m_pool, m_layout);
    build();
    EXPECT_EQ(m_layout.leafCount(), 50u);
    expectValid();
}

TEST_P(SideHierarchyTest, WhatWasBuiltAnewStaysWhenAMeshComes)
{
    add(300);
    build();
    std::vector<float> elsewhere = m_pool.mesh(0).m_positions;
    std::reverse(elsewhere.begin(), elsewhere.end());
    m_hierarchy.use(buildMeshTrees(m_methods, m_pool.triangles(), {0}, elsewhere.data()), m_pool, m_layout);
    const std::vector<std::uint32_t> anew = m_pool.order();
    EXPECT_FALSE(build());
    expectValid();
    add(50);
    EXPECT_TRUE(build());
    EXPECT_TRUE(std::equal(anew.begin(), anew.end(), m_pool.order().begin()));
    EXPECT_EQ(m_layout.leafCount(), 350u);
}

// As meshes may that are numbered anew.
TEST_P(SideHierarchyTest, ATreeOfAnotherMeshOfTheSameNumberIsNotTaken)
{
    add(300);
    build();
    m_pool.remove(0);
    m_next = 0;
    add(20);
    build();
    EXPECT_EQ(m_layout.leafCount(), 20u);
    expectValid();
}

TEST_P(SideHierarchyTest, AnotherBuilderBuildsAnew)
{
    add(300);
    build();
    const std::vector<std::uint32_t> order = m_pool.order();
    const std::uint32_t nodes = m_layout.nodeCount();
    TreeMethods other;
    other.m_builder = GetParam() == TreeBuilder::Ploc ? TreeBuilder::TopDown : TreeBuilder::Ploc;
    EXPECT_TRUE(m_hierarchy.build(other, m_pool, m_layout));
    EXPECT_FALSE(order == m_pool.order());
    EXPECT_TRUE(build());
    EXPECT_EQ(m_layout.nodeCount(), nodes);
    expectValid();
}

std::string builderName(const testing::TestParamInfo<TreeBuilder>& info)
{
    const char* const names[] = {"Auto", "Balanced", "Radix", "TopDown", "Ploc"};
    return names[std::size_t(info.param)];
}

INSTANTIATE_TEST_SUITE_P(Builders, SideHierarchyTest,
                         testing::Values(TreeBuilder::Balanced, TreeBuilder::Radix, TreeBuilder::TopDown,
                                         TreeBuilder::Ploc),
                         builderName);
}  // namespace
}  // namespace drape::test
