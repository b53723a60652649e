// How kinematic objects move in a step, from what Bullet knows of them.
//
// Bullet gives a kinematic object its pose at the end of stepSimulation() in the first of its substeps, and a velocity:
// the difference to its interpolation transform over the time of all substeps (btRigidBody::saveKinematicState). So a
// pose that changes with a velocity is motion, and a pose that changes without one is a jump: that is how
// setInterpolationWorldTransform() with the same pose tells a teleport, to Bullet and to Drape. Most apps set the world
// transform alone, which looks like motion. Two things tell it from one, for a way of more than the body's radius or
// a turn of more than a right angle, and of more than four times what the step before was:
// cloth hangs on the body by an anchor, or the app moved nodes of a cloth along with it, as with what a character
// wears. A body that is parked out of sight goes a way that is longer than 100 m and 100 times the shape's radius, or
// than 250 km. Distance tells nothing else: what is thrown goes as many of its radii in a step.
//
// Job: remember where each object was at the end of the step before and say where it is at this one's start and end.
// The motion of several substeps is shared out among them, at constant velocity. An object that was not there in the
// step before rests. Where the velocity does not fit the change of the pose (teleported and moved at once), the object
// comes to its pose with its velocity, over this step alone.
//
// Bullet does not know of every motion. A pose set after it took the velocity (by a tick's callback, or while the body
// sleeps) differs from the interpolation transform; where Bullet catches up, its velocity is from where it left off.
// Several poses set by setCenterOfMassTransform() before a step leave the last one's velocity, which looks like one of
// several substeps until the next pose comes too soon. All these are swept the whole way, the last from then on. A last
// pose set twice has no velocity, and is a jump. O(1) an object.
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
    // What the motion does to a point of the object.
    btTransform map() const { return m_end * m_start.inverse(); }
};

// Motion over the step of `dt` (s) of an object that was at `from` and that Bullet has at `to`, with its velocities in
// m/s and rad/s.
BodyMotion motionInStep(const btTransform& from, const btTransform& to, const btVector3& linearVelocity,
                        const btVector3& angularVelocity, btScalar dt);

class KinematicMotions
{
public:
    // Whether a cloth hangs on the object by an anchor, or an app moved nodes of one as the map does, to within `slack`
    // (m), since the last step ended.
    using MovedAlong = std::function<bool(const btCollisionObject& object, const btTransform& map, btScalar slack)>;

    // Forgets objects that were not observed in the step before. movedAlong: for this step, asked of objects that moved
    // far; null: no.
    void beginStep(btScalar dt, MovedAlong movedAlong = nullptr);
    // The object is where its pose says; how it came there is no motion.
    void teleported(const btCollisionObject& object) { m_tracked.erase(&object); }
    // The object's motion in this step; the same until the next begins.
    BodyMotion observe(const btCollisionObject& object);

private:
    struct Tracked
    {
        BodyMotion m_motion;
        BodyMotion m_change;  // of the pose from the step before, swept or not
        std::uint64_t m_step;
        btTransform m_pose;     // that Bullet had; the motion's end is on the way there while substeps share it
        btTransform m_noticed;  // the pose at which Bullet had taken the velocity
        bool m_shares;          // motion that looks like one of several substeps is shared out among them
    };

    void advance(Tracked& tracked, const btCollisionObject& object) const;
    bool isTeleport(const btTransform& from, const BodyMotion& before, const btCollisionObject& object) const;

    std::unordered_map<const btCollisionObject*, Tracked> m_tracked;  // never followed
    std::uint64_t m_step = 0;
    btScalar m_dt = 0;
    MovedAlong m_movedAlong;
};
}  // namespace drape
