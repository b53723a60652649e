// Predicts the motion of a soft body as btSoftBody::predictMotion() of Bullet 3.24 does, in one pass over its nodes.
//
// Replaces Bullet's function for plain bodies: those that nothing but their nodes' forces and gravity moves. Positions,
// velocities and bounds are Bullet's to the bit. The node tree waits for updateNodeTree() (node_tree.h). Cost: linear
// in the nodes.
//
// Threads: predictPlain() writes the body alone and calls no function of the app. Bullet's own function also writes the
// broad phase, which bodies share: updateBroadphase() does that, on one thread. The world's info is only read.
#pragma once

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/core/threads/thread_team.h"

namespace drape
{
// Returns why Bullet predicts the body in every step: wind, pressure, volume, a pose, clusters or a face tree would
// have to be updated, or the body collides with soft bodies. Null if there is no reason: the body is plain.
const char* reasonForBulletsPrediction(const btSoftBody& body);
bool isPlain(const btSoftBody& body);
// Returns whether predictPlain() replaces Bullet's function in the coming step of dt seconds: time passes, too, and no
// link has changed.
bool isPlain(const btSoftBody& body, btScalar dt);

// Predicts a plain body over dt seconds. Allocates no memory. threads: null for the caller alone.
void predictPlain(btSoftBody& body, btScalar dt, ThreadTeam* threads);

// Sets the times and margins of a plain body's step of dt seconds, as predictPlain() does first.
void beginPlain(btSoftBody& body, btScalar dt);

// Sets the body's bounds around a box of its predicted nodes, m.
void setBounds(btSoftBody& body, const btVector3& low, const btVector3& high);

// Gives the broad phase the bounds of a body that predictPlain() predicted.
void updateBroadphase(btSoftBody& body);
}  // namespace drape
