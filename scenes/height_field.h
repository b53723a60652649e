// The highest surface of a mesh over each point of the floor: what a cloth falling straight down meets first.
//
// Input: a mesh, copied as needed. Output: y over (x, z), m, in double. Guarantee: the greatest height of all triangles
// whose projection holds the point, borders included. Cost: linear to build, about ten triangles a query on even
// meshes.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/mesh.h"

namespace drape
{
class HeightField
{
public:
    explicit HeightField(const TriangleMesh& mesh);

    // Returns false if no triangle lies over or under the point.
    bool highest(double x, double z, double& height) const;

    const Bounds& bounds() const { return m_bounds; }

private:
    std::size_t cellOf(double value, int axis) const;

    TriangleMesh m_mesh;
    Bounds m_bounds;
    std::size_t m_cells = 1;                 // a side
    std::vector<std::uint32_t> m_first;      // per cell, and one more
    std::vector<std::uint32_t> m_triangles;  // whose bounds meet the cell
};
}  // namespace drape
