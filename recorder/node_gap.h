// Finds the distance from a point to the nearest triangle of an object, through Bullet's own trees.
#pragma once

#include <limits>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"

namespace drape
{
// An object whose triangles Bullet can list: a mesh, a plane or a height field, alone or in a compound.
struct GapObstacle
{
    const btCollisionObject* m_object;
    bool m_closed;  // the shape has an inside
};

// Returns the distance, m, or infinity if it is above `reach`. Negative inside a closed shape. `point` is in the
// world's frame. The sign is that of the nearest triangle; of several at the same distance the one that the point faces
// most directly.
double distanceTo(const GapObstacle& obstacle, const btVector3& point, double reach);

// Returns true if the shape has triangles that distanceTo() can find.
bool hasGaps(const btCollisionShape& shape);
}  // namespace drape
