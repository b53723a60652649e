// Measures the area of meshes.
#pragma once

#include <vector>

#include "kernels/shared/mesh.h"

namespace drape
{
// Returns the area, m², of the triangles with finite vertices. A triangle that stands for an edge counts as half of the
// square over it, like a grid's triangle with that side. positions: m, x y z per vertex. O(n).
double surfaceArea(const std::vector<Triangle>& triangles, const float* positions);
}  // namespace drape
