// Normal cones of an obstacle's vertices and edges: the directions from which the surface there can be approached.
//
// A point outside a surface has its closest point on a vertex or edge only if its direction from there lies between the
// normals of the adjacent triangles. The cones contain those normals, widened by a third for cloth that turns after
// contacts were found, and by two degrees for rounding. Surroundings that bound nothing (an open boundary, more than
// two triangles at an edge, zero areas) give a cone that admits every direction. Cones are two-sided: they admit the
// opposite directions too (see coneAdmits). The winding affects only the axis, which leans to the side that the first
// triangle there faces (winding.h). O(n).
#pragma once

#include <vector>

#include "topology.h"

namespace drape
{
// positions: m, x y z per vertex. Outputs one cone per vertex and per edge.
void computeNormalCones(const Topology& topology, const float* positions, std::vector<NormalCone>& vertexCones,
                        std::vector<NormalCone>& edgeCones);
}  // namespace drape
