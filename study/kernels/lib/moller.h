// Do two triangles intersect, by Möller's interval method with an absolute tolerance, as the thesis tested
// them. Kept for comparison: far from the origin and for small triangles it both misses pairs and reports ones that do
// not meet; trianglePairTest does neither.
// Method: T. Möller, A fast triangle-triangle intersection test, 1997.
#ifndef DRAPE_LIB_MOLLER_H
#define DRAPE_LIB_MOLLER_H

#include "../../../kernels/lib/narrow_phase/feature_contact.h"

DRAPE_NAMESPACE_BEGIN

// Distances (times the normal's length) up to this count as zero.
#define DRAPE_MOLLER_TOLERANCE 1e-6f

DRAPE_FUNCTION float vec3At(Vec3 a, int axis)
{
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

// Distances of f's corners to the plane n·x = offset, small ones made zero. Returns whether all are on one side.
DRAPE_FUNCTION int mollerSides(FeatureTriangle f, Vec3 n, float offset, float distances[3])
{
    for (int i = 0; i < 3; ++i)
    {
        distances[i] = vec3Dot(n, f.m_p[i]) - offset;
        if (drapeAbs(distances[i]) < DRAPE_MOLLER_TOLERANCE) distances[i] = 0.0f;
    }
    return distances[0] * distances[1] > 0.0f && distances[0] * distances[2] > 0.0f;
}

// Computes where f crosses the other's plane, along one axis of the line in which the planes meet. Not all distances
// may be zero.
DRAPE_FUNCTION void mollerInterval(FeatureTriangle f, const float distances[3], int axis, float* low, float* high)
{
    // The corner that is alone on its side, or off the plane alone.
    int alone = 0;
    if (distances[0] * distances[1] > 0.0f)
        alone = 2;
    else if (distances[0] * distances[2] > 0.0f)
        alone = 1;
    else if (distances[1] * distances[2] > 0.0f || distances[0] != 0.0f)
        alone = 0;
    else
        alone = distances[1] != 0.0f ? 1 : 2;
    const int i = alone == 2 ? 0 : alone + 1, j = alone == 0 ? 2 : alone - 1;
    const float p = vec3At(f.m_p[alone], axis), d = distances[alone];
    const float first = p + (vec3At(f.m_p[i], axis) - p) * (d / (d - distances[i]));
    const float second = p + (vec3At(f.m_p[j], axis) - p) * (d / (d - distances[j]));
    *low = drapeMin(first, second);
    *high = drapeMax(first, second);
}

// Twice the area of a, b, c seen along an axis.
DRAPE_FUNCTION float mollerArea(Vec3 a, Vec3 b, Vec3 c, int axis)
{
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    return (vec3At(b, u) - vec3At(a, u)) * (vec3At(c, v) - vec3At(a, v)) -
           (vec3At(b, v) - vec3At(a, v)) * (vec3At(c, u) - vec3At(a, u));
}

DRAPE_FUNCTION int mollerInside(Vec3 p, FeatureTriangle f, int axis)
{
    const float a = mollerArea(f.m_p[0], f.m_p[1], p, axis);
    const float b = mollerArea(f.m_p[1], f.m_p[2], p, axis);
    const float c = mollerArea(f.m_p[2], f.m_p[0], p, axis);
    return (a >= 0.0f && b >= 0.0f && c >= 0.0f) || (a <= 0.0f && b <= 0.0f && c <= 0.0f);
}

// Triangles in one plane: edges that cross, or one inside the other.
DRAPE_FUNCTION int mollerCoplanar(FeatureTriangle a, FeatureTriangle b, int axis)
{
    for (int i = 0; i < 3; ++i)
    {
        const FeatureEdge e = triangleEdge(&a, i);
        for (int j = 0; j < 3; ++j)
        {
            const FeatureEdge o = triangleEdge(&b, j);
            const float c = mollerArea(e.m_a, e.m_b, o.m_a, axis), d = mollerArea(e.m_a, e.m_b, o.m_b, axis);
            const float g = mollerArea(o.m_a, o.m_b, e.m_a, axis), h = mollerArea(o.m_a, o.m_b, e.m_b, axis);
            if (c * d <= 0.0f && g * h <= 0.0f && (c != 0.0f || d != 0.0f)) return 1;
        }
    }
    return mollerInside(a.m_p[0], b, axis) || mollerInside(b.m_p[0], a, axis);
}

DRAPE_FUNCTION int mollerLongest(Vec3 a)
{
    const float x = drapeAbs(a.x), y = drapeAbs(a.y), z = drapeAbs(a.z);
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

// Positions in the frame they are in, as the thesis has it.
DRAPE_FUNCTION int mollerIntersect(FeatureTriangle a, FeatureTriangle b)
{
    float sidesA[3], sidesB[3];
    const Vec3 normalA = triangleNormal(a), normalB = triangleNormal(b);
    if (mollerSides(b, normalA, vec3Dot(normalA, a.m_p[0]), sidesB)) return 0;
    if (mollerSides(a, normalB, vec3Dot(normalB, b.m_p[0]), sidesA)) return 0;
    const int coplanar = (sidesA[0] == 0.0f && sidesA[1] == 0.0f && sidesA[2] == 0.0f) ||
                         (sidesB[0] == 0.0f && sidesB[1] == 0.0f && sidesB[2] == 0.0f);
    if (coplanar) return mollerCoplanar(a, b, mollerLongest(normalA));
    const int axis = mollerLongest(vec3Cross(normalA, normalB));
    float lowA, highA, lowB, highB;
    mollerInterval(a, sidesA, axis, &lowA, &highA);
    mollerInterval(b, sidesB, axis, &lowB, &highB);
    return lowA <= highB && lowB <= highA;
}

DRAPE_NAMESPACE_END

#endif
