// Decides whether two triangles intersect. Separating axes: two normals, nine edge × edge, six normal × edge. A float
// axis is taken as exact. A pair is called separate only if the gap along an axis exceeds the rounding of the
// projections. No intersecting pair is missed; touching and some nearly touching pairs are reported, too.
#ifndef DRAPE_LIB_TRIANGLE_TRIANGLE_H
#define DRAPE_LIB_TRIANGLE_TRIANGLE_H

#include "../narrow_phase/feature_contact.h"

DRAPE_NAMESPACE_BEGIN

DRAPE_FUNCTION int axisSeparates(Vec3 n, FeatureTriangle a, FeatureTriangle b, float extent)
{
    const float a0 = vec3Dot(n, a.m_p[0]), a1 = vec3Dot(n, a.m_p[1]), a2 = vec3Dot(n, a.m_p[2]);
    const float b0 = vec3Dot(n, b.m_p[0]), b1 = vec3Dot(n, b.m_p[1]), b2 = vec3Dot(n, b.m_p[2]);
    const float lowA = drapeMin(drapeMin(a0, a1), a2), highA = drapeMax(drapeMax(a0, a1), a2);
    const float lowB = drapeMin(drapeMin(b0, b1), b2), highB = drapeMax(drapeMax(b0, b1), b2);
    const float gap = drapeMax(lowA - highB, lowB - highA);
    return gap > 7.1525574e-7f * vec3Norm1(n) * extent + 1e-36f;
}

// Positions in a local frame, as in feature_contact.h.
DRAPE_FUNCTION int trianglesIntersect(FeatureTriangle a, FeatureTriangle b)
{
    const float extent = drapeMax(triangleExtent(a), triangleExtent(b));
    const Vec3 normals[2] = {triangleNormal(a), triangleNormal(b)};
    const Vec3 edgesA[3] = {vec3Sub(a.m_p[1], a.m_p[0]), vec3Sub(a.m_p[2], a.m_p[1]), vec3Sub(a.m_p[0], a.m_p[2])};
    const Vec3 edgesB[3] = {vec3Sub(b.m_p[1], b.m_p[0]), vec3Sub(b.m_p[2], b.m_p[1]), vec3Sub(b.m_p[0], b.m_p[2])};
    if (axisSeparates(normals[0], a, b, extent) || axisSeparates(normals[1], a, b, extent)) return 0;
    for (int i = 0; i < 3; ++i)
    {
        if (axisSeparates(vec3Cross(normals[0], edgesA[i]), a, b, extent)) return 0;
        if (axisSeparates(vec3Cross(normals[1], edgesB[i]), a, b, extent)) return 0;
        for (int j = 0; j < 3; ++j)
        {
            if (axisSeparates(vec3Cross(edgesA[i], edgesB[j]), a, b, extent)) return 0;
        }
    }
    return 1;
}

DRAPE_NAMESPACE_END

#endif
