// Keeps the nodes of a solved body within the bounds in which Bullet looked for its pairs, where links pulled some of
// them out of these towards a mesh. Drape knows nothing of a mesh without a pair, so that nodes would pass it unseen.
//
// Light nodes beside heavy ones are pulled that far. Elsewhere nothing is changed. Cost: linear in the nodes, and a
// query of the broad phase for a body that left its bounds.
#pragma once

#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
class PluginState;
struct BodyContacts;

// Returns whether a node is outside of the bounds where a mesh may be that has no pair with the body.
bool leavesBounds(const PluginState& state, btSoftBody& body);

// Moves such nodes back to the bounds; their velocities lose the distance divided by the step's time. contacts: of the
// body, whose nodes are moved, too; null without a pair. Call after the body's nodes are written. Returns whether any
// moved.
bool holdInBounds(const PluginState& state, btSoftBody& body, BodyContacts* contacts);
}  // namespace drape
