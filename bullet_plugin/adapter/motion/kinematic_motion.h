// Determines how kinematic objects move in a step, from the poses and velocities that Bullet keeps.
//
// Input: the objects' poses, interpolation transforms and velocities. Output: each object's pose at the step's start
// and end. Several substeps share a motion evenly, at constant velocity. An object that was absent in the step before
// rests. If the velocity does not fit the change of pose (teleported and moved at once), the object arrives at its
// pose with its velocity, over this step alone.
//
// A pose that changes with a velocity is motion; one that changes without is a jump. Large motion that looks like a
// teleport is a jump, too. Cost: O(1) per object. Rules, reasons and limits: docs/design_notes/kinematic_motion.md.
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>

#include "LinearMath/btTransform.h"

class btCollisionObject;

namespace drape
{
struct BodyMotion
{
    btTransform m_start, m_end;

    bool moves() const { return !(m_start == m_end); }
    // Returns the transform that the motion applies to a point of the object.
    btTransform map() const { return m_end * m_start.inverse(); }
};

// Returns the motion over a step of `dt` (s) of an object from its last pose `from` to Bullet's pose `to`. Velocities
// are in m/s and rad/s.
BodyMotion motionInStep(const btTransform& from, const btTransform& to, const btVector3& linearVelocity,
                        const btVector3& angularVelocity, btScalar dt);

class KinematicMotions
{
public:
    // Returns whether, since the last step ended, a cloth is anchored to the object or an app moved nodes of a cloth
    // as the map does, to within `slack` (m).
    using MovedAlong = std::function<bool(const btCollisionObject& object, const btTransform& map, btScalar slack)>;

    // Forgets objects that were not observed in the step before. movedAlong: called in this step for objects that moved
    // far; null: always false.
    void beginStep(btScalar dt, MovedAlong movedAlong = nullptr);
    // Declares the object's pose a placement: the change to it is no motion.
    void teleported(const btCollisionObject& object) { m_tracked.erase(&object); }
    // Returns the object's motion in this step; unchanged until the next step begins.
    BodyMotion observe(const btCollisionObject& object);

private:
    struct Tracked
    {
        BodyMotion m_motion;
        BodyMotion m_change;  // change of the pose since the step before, swept or not
        std::uint64_t m_step;
        btTransform m_pose;     // Bullet's pose; m_motion ends before it while substeps share the motion
        btTransform m_noticed;  // pose at which Bullet took the velocity
        bool m_shares;          // several substeps share a motion that looks like theirs
    };

    void advance(Tracked& tracked, const btCollisionObject& object) const;
    bool isTeleport(const btTransform& from, const BodyMotion& before, const btCollisionObject& object) const;

    std::unordered_map<const btCollisionObject*, Tracked> m_tracked;  // never followed
    std::uint64_t m_step = 0;
    btScalar m_dt = 0;
    MovedAlong m_movedAlong;
};
}  // namespace drape
