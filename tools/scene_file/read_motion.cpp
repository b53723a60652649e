#include <limits>

#include "tools/scene_file/scene_parts.h"

namespace drape
{
namespace
{
void readRotation(const JsonObject& object, ScenePose& pose)
{
    if (!object.has("rotation")) return;
    const JsonObject rotation(object.at("rotation"), {"axis", "angle"});
    pose.m_axis = rotation.at("axis").direction();
    pose.m_angle = rotation.at("angle").number(kAngle);
}

SceneMotion readKeys(const JsonObject& motion)
{
    std::vector<SceneKey> keys;
    motion.at("keyframes")
        .each(1,
              [&](const JsonValue& item)
              {
                  const JsonObject object(item, {"time", "shift", "rotation"});
                  SceneKey key;
                  key.m_time = object.at("time").number(kTime);
                  if (!keys.empty() && !(key.m_time > keys.back().m_time))
                      object.at("time").fail("times of keyframes must increase");
                  object.read("shift", key.m_pose.m_shift, kCoordinate);
                  readRotation(object, key.m_pose);
                  keys.push_back(key);
              });
    const bool smooth =
        motion.has("interpolation") && motion.at("interpolation").word({"linear", "smooth"}) == "smooth";
    return motionThrough(std::move(keys), smooth);
}

SceneMotion readVelocities(const JsonObject& motion)
{
    Vector3 velocity, angular;
    double from = 0, until = kTime.m_most;
    motion.read("velocity", velocity, kSpeed);
    motion.read("angular_velocity", angular, kSpeed);
    motion.read("from", from, kTime);
    motion.read("until", until, kTime);
    if (until < from) motion.at("until").fail("the motion ends before it begins");
    return steadyMotion(velocity, angular, from, until);
}
}  // namespace

ScenePose readPose(const JsonObject& object)
{
    ScenePose pose;
    object.read("position", pose.m_shift, kCoordinate);
    readRotation(object, pose);
    return pose;
}

SceneMotion readMotion(const JsonValue& value, Vector3& centre)
{
    const JsonObject motion(value,
                            {"keyframes", "interpolation", "velocity", "angular_velocity", "from", "until", "centre"});
    motion.read("centre", centre, kCoordinate);
    if (motion.has("keyframes"))
    {
        for (const char* key : {"velocity", "angular_velocity", "from", "until"})
            motion.exclude("keyframes", key, "a motion has keyframes or constant velocities");
        return readKeys(motion);
    }
    if (motion.has("interpolation")) motion.at("interpolation").fail("only a motion with keyframes has it");
    if (!motion.has("velocity") && !motion.has("angular_velocity"))
        value.fail("a motion needs keyframes, velocity or angular_velocity");
    return readVelocities(motion);
}
}  // namespace drape
