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
// the dispatcher, or be taken out of it by uninstall(). Call between steps. A dispatcher has one plugin: returns false,
// with nothing changed, where it has another one's algorithm, or where memory runs out.
bool install(Plugin& plugin, btCollisionDispatcher& dispatcher, btBroadphaseInterface& broadphase);
bool install(Plugin& plugin, btCollisionDispatcher& dispatcher, btCollisionWorld& world);

// Gives such pairs back to Bullet's own algorithm, whether the plugin came by install() or by a CollisionConfiguration,
// and frees the plugin's algorithms. Call between steps. Returns false, with nothing changed, where the dispatcher does
// not have this plugin's algorithm, or where memory runs out.
bool uninstall(Plugin& plugin, btCollisionDispatcher& dispatcher, btBroadphaseInterface& broadphase);
bool uninstall(Plugin& plugin, btCollisionDispatcher& dispatcher, btCollisionWorld& world);
}  // namespace drape
