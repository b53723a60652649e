// Obstacles that move in the step: the same contacts as the cloth's motion relative to them gives, on every back end,
// and no launch for one that rests.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/lib/geometry/rigid_motion.h"
#include "tests/property/moving_obstacle.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
// Returns `pose` after the inverse of `of`, which is rigid.
Motion relative(const Motion& pose, const Motion& of)
{
    Motion result;
    for (int i = 0; i < 3; ++i)
    {
        result.m_rows[i][3] = pose.m_rows[i][3];
        for (int k = 0; k < 3; ++k)
        {
            result.m_rows[i][k] = 0;
            for (int j = 0; j < 3; ++j)
                result.m_rows[i][k] += pose.m_rows[i][j] * of.m_rows[k][j];
        }
        for (int k = 0; k < 3; ++k)
            result.m_rows[i][3] -= result.m_rows[i][k] * of.m_rows[k][3];
    }
    return result;
}

// Runs the case of runMoving() with the obstacle at rest at its end pose and the cloth's start moved instead.
std::vector<Contact> runOpposite(Pipeline& pipeline, const MovingCase& moving)
{
    StepCase step = moving.m_step;
    step.m_cloth.m_positions = mapped(relative(moving.m_end, moving.m_start), step.m_cloth.m_positions);
    step.m_obstacle.m_positions = mapped(moving.m_end, step.m_obstacle.m_positions);
    return runCase(pipeline, step);
}

bool sameFeatures(const Contact& a, const Contact& b)
{
    return a.m_featureIndex == b.m_featureIndex && a.m_kind == b.m_kind && a.m_obstacleFeature == b.m_obstacleFeature;
}

// Counts the contacts of `a` that are in `b` with numbers that differ by rounding only. Both are in canonical order.
std::size_t countAlike(const std::vector<Contact>& a, const std::vector<Contact>& b)
{
    std::size_t alike = 0;
    for (const Contact& contact : a)
    {
        const auto found =
            std::find_if(b.begin(), b.end(), [&](const Contact& other) { return sameFeatures(contact, other); });
        if (found == b.end()) continue;
        double off = std::fabs(contact.m_gap0 - found->m_gap0) + std::fabs(contact.m_gap1 - found->m_gap1);
        for (int i = 0; i < 3; ++i)
        {
            off = std::max(off, std::fabs(double(contact.m_normal[i]) - double(found->m_normal[i])));
            off = std::max(off, std::fabs(double(contact.m_point[i]) - double(found->m_point[i])));
        }
        if (off < 2e-3) ++alike;
    }
    return alike;
}
}  // namespace

TEST_P(MovingObstacleTest, GivesWhatTheOppositeMotionOfTheClothGives)
{
    std::uint32_t seed = 900;
    for (double angle : kAngles)
    {
        const MovingCase moving = movingCase("torus", angle, {0.3, -0.2, 0.4}, ++seed);
        SCOPED_TRACE(moving.m_step.trace());
        const std::unique_ptr<Pipeline> pipeline = make(), opposite = make();
        ASSERT_TRUE(pipeline && opposite);
        const std::vector<Contact> contacts = runMoving(*pipeline, moving);
        const std::vector<Contact> expected = runOpposite(*opposite, moving);
        ASSERT_GT(expected.size(), 100u);
        // Rounding decides a few contacts at the edge of the reach and of cones.
        EXPECT_GE(countAlike(contacts, expected), contacts.size() - contacts.size() / 50);
        EXPECT_GE(countAlike(expected, contacts), expected.size() - expected.size() / 50);
    }
}

// The cloth lies on the obstacle and moves with it.
void carryCloth(MovingCase& moving)
{
    const std::vector<float> lying = moving.m_step.m_cloth.m_positions;
    moving.m_step.m_cloth.m_positions = mapped(moving.m_start, lying);
    moving.m_step.m_end = mapped(moving.m_end, lying);
}

// A cloth that moves with the obstacle stays as far from it as it was.
TEST_P(MovingObstacleTest, ClothThatIsCarriedAlongPassesNothing)
{
    Random random(910);
    MovingCase moving = {drapedCase("sphere", 20, 0.03f, 910), motionOf(0.6, {1, 2, 3}, random),
                         motionOf(1.0, {-1, 0.5, 2}, random)};
    SCOPED_TRACE(moving.m_step.trace());
    carryCloth(moving);
    const std::unique_ptr<Pipeline> pipeline = make();
    ASSERT_TRUE(pipeline);
    const std::vector<Contact> contacts = runMoving(*pipeline, moving);
    ASSERT_GT(contacts.size(), 100u);
    for (const Contact& contact : contacts)
    {
        EXPECT_NEAR(contact.m_gap0, contact.m_gap1, 1e-5f) << describe(contact);
        EXPECT_EQ(contact.m_time, 1.0f) << describe(contact);
    }
}

// planeAt() takes the contact's point for its vertex.
TEST_P(MovingObstacleTest, PointOfAVertexIsItsPlaceAtTheEnd)
{
    Random random(915);
    MovingCase moving = {drapedCase("sphere", 12, 0.03f, 915), motionOf(0.6, {1, 2, 3}, random),
                         motionOf(0.7, {1, 2.1, 3}, random)};
    SCOPED_TRACE(moving.m_step.trace());
    carryCloth(moving);
    const std::unique_ptr<Pipeline> pipeline = make();
    ASSERT_TRUE(pipeline);
    const Pose end = moving.m_end.pose();
    std::size_t vertices = 0;
    for (const Contact& contact : runMoving(*pipeline, moving))
    {
        if (contact.m_kind != DRAPE_FACE_VERTEX) continue;
        const Vec3 own = vec3Load(moving.m_step.m_obstacle.m_positions.data(), contact.m_obstacleFeature);
        const Vec3 place = mapPoint(end.data(), own);
        EXPECT_EQ(contact.m_point[0], place.x) << describe(contact);
        EXPECT_EQ(contact.m_point[1], place.y) << describe(contact);
        EXPECT_EQ(contact.m_point[2], place.z) << describe(contact);
        ++vertices;
    }
    EXPECT_GT(vertices, 50u);
}

TEST_P(MovingObstacleTest, EqualPosesAreATeleport)
{
    const MovingCase moving = movingCase("box", 0.0, {0.0, 1.0, 0.0}, 920);
    SCOPED_TRACE(moving.m_step.trace());
    const std::unique_ptr<Pipeline> pipeline = make(), rests = make();
    ASSERT_TRUE(pipeline && rests);
    const StepCase& step = moving.m_step;
    const MeshId cloth = addCloth(*pipeline, step.m_cloth), obstacle = addObstacle(*pipeline, step.m_obstacle);
    const Pose far = moving.m_start.pose(), near = moving.m_end.pose();
    std::vector<Contact> contacts;
    for (const Pose& pose : {far, near})
    {
        pipeline->placeObstacle(obstacle, pose.data(), pose.data());
        setMotion(*pipeline, cloth, step.m_end, step.m_end);
        pipeline->addPair(cloth, obstacle, step.m_thickness);
        contacts = runStep(*pipeline);
    }
    MovingCase resting = moving;
    resting.m_start = resting.m_end;
    resting.m_step.m_cloth.m_positions = step.m_end;
    const std::vector<Contact> expected = runMoving(*rests, resting);
    EXPECT_GT(expected.size(), 20u);
    EXPECT_TRUE(sameBytes(contacts, expected)) << difference(contacts, expected);
}

// An obstacle at rest costs no launch, with a place or without.
TEST_P(MovingObstacleTest, RestCostsNoLaunch)
{
    Settings settings = GetParam().m_settings;
    settings.m_profileKernels = true;
    const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
    ASSERT_TRUE(pipeline);
    const StepCase step = fallingCase("sphere", 12, 0.03f, 970);
    SCOPED_TRACE(step.trace());
    const MeshId cloth = addCloth(*pipeline, step.m_cloth), obstacle = addObstacle(*pipeline, step.m_obstacle);
    Random random(970);
    const Pose rest = motionOf(0, kNoShift, random).pose(), shifted = motionOf(0, {0, 0.1, 0}, random).pose();
    const auto launches = [&]
    {
        pipeline->takeKernelTimes();
        setMotion(*pipeline, cloth, step.m_cloth.m_positions, step.m_end);
        pipeline->addPair(cloth, obstacle, step.m_thickness);
        EXPECT_FALSE(runStep(*pipeline).empty());
        return pipeline->takeKernelTimes().size();
    };
    launches();  // uploads and packs
    const std::size_t without = launches();
    pipeline->placeObstacle(obstacle, rest.data(), rest.data());
    launches();
    pipeline->placeObstacle(obstacle, rest.data(), rest.data());
    EXPECT_EQ(launches(), without);
    pipeline->placeObstacle(obstacle, rest.data(), shifted.data());
    const std::size_t moving = launches();
    EXPECT_TRUE(moving > without || GetParam().m_device < 0);
}

// Tests of scenery and of rounding, in files of their own, use this instantiation, too.
INSTANTIATE_TEST_SUITE_P(Backends, MovingObstacleTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
