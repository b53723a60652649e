#include "bullet_plugin/adapter/motion/kinematic_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "LinearMath/btTransformUtil.h"

namespace drape
{
namespace
{
// Maximum substeps of one stepSimulation() that share a motion.
constexpr btScalar kMostSubsteps = 100;

// Rounding of small angles, radians. Bullet computes them as arc cosines in float: below this they are noise.
constexpr btScalar kAngleNoise = btScalar(2e-3);

// Shares by which a velocity may deviate from the change of pose, and a distance (m) that is rounding.
constexpr btScalar kShiftSlack = btScalar(0.02);
constexpr btScalar kTurnSlack = btScalar(0.1);
constexpr btScalar kShiftNoise = btScalar(1e-4);

// Maximum poses between two steps that count as one motion, for frames faster than steps, and the minimum cosine
// between that motion and the velocity.
constexpr btScalar kMostPoses = 16;
constexpr btScalar kSameDirection = btScalar(0.7);

struct Turn
{
    btVector3 m_axis;
    btScalar m_angle;  // 0 to π
};

Turn turnBetween(const btTransform& from, const btTransform& to)
{
    Turn turn;
    btTransformUtil::calculateDiffAxisAngle(from, to, turn.m_axis, turn.m_angle);
    if (turn.m_angle > SIMD_PI)
    {
        turn.m_angle = SIMD_2_PI - turn.m_angle;
        turn.m_axis = -turn.m_axis;
    }
    return turn;
}

btTransform moved(const btTransform& from, const btVector3& shift, const btVector3& axis, btScalar angle)
{
    btTransform to(from.getBasis(), from.getOrigin() + shift);
    if (angle != 0 && axis.length2() > 0) to.setBasis(btMatrix3x3(btQuaternion(axis, angle)) * from.getBasis());
    return to;
}

// Returns the number of substeps in which the velocity makes the change of pose; 0 if the two do not fit.
btScalar substepsBetween(const btTransform& from, const btTransform& to, const btVector3& velocity,
                         const btVector3& angularVelocity, btScalar dt)
{
    if (from == to || !(dt > 0)) return 0;
    const Turn turn = turnBetween(from, to);
    const btVector3 shift = to.getOrigin() - from.getOrigin();
    const btScalar speed = velocity.length(), turning = angularVelocity.length();
    const bool byShift = speed * dt > kShiftNoise || !(turning * dt > 0);
    const btScalar time = byShift ? shift.length() / speed : turn.m_angle / turning;
    const btScalar count = std::round(time / dt);
    if (!(count >= 1) || count > kMostSubsteps) return 0;
    if ((velocity * (count * dt) - shift).length() > kShiftSlack * shift.length() + kShiftNoise) return 0;
    if (std::fabs(turning * count * dt - turn.m_angle) > kTurnSlack * turn.m_angle + count * kAngleNoise) return 0;
    if (turn.m_angle > 10 * kAngleNoise && turn.m_axis.dot(angularVelocity) < (1 - kTurnSlack) * turning) return 0;
    return count;
}

// Returns whether the change of pose may combine several poses set before one step. The velocity knows only the last.
bool isNear(const btTransform& from, const btTransform& to, const btVector3& velocity, const btVector3& angularVelocity,
            btScalar dt)
{
    const btVector3 shift = to.getOrigin() - from.getOrigin();
    const btScalar farthest = kMostPoses * velocity.length() * dt, most = kMostPoses * angularVelocity.length() * dt;
    if (shift.length() > kShiftNoise && shift.dot(velocity) < kSameDirection * shift.length() * velocity.length())
        return false;
    return shift.length() <= farthest + kShiftNoise && turnBetween(from, to).m_angle <= most + kMostPoses * kAngleNoise;
}

// Distances, in m, in radii of the shape, and in m, beyond which an object was placed instead of moved. Bullet removes
// a soft body from its simulation if its box is 10^6 m across.
constexpr btScalar kMostShift = 100, kMostRadii = 100, kMostOfAll = btScalar(2.5e5);

// Minimum motion of a body, in radii, for nodes that moved along to indicate a teleport.
constexpr btScalar kFarRadii = 1;

// Minimum turn of such a body, radians, and minimum ratio of its motion to that of the step before. A body that
// continues its motion is carried, not teleported.
constexpr btScalar kFarTurn = SIMD_HALF_PI, kFaster = 4;

btScalar radiusOf(const btCollisionObject& object)
{
    btVector3 centre;
    btScalar radius = 0;
    if (object.getCollisionShape()) object.getCollisionShape()->getBoundingSphere(centre, radius);
    return radius;
}

btScalar mostShift(btScalar radius)
{
    return std::min(std::max(kMostShift, kMostRadii * radius), kMostOfAll);
}

// Returns the pose at which Bullet takes the velocity, if it does.
const btTransform& noticedBy(const btCollisionObject& object)
{
    return btRigidBody::upcast(&object) ? object.getInterpolationWorldTransform() : object.getWorldTransform();
}
}  // namespace

BodyMotion motionInStep(const btTransform& from, const btTransform& to, const btVector3& linearVelocity,
                        const btVector3& angularVelocity, btScalar dt)
{
    if (from == to || !(dt > 0)) return BodyMotion{to, to};
    const Turn turn = turnBetween(from, to);
    if (linearVelocity.length2() == 0 && angularVelocity.length2() == 0)
    {
        const bool slowTurn = from.getOrigin() == to.getOrigin() && turn.m_angle < kAngleNoise;
        return BodyMotion{slowTurn ? from : to, to};
    }
    const btScalar substeps = substepsBetween(from, to, linearVelocity, angularVelocity, dt);
    if (substeps == 1) return BodyMotion{from, to};
    if (substeps > 1)
    {
        const btVector3 shift = (to.getOrigin() - from.getOrigin()) / substeps;
        return BodyMotion{from, moved(from, shift, turn.m_axis, turn.m_angle / substeps)};
    }
    return BodyMotion{moved(to, linearVelocity * -dt, angularVelocity, -angularVelocity.length() * dt), to};
}

void KinematicMotions::beginStep(btScalar dt, MovedAlong movedAlong)
{
    m_dt = dt;
    m_movedAlong = std::move(movedAlong);
    for (auto tracked = m_tracked.begin(); tracked != m_tracked.end();)
        tracked = tracked->second.m_step < m_step ? m_tracked.erase(tracked) : std::next(tracked);
    ++m_step;
}

// Returns the motion from the object's last pose to Bullet's current pose.
void KinematicMotions::advance(Tracked& tracked, const btCollisionObject& object) const
{
    const btTransform& pose = object.getWorldTransform();
    const btVector3& velocity = object.getInterpolationLinearVelocity();
    const btVector3& angularVelocity = object.getInterpolationAngularVelocity();
    const btTransform from = tracked.m_motion.m_end;
    const btTransform noticed = tracked.m_noticed;
    const bool early = !(from == tracked.m_pose) && !(pose == tracked.m_pose);
    tracked.m_pose = pose;
    tracked.m_noticed = noticedBy(object);
    bool whole = !(tracked.m_noticed == pose);
    if (!whole && velocity.isZero() && angularVelocity.isZero())
    {
        tracked.m_shares = true;
    }
    else if (!whole && from == pose)
    {
        tracked.m_shares = true;  // a substep that got nothing new
    }
    else if (!whole)
    {
        const bool near = isNear(from, pose, velocity, angularVelocity, m_dt);
        tracked.m_shares = !near || (tracked.m_shares && !early);
        whole = !tracked.m_shares || (substepsBetween(from, pose, velocity, angularVelocity, m_dt) == 0 &&
                                      substepsBetween(noticed, pose, velocity, angularVelocity, m_dt) > 0);
    }
    BodyMotion& motion = tracked.m_motion;
    const BodyMotion before = tracked.m_change;
    tracked.m_change = BodyMotion{from, pose};
    motion = whole && m_dt > 0 ? BodyMotion{from, pose} : motionInStep(from, pose, velocity, angularVelocity, m_dt);
    const btScalar shift = (motion.m_end.getOrigin() - motion.m_start.getOrigin()).length();
    if (shift > mostShift(radiusOf(object)) || isTeleport(from, before, object)) motion = BodyMotion{pose, pose};
}

// Returns whether this is a teleport: cloth moved along from the object's last pose to Bullet's pose, and the object
// did not move at about its former speed. The motion of several substeps counts as one.
bool KinematicMotions::isTeleport(const btTransform& from, const BodyMotion& before,
                                  const btCollisionObject& object) const
{
    if (!m_movedAlong) return false;
    const btTransform& pose = object.getWorldTransform();
    const btScalar radius = radiusOf(object);
    const auto shift = [](const btTransform& a, const btTransform& b)
    { return (b.getOrigin() - a.getOrigin()).length(); };
    const bool isFar = shift(from, pose) > std::max(kFarRadii * radius, kFaster * shift(before.m_start, before.m_end));
    const bool isTurned = turnBetween(from, pose).m_angle >
                          std::max(kFarTurn, kFaster * turnBetween(before.m_start, before.m_end).m_angle);
    return (isFar || isTurned) && m_movedAlong(object, pose * from.inverse(), radius);
}

BodyMotion KinematicMotions::observe(const btCollisionObject& object)
{
    const btTransform& pose = object.getWorldTransform();
    const auto found = m_tracked.find(&object);
    if (found == m_tracked.end())
    {
        const BodyMotion rest = {pose, pose};
        m_tracked[&object] = Tracked{rest, rest, m_step, pose, noticedBy(object), true};
        return rest;
    }
    Tracked& tracked = found->second;
    if (tracked.m_step < m_step)
    {
        advance(tracked, object);
        tracked.m_step = m_step;
    }
    return tracked.m_motion;
}
}  // namespace drape
