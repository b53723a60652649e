// Ropes: nodes in a row with a spring between neighbours, and no triangles.
//
// Cost: linear in the nodes. Lengths in metres.
#pragma once

#include <vector>

#include "scenes/cloth_grid.h"
#include "scenes/vector3.h"

namespace drape
{
// Returns x y z of `count` (≥ 2) nodes at equal distances from one end to the other.
std::vector<float> nodesBetween(const Vector3& from, const Vector3& to, int count);

// Makes a rope through the nodes (x y z each, at least two). bends: adds a spring between each two nodes with one node
// between them, which resists bending.
ClothGrid makeRope(std::vector<float> nodes, bool bends);

// Returns masses of the nodes (kg) that add up to `mass`: each has half of the lengths beside it. The rope must have a
// length.
std::vector<double> massesByLength(const std::vector<float>& nodes, double mass);

// Returns triangles of tubes around lines, for pictures. lines: two nodes each, of `positions`. A line without a length
// or with a node that is not finite gets none.
TriangleMesh tubesAround(const std::vector<float>& positions, const std::vector<std::int32_t>& lines, double radius);
}  // namespace drape
