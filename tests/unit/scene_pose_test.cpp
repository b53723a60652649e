// Motions of scenes (scenes/scene_pose.h).
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/scene_pose.h"

namespace drape::test
{
namespace
{
constexpr double kPi = 3.14159265358979323846;

void expectNear(const Vector3& a, const Vector3& b, const char* text)
{
    EXPECT_NEAR(a.x, b.x, 1e-12) << text;
    EXPECT_NEAR(a.y, b.y, 1e-12) << text;
    EXPECT_NEAR(a.z, b.z, 1e-12) << text;
}
}  // namespace

TEST(ScenePose, APointIsTurnedAboutTheCentreAndShifted)
{
    const ScenePose pose = {{0, 0, 5}, {0, 1, 0}, kPi / 2};
    expectNear(movedPoint(pose, {1, 0, 0}, {2, 3, 0}), {1, 3, 4}, "a quarter about y takes x to -z");
    const Vector3 still = movedPoint({{0, 0, 0}, {0, 1, 0}, 0.7}, {}, {0, 0.1, 0});
    EXPECT_EQ(still.y, 0.1) << "the coordinate along the axis keeps its bits";
}

TEST(ScenePose, ABodyIsMovedLikeItsPoints)
{
    const ScenePose start = {{1, 2, 3}, {0, 0, 1}, 0.4}, move = {{-1, 0.5, 2}, normalized({1, 1, 0}), 1.1};
    const Vector3 centre = {0.3, 0, -0.2}, corner = {0.5, -0.25, 1};
    const Vector3 direct = movedPoint(move, centre, movedPoint(start, {}, corner));
    expectNear(movedPoint(movedPose(move, centre, start), {}, corner), direct, "corner");
}

TEST(ScenePose, KeyframesAreMetExactlyAndJoinedStraight)
{
    const ScenePose first = {{0.1, 0, 0}, {0, 0, 1}, 1}, last = {{0.3, 0, 0}, {0, 0, 1}, 1 + 6 * kPi};
    const SceneMotion linear = motionThrough({{1, first}, {2, last}}, false);
    EXPECT_EQ(linear(0).m_angle, first.m_angle) << "before the first";
    EXPECT_EQ(linear(1).m_shift.x, first.m_shift.x);
    EXPECT_EQ(linear(2).m_angle, last.m_angle);
    EXPECT_EQ(linear(9).m_shift.x, last.m_shift.x) << "after the last";
    EXPECT_NEAR(linear(1.5).m_shift.x, 0.2, 1e-15);
    EXPECT_NEAR(linear(1.5).m_angle, 1 + 3 * kPi, 1e-12) << "three turns about one axis are three turns";
    const SceneMotion smooth = motionThrough({{1, first}, {2, last}}, true);
    EXPECT_NEAR(smooth(1.5).m_shift.x, 0.2, 1e-15);
    EXPECT_LT(smooth(1.1).m_shift.x, linear(1.1).m_shift.x);
}

TEST(ScenePose, KeyframesAboutTwoAxesAreJoinedByTheShortestTurn)
{
    const ScenePose first = {{}, {1, 0, 0}, kPi / 2}, last = {{}, {0, 1, 0}, kPi / 2};
    const SceneMotion motion = motionThrough({{0, first}, {1, last}}, false);
    const Vector3 near = movedPoint(motion(1e-9), {}, {1, 2, 3}), end = movedPoint(motion(1 - 1e-9), {}, {1, 2, 3});
    EXPECT_LT(length(near - movedPoint(first, {}, {1, 2, 3})), 1e-6);
    EXPECT_LT(length(end - movedPoint(last, {}, {1, 2, 3})), 1e-6);
}

TEST(ScenePose, ASteadyMotionLastsFromOneTimeToTheOther)
{
    const SceneMotion motion = steadyMotion({1, 0, 0}, {0, 0, 2}, 1, 3);
    EXPECT_EQ(motion(0.5).m_shift.x, 0);
    EXPECT_NEAR(motion(2).m_shift.x, 1, 1e-15);
    EXPECT_NEAR(motion(2).m_angle, 2, 1e-15);
    EXPECT_NEAR(motion(7).m_shift.x, 2, 1e-15);
}
}  // namespace drape::test
