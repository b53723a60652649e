// Exact signs of areas and volumes of points with float coordinates.
//
// Signs come from doubles where an error bound (Shewchuk 1997, stage A) allows it, else from expansions: never wrong
// for finite floats. Cost: some nanoseconds; microseconds for points (nearly) in one plane.
#pragma once

#include <array>

namespace drape
{
// Coordinates are floats, widened.
using ExactPoint = std::array<double, 3>;

// Returns the sign of the volume of (a, b, c, d): 0 if the four lie in one plane, negated if two points are swapped.
int orientation3(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d);

// Returns the sign of the area of (a, b, c) in the view along an axis: 0 if they are in line there.
int orientation2(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, int along);
}  // namespace drape
