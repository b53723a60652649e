// Closed solids of revolution about y.
#pragma once

#include <utility>
#include <vector>

#include "scenes/mesh.h"

namespace drape
{
// A profile's points: distance from the axis, which is 0 at its ends and nowhere else, and height, from bottom to top.
using LatheProfile = std::vector<std::pair<double, double>>;

// Turns a profile that begins and ends on the axis. around: corners of a ring, 3 at least.
TriangleMesh makeLathe(const LatheProfile& profile, int around);
// Turns a closed profile that stays off the axis, counter-clockwise with distance to the right and height upwards.
TriangleMesh makeRing(const LatheProfile& profile, int around);

// A cylinder along y around the origin, with rounded ends of the given radius less than its own.
TriangleMesh makeCylinder(double radius, double length, double rounding, int around);
// A capsule along y around the origin. length: between the centres of its ends.
TriangleMesh makeCapsule(double radius, double length, int around);
}  // namespace drape
