#include "scenes/obstacle_shape.h"

#include <cmath>
#include <utility>

#include "scenes/lathe.h"
#include "scenes/mesh_builder.h"
#include "scenes/shapes.h"

namespace drape
{
namespace
{
constexpr int kAround = 32;  // corners of a round shape
// Drape takes the hull of 32 sides for a round shape. The check's surface must not lie outside of it.
constexpr double kRoundShare = 0.99;
constexpr int kSphereLevels = 3;

TriangleMesh makePlane(const ObstacleShape& shape)
{
    const Vector3& normal = shape.m_normal;
    const Vector3 other = std::abs(normal.x) < 0.9 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
    const Vector3 u = normalized(cross(other, normal)), v = cross(normal, u);
    TriangleMesh mesh;
    for (const auto& [a, b] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}})
    {
        const Vector3 corner = shape.m_offset * normal + a * kPlaneReach * u + b * kPlaneReach * v;
        addVertex(mesh, corner.x, corner.y, corner.z);
    }
    addQuad(mesh, 0, 1, 2, 3);
    return mesh;
}

// Divides cells as Bullet does without its flags.
TriangleMesh makeHeightField(const ObstacleShape& shape)
{
    TriangleMesh mesh;
    for (int j = 0; j < shape.m_rows; ++j)
        for (int i = 0; i < shape.m_columns; ++i)
            addVertex(mesh, (i - 0.5 * (shape.m_columns - 1)) * shape.m_cell,
                      double(shape.m_heights[std::size_t(j) * std::size_t(shape.m_columns) + std::size_t(i)]),
                      (j - 0.5 * (shape.m_rows - 1)) * shape.m_cell);
    for (int j = 0; j + 1 < shape.m_rows; ++j)
        for (int i = 0; i + 1 < shape.m_columns; ++i)
        {
            const int near = j * shape.m_columns + i, far = near + shape.m_columns;
            addTriangle(mesh, near, far, near + 1);
            addTriangle(mesh, near + 1, far, far + 1);
        }
    return mesh;
}

// Turns a profile with sharp rims: flat ends and a straight side.
TriangleMesh makeSharpCylinder(double radius, double length)
{
    const double top = 0.5 * length;
    return makeLathe({{0, -top}, {radius, -top}, {radius, top}, {0, top}}, kAround);
}
}  // namespace

TriangleMesh triangulated(const ObstacleShape& shape)
{
    using Kind = ObstacleShape::Kind;
    const double radius = kRoundShare * shape.m_radius;
    switch (shape.m_kind)
    {
        case Kind::Box:
            return makeBox(float(shape.m_size.x), float(shape.m_size.y), float(shape.m_size.z));
        case Kind::Sphere:
            return makeSphere(float(radius), kSphereLevels);
        case Kind::Capsule:
            return makeCapsule(radius, shape.m_length, kAround);
        case Kind::Cylinder:
            return makeSharpCylinder(radius, shape.m_length);
        case Kind::Plane:
            return makePlane(shape);
        case Kind::HeightField:
            return makeHeightField(shape);
        case Kind::Mesh:
            break;
    }
    return {};
}
}  // namespace drape
