// A double-precision vector for the measuring code and the picture. Componentwise, no units of its own.
#pragma once

#include <cmath>

namespace drape
{
struct Vector3
{
    double x = 0, y = 0, z = 0;

    double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

inline Vector3 operator+(const Vector3& a, const Vector3& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector3 operator-(const Vector3& a, const Vector3& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector3 operator*(double s, const Vector3& a)
{
    return {s * a.x, s * a.y, s * a.z};
}
inline Vector3& operator+=(Vector3& a, const Vector3& b)
{
    return a = a + b;
}
inline double dot(const Vector3& a, const Vector3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vector3 cross(const Vector3& a, const Vector3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vector3& a)
{
    return std::sqrt(dot(a, a));
}
inline Vector3 normalized(const Vector3& a)
{
    const double l = length(a);
    return l > 0 ? (1 / l) * a : Vector3{};
}
}  // namespace drape
