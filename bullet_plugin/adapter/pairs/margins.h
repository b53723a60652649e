// Computes the thickness of a pair from Bullet's margins, and describes problems with them.
#pragma once

#include <algorithm>
#include <string>

#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
// Minimum thickness, m: both margins may be zero, but the pipeline needs a positive thickness.
constexpr btScalar kMinThickness = btScalar(1e-4);

// Returns the margin, m; a negative one, or one that is no number, counts as 0: Bullet accepts any.
inline btScalar marginOf(const btCollisionShape& shape)
{
    return shape.getMargin() > 0 ? shape.getMargin() : btScalar(0);
}

// Returns the distance at which cloth comes to rest, m.
btScalar thicknessOf(const btSoftBody& cloth, const btCollisionShape& obstacle);

// Describes in one line a problem with the margins of a soft body and a mesh's shape; empty if there is none. Problems
// are a negative margin, and a thickness as large as the mesh or the cloth, or out of proportion to the edges of the
// cloth or of the mesh. O(n) in the nodes and faces; samples a mesh.
std::string marginRemark(const btSoftBody& cloth, const btCollisionShape& obstacle);

// Describes in one line a thickness (m) of cloth with cloth that is out of proportion to the body's edges; empty if it
// is not.
std::string selfThicknessRemark(const btSoftBody& cloth, btScalar thickness);
}  // namespace drape
