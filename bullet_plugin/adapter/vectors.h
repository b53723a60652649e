// Conversions between Bullet's vectors and the core's.
#pragma once

#include "LinearMath/btTransform.h"
#include "bullet_plugin/core/vec3d.h"
#include "kernels/lib/geometry/vec3.h"

namespace drape
{
inline Vec3 vec3Of(const btVector3& v)
{
    return vec3(float(v.x()), float(v.y()), float(v.z()));
}

inline btVector3 vectorOf(Vec3 v)
{
    return btVector3(v.x, v.y, v.z);
}

// In double precision.
inline Vec3d wideOf(const btVector3& v)
{
    return {double(v.x()), double(v.y()), double(v.z())};
}

inline btVector3 narrowOf(Vec3d v)
{
    return btVector3(btScalar(v.x), btScalar(v.y), btScalar(v.z));
}

// Writes the position and moves `out` behind it.
inline void writePosition(const btVector3& position, float*& out)
{
    for (int axis = 0; axis < 3; ++axis)
        *out++ = static_cast<float>(position[axis]);
}

// Writes three rows of the rotation and the shift.
inline void writePose(const btTransform& pose, float* out)
{
    for (int row = 0; row < 3; ++row)
    {
        writePosition(pose.getBasis().getRow(row), out);
        *out++ = static_cast<float>(pose.getOrigin()[row]);
    }
}
}  // namespace drape
