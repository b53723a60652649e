// Finds whose algorithm a dispatcher gives to pairs of a soft body and a triangle mesh.
//
// Bullet does not report the functions of a dispatcher. An algorithm is therefore made for the pair, queried, and
// freed. Nothing collides.
#pragma once

#include "BulletSoftBody/btSoftBody.h"

class btDispatcher;

namespace drape
{
class PluginState;

// Returns the state of the plugin whose algorithm the dispatcher gives to the pair; null where it is no plugin's.
// `shape` is a mesh shape, the obstacle's own or a compound's child.
const PluginState* pluginOf(btDispatcher& dispatcher, const btSoftBody& cloth, const btCollisionObject& obstacle,
                            const btCollisionShape& shape);

// Returns the state of the plugin whose algorithm the dispatcher gives to any pair; null if there is none.
const PluginState* pluginOf(btDispatcher& dispatcher);

// Takes pairs with GImpact shapes back where the app has called btGImpactCollisionAlgorithm::registerAlgorithm() since:
// that gives the dispatcher an algorithm for every type of shape, which cannot handle soft bodies. Only for a
// dispatcher that gives this plugin the other meshes. shape: of an object in the cloth's world, or of a child. Returns
// whether it has a GImpact shape.
bool takeGImpactBack(PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                     const btCollisionShape& shape);

// Returns the reason, in words, why Bullet's own algorithm handles the pair. Returns null if the dispatcher of the
// objects' world has this plugin's algorithm, or if they are in no world.
const char* reasonFromDispatcher(const PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                                 const btCollisionShape& shape);
}  // namespace drape
