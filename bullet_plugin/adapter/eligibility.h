// Which pairs Drape handles. Every other pair goes to Bullet's own algorithm, with one of these reasons.
#pragma once

#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
class PluginState;

// Null when Drape handles the pair, else the reason in words. `shape` is the shape that meets the cloth: the object's
// own, or the child of its compound. Cost: a few comparisons, but of a body without faces a look at its leading links
// that are bending links.
const char* reasonForStock(const PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                           const btCollisionShape& shape);

// Whether Bullet's own algorithm finds a mesh at that pose, the object's own or a compound's child: it takes every mesh
// to be where its object is.
bool stockCanTake(const btCollisionObject& obstacle, const btTransform& pose);

// Whether Drape handles the soft body beside an obstacle that it handles.
bool handlesCloth(const PluginState& state, const btSoftBody& cloth);

// The same where a solver of the plugin is known to step it.
bool handlesSteppedCloth(const PluginState& state, const btSoftBody& cloth);

// Whether Drape handles an obstacle with that shape beside cloth that it handles.
bool handlesObstacle(const btCollisionObject& obstacle, const btCollisionShape& shape);

// Whether Drape handles the cloth and any leaf of the obstacle's shape, which may be a compound.
bool handlesAny(const PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                const btCollisionShape& shape);

// Whether the two answer each other's touch: not objects that ignore each other, not where either side has no contact
// response.
bool respond(const btSoftBody& cloth, const btCollisionObject& obstacle);
}  // namespace drape
