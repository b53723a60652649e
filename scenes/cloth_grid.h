// A rectangular cloth as plain arrays: nodes on a horizontal grid, triangles, and the springs between its nodes.
//
// Job: one generator for every size, so that small and large cloths are made alike (Bullet's own bending generator
// needs n² ints and overflows above 46,341 nodes). Memory and time are linear in the nodes. Lengths in metres.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/mesh.h"

namespace drape
{
struct ClothGrid
{
    TriangleMesh m_mesh;                         // node (column i, row j) is vertex j * columns + i
    std::vector<std::int32_t> m_edgeSprings;     // 2 nodes each: every edge of a triangle, once
    std::vector<std::int32_t> m_bendingSprings;  // 2 nodes each: two grid cells apart along rows, columns and diagonals
};

// Makes a cloth of columns × rows nodes (each ≥ 2), square cells, longer side `size` m, centred at x = z = 0, height y.
// Diagonals alternate from cell to cell, so the cloth has no preferred direction. Normals point up.
ClothGrid makeClothGrid(int columns, int rows, float size, float y);

// Makes a tube of `around` (≥ 5) × rows (≥ 3) nodes around y, half of its height below y = 0. Normals point outwards.
// Springs join the same neighbours as in the flat cloth, all around.
ClothGrid makeClothTube(int around, int rows, float radius, float height);
}  // namespace drape
