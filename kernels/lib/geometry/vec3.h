// Vectors of three floats, with only + - × ÷ and sqrt, so that host and devices round alike (with FP contraction off).
#ifndef DRAPE_LIB_VEC3_H
#define DRAPE_LIB_VEC3_H

#include "../../shared/types.h"

DRAPE_NAMESPACE_BEGIN

#define DRAPE_INFINITY (1.0f / 0.0f)

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

DRAPE_FUNCTION float drapeAbs(float a)
{
    return a < 0.0f ? -a : a;
}

#include "../any_width/one.h"
#include "../any_width/vec3.h"
#include "../any_width/end.h"

// Tests the exponent's bits: compilers may not fold this away, and a flushed denormal stays finite.
DRAPE_FUNCTION int drapeIsFinite(float a)
{
    return (drapeBits(a) & 0x7f800000u) != 0x7f800000u;
}

DRAPE_FUNCTION Vec3 vec3Load(const DRAPE_GLOBAL float* positions, DRAPE_UINT vertex)
{
    const DRAPE_GLOBAL float* p = positions + 3u * vertex;
    return vec3(p[0], p[1], p[2]);
}
// Scales a to length 1. length: of a, > 0. It is computed anew if its square is so small that it loses digits as a
// denormal.
DRAPE_FUNCTION Vec3 vec3Direction(Vec3 a, float length)
{
    if (length > 1e-18f) return vec3Scale(a, 1.0f / length);
    const Vec3 large = vec3Scale(a, 18446744073709551616.0f);  // 2^64
    return vec3Scale(large, 1.0f / vec3Length(large));
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
