// Broad phase: device, host and brute force over the leaf volumes give one set; the demand is counted past a full list.
#include "bullet_plugin/core/broad_phase/broad_phase.h"

#include <gtest/gtest.h>

#include <limits>

#include "scenes/shapes.h"
#include "tests/support/cases.h"
#include "tests/support/device_side.h"

namespace drape::test
{
namespace
{
struct Sides
{
    Side m_cloth, m_obstacle;
    std::vector<float> m_thickness;
};

// Refits both; a cloth's volumes reach as far as its largest thickness.
Sides makeSides(Side cloth, Side obstacle, const std::vector<float>& thickness)
{
    const std::size_t obstacles = obstacle.m_pool.meshCount();
    std::vector<float> radius(cloth.m_pool.meshCount(), -1.0f);
    for (std::size_t i = 0; i < thickness.size(); ++i)
        radius[i / obstacles] = std::max(radius[i / obstacles], thickness[i]);
    refitSide(cloth, radius);
    refitSide(obstacle, std::vector<float>(obstacles, 0.0f));
    return {std::move(cloth), std::move(obstacle), thickness};
}

Sides makeSides(const StepCase& step)
{
    Side cloth = makeSide({step.m_cloth});
    cloth.m_end = step.m_end;
    return makeSides(std::move(cloth), makeSide({step.m_obstacle}), {step.m_thickness});
}

std::vector<Candidate> hostCandidates(const Sides& sides)
{
    std::vector<Candidate> candidates;
    broadPhaseOnHost(sides.m_cloth.broadPhase(), sides.m_obstacle.broadPhase(), sides.m_thickness,
                     sides.m_obstacle.m_pool.meshCount(), candidates);
    sortCandidates(candidates);
    return candidates;
}
}  // namespace

class BroadPhaseTest : public BackendTest
{
protected:
    // What fits of the candidates, sorted; counts the demand.
    std::vector<Candidate> deviceCandidates(Sides& sides, std::size_t capacity, std::size_t& demand)
    {
        const std::unique_ptr<Device> device = openDevice(GetParam());
        if (!device) return {};
        BroadPhaseStage stage;
        stage.create(*device, programOf(*device, "broad_phase"));
        DeviceSide cloth, obstacle;
        cloth.upload(*device, sides.m_cloth);
        obstacle.upload(*device, sides.m_obstacle);
        Buffer<float> thickness;
        guardCopy(*device, thickness, sides.m_thickness);
        Buffer<Candidate> candidates;
        guard(*device, candidates, capacity);
        Buffer<StepCounters> counters;
        clearCounters(*device, counters);
        stage.enqueue(*device, {cloth.m_nodes, cloth.m_order, cloth.m_triangles, sides.m_cloth.m_layout},
                      {obstacle.m_nodes, obstacle.m_order, obstacle.m_triangles, sides.m_obstacle.m_layout}, thickness,
                      sides.m_obstacle.m_pool.meshCount(), candidates, counters);
        demand = readCounters(*device, counters).m_candidates;
        std::vector<Candidate> found = contents(*device, candidates, std::min(demand, candidates.capacity()));
        sortCandidates(found);
        EXPECT_TRUE(intact(*device, candidates) && intact(*device, counters) && intact(*device, thickness));
        EXPECT_TRUE(cloth.allIntact(*device) && obstacle.allIntact(*device));
        EXPECT_FALSE(device->failed()) << device->error().text();
        return found;
    }

    void expectAllAgree(Sides sides)
    {
        const std::vector<Candidate> brute = bruteForceCandidates(sides.m_cloth, sides.m_obstacle, sides.m_thickness);
        EXPECT_TRUE(sameBytes(hostCandidates(sides), brute));
        std::size_t demand = 0;
        EXPECT_TRUE(sameBytes(deviceCandidates(sides, brute.size(), demand), brute));
        EXPECT_EQ(demand, brute.size());
    }
};

TEST_P(BroadPhaseTest, SetsAgreeAtEverySize)
{
    const int sizes[][2] = {{1, 1}, {1, 65}, {2, 3}, {31, 33}, {63, 64}, {64, 1}, {65, 129}, {513, 63}, {1023, 3001}};
    std::uint32_t seed = 40;
    for (const auto& size : sizes)
    {
        const StepCase step = soupCase(size[0], size[1], true, ++seed);
        SCOPED_TRACE(step.trace() + ", " + std::to_string(size[0]) + " and " + std::to_string(size[1]) + " triangles");
        expectAllAgree(makeSides(step));
    }
}

TEST_P(BroadPhaseTest, SetsAgreeOnShapes)
{
    for (const char* shape : {"sphere", "torus", "bowl", "stairs"})
    {
        const StepCase step = fallingCase(shape, 17, 0.02f, 60);
        SCOPED_TRACE(step.trace());
        expectAllAgree(makeSides(step));
    }
}

TEST_P(BroadPhaseTest, OnlyPairedMeshesMeet)
{
    const float no = -1.0f;
    Sides sides =
        makeSides(makeSide({makeSoup(1, 0.2f, 90, 1), makeSoup(1, 0.2f, 100, 2), makeSoup(1, 0.2f, 110, 3)}),
                  makeSide({makeSoup(1, 0.2f, 120, 4), makeSoup(1, 0.2f, 130, 5)}), {no, 0.01f, 0.02f, 0.03f, no, no});
    const std::vector<Candidate> brute = bruteForceCandidates(sides.m_cloth, sides.m_obstacle, sides.m_thickness);
    for (const Candidate& candidate : brute)
    {
        const std::uint32_t cloth = sides.m_cloth.m_pool.triangles()[candidate.m_cloth].m_mesh;
        const std::uint32_t obstacle = sides.m_obstacle.m_pool.triangles()[candidate.m_obstacle].m_mesh;
        ASSERT_GE(sides.m_thickness[cloth * 2 + obstacle], 0.0f);
    }
    ASSERT_FALSE(brute.empty());
    expectAllAgree(sides);
}

TEST_P(BroadPhaseTest, TrianglesWithoutAValidNodeMeetNothing)
{
    StepCase step = soupCase(200, 300, true, 70);
    SCOPED_TRACE(step.trace());
    // Loose triangles of nine coordinates: all three nodes of two, one node of a third.
    for (const std::size_t at : {0u, 3u, 6u})
    {
        step.m_end[9 * 11 + at] = std::numeric_limits<float>::quiet_NaN();
        step.m_cloth.m_positions[9 * 44 + at + 1] = std::numeric_limits<float>::infinity();
    }
    step.m_end[9 * 60] = std::numeric_limits<float>::quiet_NaN();
    Sides sides = makeSides(step);
    for (const Candidate& candidate : hostCandidates(sides))
    {
        ASSERT_NE(candidate.m_cloth, 11u);
        ASSERT_NE(candidate.m_cloth, 44u);
    }
    expectAllAgree(sides);
}

TEST_P(BroadPhaseTest, NothingOnOneSide)
{
    const StepCase step = soupCase(20, 20, false, 71);
    expectAllAgree(makeSides(makeSide({step.m_cloth}), makeSide({TriangleMesh()}), {0.1f}));
    expectAllAgree(makeSides(makeSide({TriangleMesh()}), makeSide({step.m_obstacle}), {0.1f}));
}

TEST_P(BroadPhaseTest, FullListCountsOnAndWritesNothingBeyond)
{
    Sides sides = makeSides(soupCase(700, 900, true, 72));
    const std::vector<Candidate> brute = bruteForceCandidates(sides.m_cloth, sides.m_obstacle, sides.m_thickness);
    ASSERT_GT(brute.size(), 1000u);
    for (std::size_t capacity : {std::size_t(1), std::size_t(17), brute.size() / 2, brute.size() - 1})
    {
        SCOPED_TRACE("capacity " + std::to_string(capacity));
        std::size_t demand = 0;
        const std::vector<Candidate> found = deviceCandidates(sides, capacity, demand);
        EXPECT_EQ(demand, brute.size());
        EXPECT_EQ(found.size(), capacity);
        for (const Candidate& candidate : found)
            ASSERT_TRUE(contains(brute, candidate.m_cloth, candidate.m_obstacle));
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, BroadPhaseTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
