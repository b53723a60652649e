// A hierarchy that is built beside the steps: given once, and not at all when another one has come meanwhile.
#include "bullet_plugin/core/pipeline/tree_watch.h"

#include <gtest/gtest.h>

#include <chrono>

#include "bullet_plugin/core/mesh/topology.h"
#include "scenes/shapes.h"
#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
void rebuild(TreeWatch& watch, const TriangleMesh& mesh)
{
    const Topology topology = buildTopology(mesh.m_triangles.data(), mesh.triangleCount(), mesh.vertexCount());
    TreeMethods methods;
    methods.m_builder = TreeBuilder::Radix;
    watch.rebuild(methods, topology.m_triangles, {0}, mesh.m_positions);
}
}  // namespace

TEST(TreeWatch, GivesWhatItBuiltOnce)
{
    TreeWatch watch;
    RebuiltTrees trees;
    EXPECT_FALSE(watch.take(trees));
    EXPECT_FALSE(watch.isDecayed(1.0, 1.5f)) << "the first cost is what others are held against";
    EXPECT_TRUE(watch.isDecayed(2.0, 1.5f));
    rebuild(watch, shapeNamed("torus"));
    EXPECT_FALSE(watch.isDecayed(2.0, 1.5f)) << "one is being built";
    watch.wait();
    EXPECT_TRUE(watch.take(trees));
    EXPECT_EQ(trees.m_trees.size(), 1u);
    EXPECT_FALSE(watch.take(trees));
}

TEST(TreeWatch, DropsWhatIsSupersededWithoutWaitingForIt)
{
    TreeWatch watch;
    RebuiltTrees trees;
    using Clock = std::chrono::steady_clock;
    const TriangleMesh large = makeSphere(1.0f, 7);
    Clock::time_point start = Clock::now();
    rebuild(watch, large);
    watch.wait();
    const Clock::duration toBuild = Clock::now() - start;
    EXPECT_TRUE(watch.take(trees));
    trees = RebuiltTrees();
    rebuild(watch, large);
    start = Clock::now();
    watch.begin();
    EXPECT_LT(Clock::now() - start, toBuild / 4);
    EXPECT_FALSE(watch.take(trees)) << "still under way, or dropped";
    EXPECT_FALSE(watch.isDecayed(1.0, 1.5f));
    watch.wait();
    EXPECT_FALSE(watch.take(trees));
    EXPECT_TRUE(trees.m_trees.empty());
    EXPECT_FALSE(watch.isDecayed(1.0, 1.5f)) << "anew from here";
    EXPECT_TRUE(watch.isDecayed(2.0, 1.5f));
    rebuild(watch, shapeNamed("box"));
    watch.wait();
    EXPECT_TRUE(watch.take(trees));
    EXPECT_EQ(trees.m_trees.size(), 1u);
}
}  // namespace drape::test
