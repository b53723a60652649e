// A vector in double precision, for what the host computes beside the kernels' float vectors. No units of its own.
#pragma once

#include <cmath>
#include <cstddef>

#include "kernels/lib/geometry/vec3.h"

namespace drape
{
struct Vec3d
{
    double x = 0, y = 0, z = 0;
};

inline Vec3d wide(Vec3 v)
{
    return {double(v.x), double(v.y), double(v.z)};
}

// Returns a point of an array with x y z per point.
inline Vec3d pointAt(const float* positions, std::size_t index)
{
    return {positions[3 * index], positions[3 * index + 1], positions[3 * index + 2]};
}

inline Vec3 narrow(Vec3d v)
{
    return vec3(float(v.x), float(v.y), float(v.z));
}

inline Vec3d operator+(Vec3d a, Vec3d b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline Vec3d operator-(Vec3d a, Vec3d b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline Vec3d operator*(double s, Vec3d v)
{
    return {s * v.x, s * v.y, s * v.z};
}

inline double dot(Vec3d a, Vec3d b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Vec3d cross(Vec3d a, Vec3d b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Returns the unit vector; zeros if there is none.
inline Vec3d unit(Vec3d v)
{
    const double length = std::sqrt(dot(v, v));
    if (!(length > 0) || !std::isfinite(length)) return {0, 0, 0};
    return {v.x / length, v.y / length, v.z / length};
}
}  // namespace drape
