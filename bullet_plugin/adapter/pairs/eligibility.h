// Decides which pairs Drape handles. Bullet's own algorithm handles every other pair, for one of these reasons.
#pragma once

#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
class PluginState;

// Returns null if Drape handles the pair, else the reason in words. `shape` is the shape that meets the cloth: the
// object's own, or the child of its compound. Cost: a few comparisons; for a body without faces also a check of its
// leading links, which are bending links.
const char* reasonForStock(const PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                           const btCollisionShape& shape);

// Returns whether the object may move between steps. A body without mass is static, and stays so in most apps that make
// it kinematic.
inline bool mayMove(const btCollisionObject& object)
{
    return object.isKinematicObject() || !object.isStaticObject();
}

// Returns whether the object is a link, or the base, of a multibody.
bool isLink(const btCollisionObject& object);

// Returns whether Bullet's own algorithm finds a shape at that pose: the object's own, or a compound child's. Bullet
// assumes that every concave shape is where its object is.
bool stockCanTake(const btCollisionObject& obstacle, const btCollisionShape& shape, const btTransform& pose);

// Returns whether Drape handles the soft body beside an obstacle that it handles.
bool handlesCloth(const PluginState& state, const btSoftBody& cloth);

// Returns whether handlesCloth() is true and a solver of the plugin is known to step the body.
bool handlesSteppedCloth(const PluginState& state, const btSoftBody& cloth);

// Returns whether Drape handles an obstacle with that shape beside cloth that it handles.
bool handlesObstacle(const PluginState& state, const btCollisionObject& obstacle, const btCollisionShape& shape);

// Returns whether Drape handles the cloth and any leaf of the obstacle's shape, which may be a compound.
bool handlesAny(const PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                const btCollisionShape& shape);

// Returns whether the cloth responds to contact with the obstacle: it does not ignore it, and the obstacle has contact
// response. Bullet does not read that flag of a soft body.
bool respond(const btSoftBody& cloth, const btCollisionObject& obstacle);

// Returns why Bullet solves the body's links, null if Drape does. Contacts that Bullet finds in a step come on top.
const char* reasonForBulletsLinks(const PluginState& state, const btSoftBody& body);
// Returns the same without a look at the links.
const char* reasonFromSettings(const PluginState& state, const btSoftBody& body);
}  // namespace drape
