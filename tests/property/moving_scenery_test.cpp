// Several obstacles, of which some move: every pair is found, and obstacles that are placed anew are as
// if they had just been made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/property/moving_obstacle.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
// Several obstacles beside each other, of which some move, under one cloth each.
struct Scenery
{
    std::vector<MovingCase> m_cases;

    explicit Scenery(std::uint32_t seed)
    {
        const char* const shapes[] = {"torus", "sphere", "bowl", "box"};
        for (std::uint32_t i = 0; i < 4; ++i)
        {
            const double angle = i == 0 ? 0.0 : kAngles[i];
            m_cases.push_back(movingCase(shapes[i], angle, {0.1 * i, -0.3 * i, 0.2}, seed + i));
            if (i == 1) m_cases.back().m_start = m_cases.back().m_end;  // rests
        }
    }
};

// Runs all cloths against all obstacles, apart from one pair.
std::vector<Contact> runScenery(Pipeline& pipeline, const Scenery& scenery)
{
    std::vector<MeshId> cloths, obstacles;
    for (const MovingCase& moving : scenery.m_cases)
    {
        cloths.push_back(addCloth(pipeline, moving.m_step.m_cloth));
        obstacles.push_back(addObstacle(pipeline, moving.m_step.m_obstacle));
    }
    for (std::size_t i = 0; i < cloths.size(); ++i)
    {
        const MovingCase& moving = scenery.m_cases[i];
        pipeline.placeObstacle(obstacles[i], moving.m_start.pose().data(), moving.m_end.pose().data());
        setMotion(pipeline, cloths[i], moving.m_step.m_cloth.m_positions, moving.m_step.m_end);
    }
    for (std::size_t i = 0; i < cloths.size(); ++i)
        for (std::size_t k = 0; k < obstacles.size(); ++k)
            if (i != 2 || k != 3) pipeline.addPair(cloths[i], obstacles[k], 0.03f);
    return runStep(pipeline);
}

// Returns the contacts of every pair of triangles, without a broad phase.
std::vector<Contact> contactsOfAllPairs(const Scenery& scenery, float reachScale)
{
    std::vector<TriangleMesh> cloths, obstacles;
    std::vector<float> ends, thickness(16, 0.03f);
    thickness[2 * 4 + 3] = -1.0f;
    for (const MovingCase& moving : scenery.m_cases)
    {
        cloths.push_back(moving.m_step.m_cloth);
        obstacles.push_back(moving.m_step.m_obstacle);
        ends.insert(ends.end(), moving.m_step.m_end.begin(), moving.m_step.m_end.end());
    }
    Side cloth = makeSide(cloths), obstacle = makeSide(obstacles);
    cloth.m_end = ends;
    std::vector<ObstacleMotion> motions;
    for (std::uint32_t i = 0; i < 4; ++i)
    {
        ObstaclePoses poses;
        poses.m_posed = true;
        poses.m_start = scenery.m_cases[i].m_start.pose();
        poses.m_end = scenery.m_cases[i].m_end.pose();
        if (poses.moves()) motions.push_back(makeMotion(poses, MeshBox{{0, 0, 0}, {0, 0, 0}}, i));
    }
    std::vector<Candidate> pairs = allPairs(cloth, obstacle);
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                               [&](Candidate pair)
                               {
                                   const std::uint32_t row = cloth.m_pool.triangles()[pair.m_cloth].m_mesh * 4;
                                   return thickness[row + obstacle.m_pool.triangles()[pair.m_obstacle].m_mesh] < 0.0f;
                               }),
                pairs.end());
    std::vector<Contact> contacts;
    const MotionList list = {motions.data(), std::uint32_t(motions.size())};
    contactsOfPairs(pairs, cloth.cloth(), obstacle.obstacle(), {thickness, 4, reachScale, DRAPE_AUTOMATIC, list},
                    contacts);
    return contacts;
}
}  // namespace

// A step finds what testing every pair of triangles finds, bit for bit: the end poses are the identity, so
// that the obstacles' positions are those given.
TEST_P(MovingObstacleTest, NoPairIsLost)
{
    for (std::uint32_t seed : {930u, 940u, 950u})
    {
        const Scenery scenery(seed);
        SCOPED_TRACE("seed " + std::to_string(seed));
        const std::vector<Contact> expected = contactsOfAllPairs(scenery, 1.0f + Settings().m_activation);
        ASSERT_GT(expected.size(), 1000u);
        const std::unique_ptr<Pipeline> pipeline = make();
        ASSERT_TRUE(pipeline);
        const std::vector<Contact> contacts = runScenery(*pipeline, scenery);
        EXPECT_TRUE(sameBytes(contacts, expected)) << difference(contacts, expected);
    }
}

// Obstacles that are placed anew, one, some or all of them, and change back: the same as a new pipeline, on host and
// device.
TEST_P(MovingObstacleTest, PlacingAnewEqualsRebuild)
{
    Random random(960);
    const Scenery scenery(960);
    const std::unique_ptr<Pipeline> old = make();
    ASSERT_TRUE(old);
    std::vector<MeshId> cloths, obstacles;
    for (const MovingCase& moving : scenery.m_cases)
    {
        cloths.push_back(addCloth(*old, moving.m_step.m_cloth));
        obstacles.push_back(addObstacle(*old, moving.m_step.m_obstacle));
    }
    std::vector<Motion> poses(4, motionOf(0, kNoShift, random));
    for (std::uint32_t step = 0; step < 12; ++step)
    {
        SCOPED_TRACE("seed 960, step " + std::to_string(step));
        Settings host = allBackends()[0].m_settings;
        const std::unique_ptr<Pipeline> fresh = makePipeline(host);
        ASSERT_TRUE(fresh);
        std::vector<Motion> before = poses;
        for (std::size_t i = 0; i < poses.size(); ++i)
            if (step > 0 && (step >> (i % 3)) & 1u)
                poses[i] = motionOf(random.uniform(-0.2f, 0.2f), {random.uniform(-0.1f, 0.1f), 0, 0.05}, random);
        std::vector<MeshId> freshCloths, freshObstacles;
        for (std::size_t i = 0; i < 4; ++i)
        {
            freshCloths.push_back(addCloth(*fresh, scenery.m_cases[i].m_step.m_cloth));
            freshObstacles.push_back(addObstacle(*fresh, scenery.m_cases[i].m_step.m_obstacle));
        }
        for (std::size_t i = 0; i < 4; ++i)
        {
            const StepCase& now = scenery.m_cases[i].m_step;
            if (step > 1 || i < 2)
            {
                old->placeObstacle(obstacles[i], before[i].pose().data(), poses[i].pose().data());
                fresh->placeObstacle(freshObstacles[i], before[i].pose().data(), poses[i].pose().data());
            }
            setMotion(*old, cloths[i], now.m_cloth.m_positions, now.m_end);
            setMotion(*fresh, freshCloths[i], now.m_cloth.m_positions, now.m_end);
            old->addPair(cloths[i], obstacles[i], 0.03f);
            fresh->addPair(freshCloths[i], freshObstacles[i], 0.03f);
        }
        const std::vector<Contact> placed = runStep(*old), rebuilt = runStep(*fresh);
        EXPECT_GT(rebuilt.size(), 200u);
        ASSERT_TRUE(sameBytes(placed, rebuilt)) << difference(placed, rebuilt);
    }
}
}  // namespace drape::test
