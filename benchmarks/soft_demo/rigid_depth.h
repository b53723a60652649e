// Depth of a point below the surface of one of Bullet's rigid shapes, computed from the shape's definition.
#pragma once

#include <btBulletDynamicsCommon.h>

namespace drape::bench
{
// Returns the depth in m, 0 for a point outside. Knows boxes, balls, cylinders, capsules along x and their compounds;
// others have no inside.
double depthIn(const btCollisionShape& shape, const btTransform& pose, const btVector3& point);
}  // namespace drape::bench
