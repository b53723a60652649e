// Widens the bounds of soft bodies to cover a step's motion, so that Bullet's broad phase makes every pair that Drape
// needs. Wakes sleeping bodies before a kinematic object reaches them.
//
// Bullet's own bounds come from the node tree of the step before and lag behind fast cloth. Its bounds of a kinematic
// object cover the pose at the end alone. Only bodies that Drape handles get wider bounds, and only near a mesh that
// Drape handles: wider bounds make more pairs for Bullet, in another order.
//
// Input: bodies before and after predictMotion, before Bullet computes its pairs. Output: wider m_bounds. Cost:
// linear in the nodes of bodies that Drape handles (sleeping ones only while something moves), in the world's
// objects, whose shapes are checked, and in pairs of such a body and a mesh.
#pragma once

#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/motion/kinematic_motion.h"
#include "bullet_plugin/core/threads/thread_team.h"

namespace drape
{
class PluginState;

// An object with a shape of Drape's, or with a compound, as it stands in a step.
struct StepObstacle
{
    const btCollisionObject* m_object;
    BodyMotion m_motion;      // from its pose to its pose where it rests
    btVector3 m_low, m_high;  // m, bounds at the pose that Bullet has of it
    btScalar m_reach;         // m, its part of the reach of contacts, as far as the bounds lack it
    btScalar m_change;        // m, of the side of the bounds that moved most since the step before because vertices of
                              // a mesh or children of a compound move; 0 where none does

    bool m_isDynamic;  // its motion is a prediction, which other bodies may change

    bool isActive() const { return m_motion.moves() || m_change > 0; }
};

// Returns whether Bullet would hand the pair on and Drape would find its contacts once the body is awake.
bool mayTouch(const PluginState& state, const btSoftBody& body, const btCollisionObject& object);

// Lists the obstacles of the body's world that move or change in this step, and the resting ones if `resting` is
// true. Observes kinematic obstacles in either case, also resting ones. Does not check children of compounds and
// moving meshes for changes. Empty if the body's world info names no broad phase.
std::vector<StepObstacle> stepObstacles(const PluginState& state, const btSoftBody& body, KinematicMotions& motions,
                                        bool resting);

// Returns whether an obstacle that moves or changes, of a pair that Drape handles, comes near the sleeping body in
// this step. Bullet wakes bodies only once the obstacle has arrived.
bool isReached(const PluginState& state, const btSoftBody& body, const std::vector<StepObstacle>& obstacles);

// Widens the bounds of awake handled bodies near an obstacle of a pair that Drape handles. They cover the nodes' paths,
// and those paths relative to moving obstacles, grown by the reach of contacts. They reach dynamic bodies that a hit by
// the fastest body or cloth of the step might bring near. They reach a deforming mesh one step
// before it may arrive: its vertices' motion is known from a pair's second step on. Bounds that are NaN, because of
// an invalid node, become those of the other nodes if there is any obstacle. Bullet would otherwise stop simulating
// the body.
void coverMotions(const PluginState& state, const std::vector<btSoftBody*>& bodies,
                  const std::vector<StepObstacle>& obstacles, ThreadTeam& threads);
}  // namespace drape
