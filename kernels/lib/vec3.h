// Vectors of three floats, with only + - × ÷ and sqrt, so that host and devices round alike (with FP contraction off).
#ifndef DRAPE_LIB_VEC3_H
#define DRAPE_LIB_VEC3_H

#include "../shared/types.h"

DRAPE_NAMESPACE_BEGIN

#ifdef __OPENCL_VERSION__
#define drapeSqrt(a) sqrt(a)
#define drapeBits(a) as_uint(a)
#define drapeFromBits(a) as_float(a)
#else
DRAPE_FUNCTION float drapeSqrt(float a)
{
    return __builtin_sqrtf(a);
}
DRAPE_FUNCTION std::uint32_t drapeBits(float a)
{
    std::uint32_t bits;
    std::memcpy(&bits, &a, sizeof bits);
    return bits;
}
DRAPE_FUNCTION float drapeFromBits(std::uint32_t bits)
{
    float a;
    std::memcpy(&a, &bits, sizeof a);
    return a;
}
#endif

DRAPE_FUNCTION float drapeMin(float a, float b)
{
    return b < a ? b : a;
}
DRAPE_FUNCTION float drapeMax(float a, float b)
{
    return a < b ? b : a;
}
DRAPE_FUNCTION float drapeAbs(float a)
{
    return a < 0.0f ? -a : a;
}
DRAPE_FUNCTION float drapeClamp01(float a)
{
    return drapeMin(drapeMax(a, 0.0f), 1.0f);
}

// Tests the exponent's bits: compilers may not fold this away, and a flushed denormal stays finite.
DRAPE_FUNCTION int drapeIsFinite(float a)
{
    return (drapeBits(a) & 0x7f800000u) != 0x7f800000u;
}

DRAPE_FUNCTION Vec3 vec3(float x, float y, float z)
{
    Vec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}
DRAPE_FUNCTION Vec3 vec3Load(const DRAPE_GLOBAL float* positions, DRAPE_UINT vertex)
{
    const DRAPE_GLOBAL float* p = positions + 3u * vertex;
    return vec3(p[0], p[1], p[2]);
}
DRAPE_FUNCTION Vec3 vec3Add(Vec3 a, Vec3 b)
{
    return vec3(a.x + b.x, a.y + b.y, a.z + b.z);
}
DRAPE_FUNCTION Vec3 vec3Sub(Vec3 a, Vec3 b)
{
    return vec3(a.x - b.x, a.y - b.y, a.z - b.z);
}
DRAPE_FUNCTION Vec3 vec3Scale(Vec3 a, float s)
{
    return vec3(a.x * s, a.y * s, a.z * s);
}
// a + s·b
DRAPE_FUNCTION Vec3 vec3AddScaled(Vec3 a, Vec3 b, float s)
{
    return vec3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
DRAPE_FUNCTION Vec3 vec3Mix(Vec3 a, Vec3 b, float t)
{
    return vec3AddScaled(a, vec3Sub(b, a), t);
}
DRAPE_FUNCTION float vec3Dot(Vec3 a, Vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
DRAPE_FUNCTION Vec3 vec3Cross(Vec3 a, Vec3 b)
{
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
DRAPE_FUNCTION float vec3Length(Vec3 a)
{
    return drapeSqrt(vec3Dot(a, a));
}
// Scales a to length 1. length: of a, > 0. It is computed anew if its square is so small that it loses digits as a
// denormal.
DRAPE_FUNCTION Vec3 vec3Direction(Vec3 a, float length)
{
    if (length > 1e-18f) return vec3Scale(a, 1.0f / length);
    const Vec3 large = vec3Scale(a, 18446744073709551616.0f);  // 2^64
    return vec3Scale(large, 1.0f / vec3Length(large));
}
DRAPE_FUNCTION float vec3Norm1(Vec3 a)
{
    return drapeAbs(a.x) + drapeAbs(a.y) + drapeAbs(a.z);
}
DRAPE_FUNCTION float vec3NormMax(Vec3 a)
{
    return drapeMax(drapeMax(drapeAbs(a.x), drapeAbs(a.y)), drapeAbs(a.z));
}
DRAPE_FUNCTION int vec3IsFinite(Vec3 a)
{
    return drapeIsFinite(a.x) && drapeIsFinite(a.y) && drapeIsFinite(a.z);
}

// Positions beyond this, m, count as bad input like NaN. Up to it, the square of a triangle's area vector is finite.
#define DRAPE_FARTHEST 1073741824.0f  // 2^30

// Returns whether geometry can use the position: finite and not farther out than DRAPE_FARTHEST.
DRAPE_FUNCTION int positionIsValid(Vec3 p)
{
    return vec3IsFinite(p) && vec3NormMax(p) <= DRAPE_FARTHEST;
}

DRAPE_NAMESPACE_END

#endif
