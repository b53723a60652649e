// Exact geometric decisions for the independent check: no tolerance, no wrong answer for finite input.
//
// Signs are first computed in double with Shewchuk's stage-A error bound (Adaptive Precision Floating-Point Arithmetic,
// 1997) and, where that does not decide, in rational arithmetic (GMP). Cost: some 50 ns a triangle pair that is decided
// in double, microseconds otherwise.
#pragma once

#include "scenes/vector3.h"

namespace drape
{
// Returns the sign of the volume of (a, b, c, d): positive if d sees a, b, c clockwise, 0 if the four lie in one plane.
int orientation(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

// Returns true if two closed triangles have a point in common. Touching counts. Triangles without area are segments or
// points.
bool trianglesIntersect(const Vector3 a[3], const Vector3 b[3]);

// Returns true if the closed segment p q and the closed triangle have a point in common.
bool segmentMeetsTriangle(const Vector3& p, const Vector3& q, const Vector3 triangle[3]);

// Returns true if the triangles (a, b, c) and (a, b, d), which share the edge a b, lie in one plane on the same side of
// that edge. False if one has no area.
bool foldedFlat(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);
}  // namespace drape
