// Every traversal, on device and host, and brute force over the leaf volumes give one set; the demand is
// counted past a full list.
#include <gtest/gtest.h>

#include <limits>

#include "scenes/draped_cloth.h"
#include "scenes/models.h"
#include "scenes/shapes.h"
#include "study/tests/traversals.h"
#include "tests/support/cases.h"
#include "tests/support/published_data.h"

namespace drape::test
{
namespace
{
Sides makeSides(Side cloth, Side obstacle, const std::vector<float>& thickness)
{
    Sides sides = {std::move(cloth), std::move(obstacle), thickness, {}, {}};
    refitSides(sides);
    return sides;
}

Sides makeSides(const StepCase& step)
{
    Side cloth = makeSide({step.m_cloth});
    cloth.m_end = step.m_end;
    return makeSides(std::move(cloth), makeSide({step.m_obstacle}), {step.m_thickness});
}

// One of each; see tree_test.cpp for their settings.
std::vector<TreeMethods> allBuilders()
{
    std::vector<TreeMethods> all;
    for (TreeBuilder builder : {TreeBuilder::Balanced, TreeBuilder::Radix, TreeBuilder::TopDown, TreeBuilder::Ploc})
    {
        all.emplace_back();
        all.back().m_builder = builder;
    }
    return all;
}
}  // namespace

class TraversalSets : public DeviceTest
{
protected:
    void expectAllAgree(Sides sides) { expectAllFind(sides, bruteForce(sides)); }

    void expectAllFind(Sides& sides, const std::vector<Candidate>& brute)
    {
        for (Traversal traversal : allTraversals())
        {
            SCOPED_TRACE(traversalName(traversal));
            HostRun host(traversal);
            host.setTopology(sides);
            EXPECT_TRUE(sameBytes(host.run(sides), brute));
            DeviceRun device(*m_device, traversal);
            device.setTopology(sides);
            EXPECT_TRUE(sameBytes(device.run(brute.size()), brute));
            EXPECT_EQ(device.counters().m_candidates, brute.size());
        }
    }
};

TEST_P(TraversalSets, SetsAgreeAtEverySize)
{
    const int sizes[][2] = {{1, 1},   {1, 65}, {2, 3},    {7, 8},    {9, 7},      {31, 33},
                            {63, 64}, {64, 1}, {65, 129}, {513, 63}, {1023, 3001}};
    std::uint32_t seed = 40;
    for (const auto& size : sizes)
    {
        const StepCase step = soupCase(size[0], size[1], true, ++seed);
        SCOPED_TRACE(step.trace() + ", " + std::to_string(size[0]) + " and " + std::to_string(size[1]) + " triangles");
        expectAllAgree(makeSides(step));
    }
}

TEST_P(TraversalSets, SetsAgreeOnShapes)
{
    for (const char* shape : {"sphere", "torus", "bowl", "stairs"})
    {
        const StepCase step = fallingCase(shape, 17, 0.02f, 60);
        SCOPED_TRACE(step.trace());
        expectAllAgree(makeSides(step));
    }
}

// Everything overlaps: no traversal can stop early, and each shared stack and local queue is as full as it gets.
TEST_P(TraversalSets, EveryPairOverlaps)
{
    Sides sides = makeSides(soupCase(257, 601, false, 61));
    SCOPED_TRACE("seed 61");
    sides.m_thickness[0] = 10.0f;
    refitSides(sides);
    ASSERT_EQ(bruteForce(sides).size(), 257u * 601u);
    expectAllAgree(sides);
}

TEST_P(TraversalSets, OnlyPairedMeshesMeet)
{
    const float no = -1.0f;
    Sides sides =
        makeSides(makeSide({makeSoup(1, 0.2f, 90, 1), makeSoup(1, 0.2f, 100, 2), makeSoup(1, 0.2f, 110, 3)}),
                  makeSide({makeSoup(1, 0.2f, 120, 4), makeSoup(1, 0.2f, 130, 5)}), {no, 0.01f, 0.02f, 0.03f, no, no});
    const std::vector<Candidate> brute = bruteForce(sides);
    for (const Candidate& candidate : brute)
    {
        const std::uint32_t cloth = sides.m_cloth.m_pool.triangles()[candidate.m_cloth].m_mesh;
        const std::uint32_t obstacle = sides.m_obstacle.m_pool.triangles()[candidate.m_obstacle].m_mesh;
        ASSERT_GE(sides.m_thickness[cloth * 2 + obstacle], 0.0f);
    }
    ASSERT_FALSE(brute.empty());
    expectAllAgree(sides);
}

// With one obstacle its mesh is not looked up: the cloth without a pair has empty volumes.
TEST_P(TraversalSets, UnpairedClothMeetsNothing)
{
    Sides sides = makeSides(makeSide({makeSoup(1, 0.2f, 90, 1), makeSoup(1, 0.2f, 100, 2)}),
                            makeSide({makeSoup(1, 0.2f, 120, 4)}), {-1.0f, 0.02f});
    const std::vector<Candidate> brute = bruteForce(sides);
    ASSERT_FALSE(brute.empty());
    for (const Candidate& candidate : brute)
        ASSERT_EQ(sides.m_cloth.m_pool.triangles()[candidate.m_cloth].m_mesh, 1u);
    expectAllAgree(sides);
}

TEST_P(TraversalSets, TrianglesWithoutAValidNodeMeetNothing)
{
    StepCase step = soupCase(200, 300, true, 70);
    SCOPED_TRACE(step.trace());
    // The triangles are loose and have nine coordinates: spoils all three nodes of two, and one node of a third.
    for (const std::size_t at : {0u, 3u, 6u})
    {
        step.m_end[9 * 11 + at] = std::numeric_limits<float>::quiet_NaN();
        step.m_cloth.m_positions[9 * 44 + at + 1] = std::numeric_limits<float>::infinity();
    }
    step.m_end[9 * 60] = std::numeric_limits<float>::quiet_NaN();
    const Sides sides = makeSides(step);
    ASSERT_FALSE(bruteForce(sides).empty());
    for (const Candidate& candidate : bruteForce(sides))
    {
        ASSERT_NE(candidate.m_cloth, 11u);
        ASSERT_NE(candidate.m_cloth, 44u);
    }
    expectAllAgree(sides);
}

// Trees that no balanced one is like: all corners in one place, a long branch, nodes that are not numbers; met in part,
// and in whole.
TEST_P(TraversalSets, SetsAgreeInTreesOfEveryBuilder)
{
    const TriangleMesh soup = makeSoup(2.0f, 0.4f, 90, 75);
    SCOPED_TRACE("seed 75");
    std::size_t found = 0;
    const auto check =
        [&](const TriangleMesh& cloth, const TriangleMesh& obstacle, float thickness, const TreeMethods& methods)
    {
        Sides sides = {makeSide({cloth}), makeSide({obstacle}), {thickness}, {}, {}};
        plantTrees(sides, methods);
        refitSides(sides);
        const std::vector<Candidate> brute = bruteForce(sides);
        found += brute.size();
        expectAllFind(sides, brute);
    };
    for (const NamedMesh& mesh : degenerateMeshes(600))
    {
        for (const TreeMethods& methods : allBuilders())
        {
            for (const float thickness : {1.5f, 1e6f})
            {
                SCOPED_TRACE(mesh.first + ", builder " + std::to_string(int(methods.m_builder)) + ", thickness " +
                             std::to_string(thickness));
                check(soup, mesh.second, thickness, methods);
                check(mesh.second, soup, thickness, methods);
                if (HasFailure()) return;  // later ones would say the same at length
            }
        }
    }
    EXPECT_GT(found, 1000000u);
}

// A cloth of 2,048 triangles draped over each of the study's models. Over large ones a walk of the balanced tree is
// what the other builders' trees are held against, for time's sake.
TEST_P(TraversalSets, SetsAgreeOnModels)
{
    constexpr std::size_t kLarge = 100000;
    std::size_t models = 0;
    for (const std::string& model : studyModelNames())
    {
        TriangleMesh mesh;
        if (!loadStudyModel(model, mesh)) continue;
        ClothPlace place;
        place.m_cells = 32;
        place.m_size = 2.4;
        place.m_gap = 0.015;
        Sides sides = {makeSide({drapeCloth(HeightField(mesh), place)}), makeSide({mesh}), {0.03f}, {}, {}};
        TreeMethods balancedTree;
        balancedTree.m_builder = TreeBuilder::Balanced;
        plantTrees(sides, balancedTree);
        refitSides(sides);
        HostRun balanced(Traversal::Full);
        balanced.setTopology(sides);
        const bool isLarge = mesh.triangleCount() > kLarge;
        const std::vector<Candidate> expected = isLarge ? balanced.run(sides) : bruteForce(sides);
        EXPECT_GT(expected.size(), 5000u);
        for (const TreeMethods& methods : allBuilders())
        {
            if (isLarge && methods.m_builder == TreeBuilder::Balanced) continue;
            SCOPED_TRACE(model + ", builder " + std::to_string(int(methods.m_builder)));
            plantTrees(sides, methods);
            refitSides(sides);
            expectAllFind(sides, expected);
            if (HasFailure()) return;
        }
        ++models;
    }
    EXPECT_GE(models, 3u);
}

TEST_P(TraversalSets, NothingOnOneSide)
{
    const StepCase step = soupCase(20, 20, false, 71);
    expectAllAgree(makeSides(makeSide({step.m_cloth}), makeSide({TriangleMesh()}), {0.1f}));
    expectAllAgree(makeSides(makeSide({TriangleMesh()}), makeSide({step.m_obstacle}), {0.1f}));
}

TEST_P(TraversalSets, FullListCountsOnAndWritesNothingBeyond)
{
    Sides sides = makeSides(soupCase(700, 900, true, 72));
    SCOPED_TRACE("seed 72");
    const std::vector<Candidate> brute = bruteForce(sides);
    ASSERT_GT(brute.size(), 1000u);
    for (Traversal traversal : allTraversals())
    {
        DeviceRun device(*m_device, traversal);
        device.setTopology(sides);
        for (std::size_t capacity : {std::size_t(1), std::size_t(17), brute.size() / 2, brute.size() - 1})
        {
            SCOPED_TRACE(traversalName(traversal) + std::string(", capacity ") + std::to_string(capacity));
            const std::vector<Candidate> found = device.run(capacity);
            EXPECT_EQ(device.counters().m_candidates, brute.size());
            EXPECT_EQ(found.size(), capacity);
            for (const Candidate& candidate : found)
                ASSERT_TRUE(contains(brute, candidate.m_cloth, candidate.m_obstacle));
        }
    }
}

// Past the limit a traversal may end early, says so by its count, and the next run starts from what is complete.
TEST_P(TraversalSets, LimitIsExact)
{
    Sides sides = makeSides(soupCase(257, 601, false, 74));
    SCOPED_TRACE("seed 74");
    sides.m_thickness[0] = 10.0f;
    refitSides(sides);
    const std::size_t all = 257 * 601;
    for (Traversal traversal : allTraversals())
    {
        SCOPED_TRACE(traversalName(traversal));
        HostRun host(traversal);
        host.setTopology(sides);
        DeviceRun device(*m_device, traversal);
        device.setTopology(sides);
        for (const std::size_t limit : {all - 1, std::size_t(100), all})
        {
            EXPECT_EQ(host.isWithin(sides, limit), limit == all);
            device.run(10, limit);
            EXPECT_EQ(device.counters().m_candidates > limit, limit < all);
        }
        EXPECT_EQ(device.counters().m_candidates, all);
    }
}

// The counted tests of volumes are those that the host's version of the same traversal makes.
TEST_P(TraversalSets, CountsTests)
{
    Sides sides = makeSides(fallingCase("torus", 33, 0.02f, 73));
    SCOPED_TRACE("seed 73");
    for (Traversal traversal : {Traversal::Single, Traversal::Grid})
    {
        SCOPED_TRACE(traversalName(traversal));
        HostRun host(traversal);
        host.setTopology(sides);
        host.run(sides);
        DeviceRun device(*m_device, traversal, true), silent(*m_device, traversal);
        device.setTopology(sides);
        device.run(1);
        EXPECT_GT(device.counters().m_visits, 10000u);
        EXPECT_EQ(device.counters().m_visits, host.volumeTests());
        silent.setTopology(sides);
        silent.run(1);
        EXPECT_EQ(silent.counters().m_visits, 0u);
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, TraversalSets, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
