// Looks for objects whose contacts with a soft body Bullet's own algorithms would find. These read the body's nodes.
#pragma once

class btCollisionObject;
class btSoftBody;

namespace drape
{
class PluginState;

// Returns whether a contact of the body with the object would be Bullet's own.
bool isStockPair(const PluginState& state, const btSoftBody& body, const btCollisionObject& object);
// Returns whether any object within the body's bounds has such a contact. Asks the broad phase.
bool anyStockPair(const PluginState& state, const btSoftBody& body);
}  // namespace drape
