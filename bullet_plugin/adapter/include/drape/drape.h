// Drape: cloth against triangle meshes in Bullet, computed on an OpenCL device or the host. This header includes the
// rest.
//
//   drape::Plugin plugin;
//   drape::CollisionConfiguration configuration(plugin);   // instead of btSoftBodyRigidBodyCollisionConfiguration
//   drape::SoftBodySolver solver(plugin);                  // the last argument of btSoftRigidDynamicsWorld
//
// C++11, no OpenCL header needed. Lengths in metres.
#pragma once

#include "drape/collision_configuration.h"
#include "drape/plugin.h"
#include "drape/report.h"
#include "drape/settings.h"
#include "drape/soft_body_solver.h"

class btBroadphaseInterface;
class btCollisionDispatcher;
class btCollisionWorld;

namespace drape
{
// For a dispatcher that exists already: registers Drape's algorithm in both orders and throws away the algorithms of
// pairs with soft bodies that the broad phase holds, so that they are made anew. The world must have been built with a
// SoftBodySolver of this plugin, else its cloths stay with Bullet (Plugin::whyStock says so). The plugin must outlive
// the dispatcher. Call between steps.
void install(Plugin& plugin, btCollisionDispatcher& dispatcher, btBroadphaseInterface& broadphase);
void install(Plugin& plugin, btCollisionDispatcher& dispatcher, btCollisionWorld& world);
}  // namespace drape
