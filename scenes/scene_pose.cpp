#include "scenes/scene_pose.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drape
{
namespace
{
// A unit quaternion.
struct Turn
{
    Vector3 m_vector;
    double m_scalar = 1;
};

Turn turnOf(const ScenePose& pose)
{
    return {std::sin(0.5 * pose.m_angle) * pose.m_axis, std::cos(0.5 * pose.m_angle)};
}

// Returns the turn `outer` after `inner`.
Turn operator*(const Turn& outer, const Turn& inner)
{
    return {outer.m_scalar * inner.m_vector + inner.m_scalar * outer.m_vector + cross(outer.m_vector, inner.m_vector),
            outer.m_scalar * inner.m_scalar - dot(outer.m_vector, inner.m_vector)};
}

ScenePose withTurn(const Vector3& shift, const Turn& turn)
{
    const double sine = length(turn.m_vector);
    if (!(sine > 0)) return {shift};
    return {shift, (1 / sine) * turn.m_vector, 2 * std::atan2(sine, turn.m_scalar)};
}

Vector3 turned(const ScenePose& pose, const Vector3& point)
{
    if (pose.m_angle == 0) return point;
    const Vector3 along = dot(pose.m_axis, point) * pose.m_axis;
    return along + std::cos(pose.m_angle) * (point - along) + std::sin(pose.m_angle) * cross(pose.m_axis, point);
}

bool sameAxis(const ScenePose& a, const ScenePose& b)
{
    return a.m_axis.x == b.m_axis.x && a.m_axis.y == b.m_axis.y && a.m_axis.z == b.m_axis.z;
}

ScenePose between(const ScenePose& a, const ScenePose& b, double share)
{
    const Vector3 shift = a.m_shift + share * (b.m_shift - a.m_shift);
    if (a.m_angle == 0) return {shift, b.m_axis, share * b.m_angle};
    if (b.m_angle == 0) return {shift, a.m_axis, (1 - share) * a.m_angle};
    if (sameAxis(a, b)) return {shift, a.m_axis, a.m_angle + share * (b.m_angle - a.m_angle)};
    const Turn first = turnOf(a);
    const Turn back = {-1 * first.m_vector, first.m_scalar};
    ScenePose way = withTurn({}, turnOf(b) * back);
    constexpr double kHalf = 3.14159265358979323846;
    if (way.m_angle > kHalf) way.m_angle -= 2 * kHalf;  // the shorter way round
    way.m_angle *= share;
    return withTurn(shift, turnOf(way) * first);
}
}  // namespace

Vector3 movedPoint(const ScenePose& pose, const Vector3& centre, const Vector3& point)
{
    if (pose.m_angle == 0) return point + pose.m_shift;
    return centre + turned(pose, point - centre) + pose.m_shift;
}

ScenePose movedPose(const ScenePose& move, const Vector3& centre, const ScenePose& start)
{
    const Vector3 shift = movedPoint(move, centre, start.m_shift);
    if (move.m_angle == 0) return {shift, start.m_axis, start.m_angle};
    if (start.m_angle == 0) return {shift, move.m_axis, move.m_angle};
    return withTurn(shift, turnOf(move) * turnOf(start));
}

SceneMotion motionThrough(std::vector<SceneKey> keys, bool smooth)
{
    return [keys = std::move(keys), smooth](double time)
    {
        const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                            [](double t, const SceneKey& key) { return t < key.m_time; });
        if (after == keys.begin()) return keys.front().m_pose;
        const SceneKey& before = *(after - 1);
        if (after == keys.end() || before.m_time == time) return before.m_pose;
        const double share = (time - before.m_time) / (after->m_time - before.m_time);
        return between(before.m_pose, after->m_pose, smooth ? share * share * (3 - 2 * share) : share);
    };
}

SceneMotion steadyMotion(const Vector3& velocity, const Vector3& angularVelocity, double from, double until)
{
    const double speed = length(angularVelocity);
    const Vector3 axis = speed > 0 ? normalized(angularVelocity) : Vector3{0, 1, 0};
    return [=](double time)
    {
        const double moved = std::clamp(time, from, until) - from;
        return ScenePose{moved * velocity, axis, speed * moved};
    };
}
}  // namespace drape
