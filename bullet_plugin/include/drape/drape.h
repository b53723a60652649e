// Drape: cloth against triangle meshes in Bullet, computed on an OpenCL device or the host. This header includes the
// other headers that a Bullet app needs.
//
//   drape::Plugin plugin;
//   drape::CollisionConfiguration configuration(plugin);   // instead of btSoftBodyRigidBodyCollisionConfiguration
//   drape::SoftBodySolver solver(plugin);                  // the last argument of btSoftRigidDynamicsWorld
//
// C++11, no OpenCL header needed. Lengths in metres.
#pragma once

#include "drape/collision_configuration.h"
#include "drape/debug_draw.h"
#include "drape/export.h"
#include "drape/plugin.h"
#include "drape/report.h"
#include "drape/settings.h"
#include "drape/soft_body_solver.h"
#include "drape/version.h"

class btBroadphaseInterface;
class btCollisionDispatcher;
class btCollisionWorld;

namespace drape
{
// Adds the plugin to a dispatcher that exists already. Registers Drape's algorithm in both orders and discards the
// algorithms of soft body pairs in the broad phase, so that Bullet makes them anew. Build the world with a
// SoftBodySolver of this plugin; otherwise its cloths stay with Bullet, and Plugin::whyStock() says so. The plugin must
// outlive the dispatcher or leave it through uninstall(). Call between steps. Returns false and changes nothing if the
// dispatcher has another plugin's algorithm or memory runs out.
DRAPE_EXPORT bool install(Plugin& plugin, btCollisionDispatcher& dispatcher, btBroadphaseInterface& broadphase);
// Adds the plugin to the dispatcher, with the broad phase of `world`; see the other overload.
DRAPE_EXPORT bool install(Plugin& plugin, btCollisionDispatcher& dispatcher, btCollisionWorld& world);

// Gives soft body pairs back to Bullet's own algorithm and frees the plugin's algorithms, after install() or with a
// CollisionConfiguration. Call between steps. Returns false and changes nothing if the dispatcher does not have this
// plugin's algorithm or memory runs out.
DRAPE_EXPORT bool uninstall(Plugin& plugin, btCollisionDispatcher& dispatcher, btBroadphaseInterface& broadphase);
// Removes the plugin from the dispatcher, with the broad phase of `world`; see the other overload.
DRAPE_EXPORT bool uninstall(Plugin& plugin, btCollisionDispatcher& dispatcher, btCollisionWorld& world);
}  // namespace drape
