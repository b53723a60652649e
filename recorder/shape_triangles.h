// Turns Bullet's collision shapes into triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "BulletCollision/CollisionShapes/btCollisionShape.h"

namespace drape
{
struct ShapeTriangles
{
    std::vector<float> m_vertices;          // x y z each, m, in the frame of the object; equal positions joined
    std::vector<std::int32_t> m_triangles;  // three vertices each

    // Returns true if each edge has one triangle on either side, so that there is an inside.
    bool closed() const;
};

// Returns the triangles of a mesh, a convex shape, or the children of a compound. Convex shapes that are round get some
// hundred triangles; planes and height fields are cut off at kLargest. Empty for shapes of other kinds.
ShapeTriangles trianglesOf(const btCollisionShape& shape);
}  // namespace drape
