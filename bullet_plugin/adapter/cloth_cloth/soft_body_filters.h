// Bullet's filters between two soft bodies.
#pragma once

#include <cstdint>

#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
// Returns whether Bullet's filters let two soft bodies of a world meet: collision groups and masks or the world's own
// filter, contact response, and the lists of objects that a body ignores. The order of the two does not matter.
bool filtersLetMeet(const btSoftBody& first, const btSoftBody& second);

// Returns whether the body's world has a filter of its own, whose answers may change.
bool hasOwnFilter(const btSoftBody& body);

// Returns a number that changes with what filtersLetMeet() reads of a body, but for such a filter.
std::uint64_t filterHash(const btSoftBody& body);
}  // namespace drape
