// Places rectangular cloth along curves: rolled, folded, or through a knot. Its length at rest stays that of the cloth.
#pragma once

#include <functional>
#include <vector>

#include "scenes/cloth_grid.h"
#include "scenes/vector3.h"

namespace drape
{
// A curve's points in order, m; straight between them.
using Polyline = std::vector<Vector3>;

double lengthOf(const Polyline& curve);
// Returns a smooth curve through the points (Catmull-Rom), as `parts` chords between any two.
Polyline smoothCurve(const Polyline& points, int parts);

// A flat spiral in the plane z = 0 from its inner radius outwards, `turns` turns whose windings are `gap` apart.
Polyline spiral(double innerRadius, double gap, double turns);
// `layers` straight pieces above one another in the plane z = 0, `gap` apart and joined by half circles.
Polyline zigzag(double width, double gap, int layers);

// Returns the cloth's nodes with its columns along the curve, which is stretched or shortened evenly to the cloth's
// length, and its rows across. across: the direction of the rows, perpendicular to the curve where it begins; it turns
// with the curve, and no more than that.
std::vector<float> placeAlong(const ClothGrid& cloth, int columns, const Polyline& curve, const Vector3& across);
}  // namespace drape
