// The shape of an obstacle, for engines that have shapes besides triangle meshes.
//
// Lengths in metres, around the shape's origin, y up.
#pragma once

#include <vector>

#include "scenes/mesh.h"
#include "scenes/vector3.h"

namespace drape
{
struct ObstacleShape
{
    enum class Kind
    {
        Mesh,
        Box,
        Sphere,
        Capsule,     // along y
        Cylinder,    // along y
        Plane,       // without end; the side of its normal is free
        HeightField  // y over x and z; static
    };
    Kind m_kind = Kind::Mesh;
    Vector3 m_size;                // edges of a box
    double m_radius = 0;           // sphere, capsule or cylinder
    double m_length = 0;           // cylinder; capsule: between the centres of its ends
    Vector3 m_normal = {0, 1, 0};  // unit; the plane is where its product with a point is m_offset
    double m_offset = 0;
    int m_columns = 0, m_rows = 0;   // points of a height field along x and z
    double m_cell = 0;               // distance of neighbours
    std::vector<float> m_heights{};  // row after row
};

// Returns triangles for a shape that is no mesh, counter-clockwise seen from outside. Those of a box and of a height
// field are exact. Round shapes lie 1 to 2 % of the radius inside of the true surface. A plane is cut off kPlaneReach
// from its origin.
constexpr double kPlaneReach = 100;
TriangleMesh triangulated(const ObstacleShape& shape);
}  // namespace drape
