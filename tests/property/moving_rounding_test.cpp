// Obstacles that move or are placed where rounding decides: every back end decides alike.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "scenes/shapes.h"
#include "tests/property/moving_obstacle.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
Motion shiftOf(double x, double y, double z)
{
    Random random(0);
    return motionOf(0, {x, y, z}, random);
}

// Makes a triangle of cloth over the edge of a thin plate that rises by half a metre a step, 45 m up. Its last node
// ends level with the plate's upper face to the last bit, 24 mm beside it. The edge between upper face and side admits
// the node there.
MovingCase plateCase()
{
    StepCase step = {"plate", 0, {}, makeBox(1.2f, 0.004f, 1.2f), {}, 0.02f};
    translate(step.m_obstacle.m_positions, 0, 1, 0);
    step.m_cloth = looseTriangles({0.622380614f, 46.0153351f, -0.460110068f, 0.563151419f, 46.0354156f, -0.409699768f,
                                   0.623653889f, 46.0150299f, -0.403629512f});
    step.m_end = {0.622198939f,  46.5014725f, -0.460117459f, 0.563080788f, 46.5234604f,
                  -0.409705281f, 0.62371707f, 46.5019989f,   -0.403637558f};
    return {step, shiftOf(0, 45, 0), shiftOf(0, 45.5, 0)};
}
}  // namespace

TEST_P(MovingObstacleTest, NodeThatEndsLevelWithAPlatesFaceBesideIt)
{
    const MovingCase moving = plateCase();
    const std::unique_ptr<Pipeline> host = makePipeline(allBackends()[0].m_settings);
    ASSERT_TRUE(host);
    const std::vector<Contact> expected = runMoving(*host, moving);
    const auto beside = [](const Contact& contact)
    { return contact.m_kind == DRAPE_NODE_FACE && contact.m_clothFeature == 2 && contact.m_normal[0] > 0.999f; };
    EXPECT_TRUE(std::any_of(expected.begin(), expected.end(), beside));
    const std::unique_ptr<Pipeline> pipeline = make();
    ASSERT_TRUE(pipeline);
    const std::vector<Contact> contacts = runMoving(*pipeline, moving);
    EXPECT_TRUE(sameBytes(contacts, expected)) << difference(contacts, expected);
}

// The faces have 3 mm and their corners are rounded to 0.1 mm at their pose, so that they turn, and their cones do not.
TEST_P(MovingObstacleTest, SmallFacesPlacedFarOut)
{
    for (std::uint32_t seed = 970; seed < 974; ++seed)
    {
        Random random(seed);
        const Motion far = motionOf(0.4, {1200, 900, -1100}, random);
        MovingCase moving = {{"far out", seed, {}, makeTorus(0.05f, 0.02f, 96, 48), {}, 0.02f}, far, far};
        std::vector<float> corners;
        for (int i = 0; i < 1000; ++i)
        {
            const Vec3 middle = {random.uniform(-0.1f, 0.1f), random.uniform(-0.05f, 0.05f),
                                 random.uniform(-0.1f, 0.1f)};
            for (int k = 0; k < 3; ++k)
                for (const float coordinate : {middle.x, middle.y, middle.z})
                    corners.push_back(coordinate + random.uniform(-0.002f, 0.002f));
        }
        moving.m_step.m_cloth = looseTriangles(corners);
        moving.m_step.m_end = moving.m_step.m_cloth.m_positions = mapped(far, corners);
        SCOPED_TRACE(moving.m_step.trace());
        const std::unique_ptr<Pipeline> host = makePipeline(allBackends()[0].m_settings), pipeline = make();
        ASSERT_TRUE(host && pipeline);
        const std::vector<Contact> expected = runMoving(*host, moving), contacts = runMoving(*pipeline, moving);
        EXPECT_GT(expected.size(), 1000u);
        EXPECT_TRUE(sameBytes(contacts, expected)) << difference(contacts, expected);
    }
}
}  // namespace drape::test
