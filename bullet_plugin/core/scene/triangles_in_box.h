// Finds out whether an obstacle reaches into a box.
#pragma once

#include "mesh_pool.h"

namespace drape
{
// Returns whether the box of any of the obstacle's triangles meets the box (m, in the frame of its positions as given).
// O(n).
bool anyTriangleIn(const PooledMesh& mesh, const float low[3], const float high[3]);
}  // namespace drape
