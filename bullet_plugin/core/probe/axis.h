// A vector's coordinate by its axis: 0, 1 or 2.
#pragma once

#include "kernels/lib/geometry/vec3.h"

namespace drape
{
inline float& at(Vec3& v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

inline float at(const Vec3& v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
}  // namespace drape
