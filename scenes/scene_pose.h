// Poses and motions of a scene's bodies: a turn about an axis, and then a shift.
//
// Lengths in metres, angles in radians, times in seconds.
#pragma once

#include <functional>
#include <vector>

#include "scenes/vector3.h"

namespace drape
{
struct ScenePose
{
    Vector3 m_shift;
    Vector3 m_axis = {0, 1, 0};  // unit
    double m_angle = 0;          // rad
};

using SceneMotion = std::function<ScenePose(double time)>;

// Returns the point turned about `centre` and then shifted. A turn about an axis of coordinates, and one by 0, leave
// the coordinates along it as they are, bit for bit.
Vector3 movedPoint(const ScenePose& pose, const Vector3& centre, const Vector3& point);

// Returns the pose of a body that starts at `start` and is then moved: turned about `centre` and shifted.
ScenePose movedPose(const ScenePose& move, const Vector3& centre, const ScenePose& start);

struct SceneKey
{
    double m_time = 0;
    ScenePose m_pose;
};

// Returns the motion through the keys, whose times increase: straight from one to the next, or with `smooth` slow near
// each. At a key's time it is the key's pose, bit for bit; before the first and after the last key it stays. Keys about
// one axis are joined by their angles, which may be many turns, and others by the shortest turn.
SceneMotion motionThrough(std::vector<SceneKey> keys, bool smooth);

// Returns the motion with constant velocities (m/s, rad/s about the vector's direction) from one time to another.
SceneMotion steadyMotion(const Vector3& velocity, const Vector3& angularVelocity, double from, double until);
}  // namespace drape
