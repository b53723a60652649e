// Bounds of soft bodies that cover a step's motion, so that Bullet's broad phase makes every pair that Drape needs, and
// sleeping ones that a kinematic object comes to, which have to be awake by then.
//
// Bullet's own bounds come from the node tree of the step before and lag behind fast cloth, and those of a kinematic
// object hold its pose at the end alone. Only bodies that Drape takes get wider bounds, and only near a mesh that Drape
// handles: wider bounds make more pairs for Bullet, and make them in another order. Input: bodies before and after
// predictMotion, before Bullet computes its pairs. Output: wider m_bounds. Cost: linear in the nodes of bodies that
// Drape takes (of sleeping ones while something moves), in the world's objects, which are asked for their shape, and in
// pairs of such a body and a mesh.
#pragma once

#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/kinematic_motion.h"

namespace drape
{
class PluginState;

// A static or kinematic object with a mesh or a compound, as it stands in a step.
struct StepObstacle
{
    const btCollisionObject* m_object;
    BodyMotion m_motion;      // from its pose to its pose where it rests
    btVector3 m_low, m_high;  // m, bounds at the pose that Bullet has of it
    btScalar m_reach;         // m, its part of the reach of contacts, as far as the bounds do not hold it
    btScalar m_change;        // m, of the side of a mesh's bounds that moved most since the step before because its
                              // vertices move; 0 where none does

    bool isActive() const { return m_motion.moves() || m_change > 0; }
};

// Lists the obstacles of the body's world that move or change in this step, and those that rest where `resting` is
// true. Observes the kinematic ones that rest in either case. Children of compounds and meshes that move are not asked
// whether they change. Empty where the body's world info names no broad phase.
std::vector<StepObstacle> stepObstacles(const PluginState& state, const btSoftBody& body, KinematicMotions& motions,
                                        bool resting);

// Whether an obstacle that moves or changes, of a pair that Drape handles comes near the sleeping body in this step:
// Bullet wakes bodies for it only once it has arrived.
bool isReached(const PluginState& state, const btSoftBody& body, const std::vector<StepObstacle>& obstacles);

// Widens the bounds of a body that Drape takes to its nodes' paths, and to those paths as moving obstacles see them,
// grown by the reach of contacts, where these come near an obstacle of a pair that Drape handles. They reach a mesh
// that changes one step before it may arrive: the motion of its vertices is known from the second step with a pair on.
// Bounds that are no numbers, because of a node that is none, become those of the other nodes where there is any
// obstacle: Bullet would stop simulating the body.
void coverMotion(const PluginState& state, btSoftBody& body, const std::vector<StepObstacle>& obstacles);
}  // namespace drape
