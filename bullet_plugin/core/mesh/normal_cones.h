// Normal cones of an obstacle's vertices and edges: where a surface near them can be approached from.
//
// A point outside a surface has its closest point on a vertex or edge only if its direction from there lies between the
// normals of the adjacent triangles. The cones hold those normals, widened by a third for cloth that turns after
// contacts were found and by two degrees for rounding. Where the surroundings bound nothing (an open boundary, more
// than two triangles at an edge, zero areas) the cone admits every direction. Two-sided: the opposite directions are in
// the cone too (see coneAdmits). How triangles are wound makes no difference but for the axis, which leans to the side
// that the first triangle there faces (winding.h). O(n).
#pragma once

#include <vector>

#include "topology.h"

namespace drape
{
// positions: m, x y z per vertex. Outputs one cone per vertex and per edge.
void computeNormalCones(const Topology& topology, const float* positions, std::vector<NormalCone>& vertexCones,
                        std::vector<NormalCone>& edgeCones);
}  // namespace drape
