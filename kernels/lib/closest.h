// Closest points of a point and a triangle and of two segments, safe for zero-length edges and zero areas.
// Method: C. Ericson, Real-Time Collision Detection, 2005, sections 5.1.5 and 5.1.9.
#ifndef DRAPE_LIB_CLOSEST_H
#define DRAPE_LIB_CLOSEST_H

#include "vec3.h"

DRAPE_NAMESPACE_BEGIN

// 0 where the denominator vanishes: the numerator does too, and any point of the degenerate feature is as near.
DRAPE_FUNCTION float drapeRatio(float numerator, float denominator)
{
    return denominator > 0.0f ? numerator / denominator : 0.0f;
}

// Barycentric weights of the point of triangle abc that is closest to p. Each in [0, 1]; an unused corner weighs 0, so
// the number of non-zero weights distinguishes face, edge and vertex.
DRAPE_FUNCTION Vec3 closestOnTriangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c)
{
    const Vec3 ab = vec3Sub(b, a), ac = vec3Sub(c, a), ap = vec3Sub(p, a);
    const float d1 = vec3Dot(ab, ap), d2 = vec3Dot(ac, ap);
    if (d1 <= 0.0f && d2 <= 0.0f) return vec3(1.0f, 0.0f, 0.0f);
    const Vec3 bp = vec3Sub(p, b);
    const float d3 = vec3Dot(ab, bp), d4 = vec3Dot(ac, bp);
    if (d3 >= 0.0f && d4 <= d3) return vec3(0.0f, 1.0f, 0.0f);
    const Vec3 cp = vec3Sub(p, c);
    const float d5 = vec3Dot(ab, cp), d6 = vec3Dot(ac, cp);
    if (d6 >= 0.0f && d5 <= d6) return vec3(0.0f, 0.0f, 1.0f);
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f)
    {
        const float v = drapeRatio(d1, d1 - d3);
        return vec3(1.0f - v, v, 0.0f);
    }
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f)
    {
        const float w = drapeRatio(d2, d2 - d6);
        return vec3(1.0f - w, 0.0f, w);
    }
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f)
    {
        const float w = drapeRatio(d4 - d3, (d4 - d3) + (d5 - d6));
        return vec3(0.0f, 1.0f - w, w);
    }
    const float v = drapeRatio(vb, va + vb + vc), w = drapeRatio(vc, va + vb + vc);
    return vec3(drapeMax(1.0f - v - w, 0.0f), v, w);
}

// Parameters (s along ab, t along cd, both in [0, 1]) of a closest pair of points of two segments.
DRAPE_FUNCTION void closestOnSegments(Vec3 a, Vec3 b, Vec3 c, Vec3 d, float* s, float* t)
{
    const Vec3 u = vec3Sub(b, a), v = vec3Sub(d, c), w = vec3Sub(a, c);
    const float uu = vec3Dot(u, u), vv = vec3Dot(v, v), uv = vec3Dot(u, v), uw = vec3Dot(u, w), vw = vec3Dot(v, w);
    const float determinant = uu * vv - uv * uv;
    // If the second segment is a point, the first must still be projected on it; for parallel segments any start is
    // valid.
    float first = drapeClamp01(vv > 0.0f ? drapeRatio(uv * vw - uw * vv, determinant) : drapeRatio(-uw, uu));
    float second = drapeRatio(uv * first + vw, vv);
    if (second < 0.0f || second > 1.0f)
    {
        second = drapeClamp01(second);
        first = drapeClamp01(drapeRatio(uv * second - uw, uu));
    }
    *s = first;
    *t = second;
}

DRAPE_FUNCTION Vec3 trianglePoint(Vec3 a, Vec3 b, Vec3 c, Vec3 weights)
{
    return vec3(weights.x * a.x + weights.y * b.x + weights.z * c.x,
                weights.x * a.y + weights.y * b.y + weights.z * c.y,
                weights.x * a.z + weights.y * b.z + weights.z * c.z);
}

DRAPE_NAMESPACE_END

#endif
