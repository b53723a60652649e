// Bounds of soft bodies that cover a step's motion, so that Bullet's broad phase makes every pair that Drape needs, and
// sleeping ones that a kinematic object comes to, which have to be awake by then.
//
// Bullet's own bounds come from the node tree of the step before and lag behind fast cloth, and those of a kinematic
// object hold its pose at the end alone. Input: bodies before and after predictMotion, before Bullet computes its
// pairs. Output: wider m_bounds. Cost: linear in the nodes (of sleeping bodies while something moves), and in the
// world's objects, which are asked whether they move.
#pragma once

#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/kinematic_motion.h"

namespace drape
{
class PluginState;

struct MovingObject
{
    const btCollisionObject* m_object;
    BodyMotion m_motion;
};

// A mesh whose box changes from one step to the next where it stands: its vertices move.
struct ChangingMesh
{
    const btCollisionObject* m_object;
    btVector3 m_low, m_high;  // m, with its margin, now
    btScalar m_change;        // m, of the side that moved most since the step before
};

// Holds the objects of a world that move in a step, and the meshes that changed since the step before.
struct MovingThings
{
    std::vector<MovingObject> m_objects;
    std::vector<ChangingMesh> m_meshes;

    bool empty() const { return m_objects.empty() && m_meshes.empty(); }
};

// The kinematic meshes and compounds of the body's world that move in this step; observes those that rest, too. None
// where the body's world info names no broad phase. Also the meshes whose boxes change, except children of compounds
// and objects that move. beyond: raised to the most that bounds of the world's meshes, except children of compounds,
// lack of their margins (marginBeyondBounds()).
MovingThings movingThings(const btSoftBody& body, KinematicMotions& motions, btScalar& beyond);

// Whether a moving object of a pair that Drape handles comes near the sleeping body in this step: Bullet wakes bodies
// for it only once it has arrived.
bool isReached(const PluginState& state, const btSoftBody& body, const MovingThings& moving);

// Widens the body's bounds to its nodes' paths, grown by the body's part of the reach of contacts and by `extra` (m,
// what obstacles' bounds lack), and to those paths as moving objects see them, where they come near the object; those
// with the object's part, too, which its own bounds hold but for the activation. Bounds
// reach a changing mesh one step before it may arrive, because its vertices' motion is known from the second step with
// a pair on. Bounds that are no numbers, because of a node that is none, become those of the other nodes: Bullet would
// stop simulating the body.
void coverMotion(btSoftBody& body, btScalar activation, btScalar extra, const MovingThings& moving);
}  // namespace drape
