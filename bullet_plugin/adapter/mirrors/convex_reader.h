// Makes triangle meshes of Bullet's convex shapes: the hull of a polyhedral shape's vertices, or of points on a round
// one's surface.
//
// Input: a shape that isConvexShape() accepts. Output: a closed mesh in the shape's own frame, m, with outward
// triangles. Round shapes have 32 sides, so that the mesh lies up to 1 % of the radius inside of the surface.
#pragma once

#include <cstdint>
#include <vector>

#include "BulletCollision/CollisionShapes/btConvexShape.h"

namespace drape
{
// All of Bullet's convex shapes but those in two dimensions.
bool isConvexType(int shapeType);
bool isConvexShape(const btCollisionShape& shape);

// Returns how far the surface with which Bullet collides lies outside of the mesh, m: the margin of a hull, a
// mesh or a cone. That of other shapes is within their dimensions.
btScalar convexMargin(const btCollisionShape& shape);

void readConvex(const btConvexShape& shape, std::vector<btVector3>& vertices, std::vector<std::int32_t>& triangles);

// Lists points that change with the shape's surface.
void listSurface(const btConvexShape& shape, std::vector<btVector3>& points);
}  // namespace drape
