// Lists the triangles of the obstacles' patches that are near the cloths of the last step, for drawing.
//
// A patch is near if its box meets the box of a triangle of the cloth, grown by the reach of contacts. Positions are
// those at the step's end. Cost: a pass over the obstacles' triangles, and patches times triangles within the cloth's
// box. Errors: exceptions pass through.
#pragma once

#include <array>
#include <vector>

#include "LinearMath/btVector3.h"

namespace drape
{
class PluginState;

using DrawnTriangle = std::array<btVector3, 3>;  // m, world frame

std::vector<DrawnTriangle> nearTriangles(const PluginState& state);
}  // namespace drape
