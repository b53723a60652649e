// How far a contact can reach along a direction of the volumes, given the cone that its direction lies in.
//
// A contact without a meeting joins two points by an offset that the obstacle feature's normal cone admits
// (feature_contact.h). So where all features of a patch face much the same way, cloth beside the patch is out of reach
// long before it is as far off as the reach: across a cone's axis, an offset of length r goes r sin(half-angle) at
// most. Cones are double, as coneAdmits() takes them. Results are rounded to the safe side by DRAPE_CONE_PAD, thousands
// of roundings of the cones' own numbers.
#ifndef DRAPE_LIB_CONE_REACH_H
#define DRAPE_LIB_CONE_REACH_H

#include "dop.h"

DRAPE_NAMESPACE_BEGIN

// Of a cosine or a share of the reach.
#define DRAPE_CONE_PAD 1e-3f

DRAPE_FUNCTION NormalCone normalCone(Vec3 axis, float cosine)
{
    NormalCone cone;
    cone.m_axis = axis;
    cone.m_cosine = cosine;
    return cone;
}

DRAPE_FUNCTION float sineOf(float cosine)
{
    return drapeSqrt(drapeMax(1.0f - cosine * cosine, 0.0f));
}

// Cosine of the half-angle about `axis` (unit) of a cone that holds `cone`; -1 where that is a right angle or more.
DRAPE_FUNCTION float cosineAround(Vec3 axis, NormalCone cone)
{
    const float between = drapeMin(drapeAbs(vec3Dot(axis, cone.m_axis)), 1.0f);
    if (!(cone.m_cosine > 0.0f)) return -1.0f;
    const float cosine = between * cone.m_cosine - sineOf(between) * sineOf(drapeMin(cone.m_cosine, 1.0f));
    return cosine > 0.0f ? cosine : -1.0f;
}

// Most that a unit vector in the cone or its opposite goes along direction i of the volumes, rounded up.
DRAPE_FUNCTION float coneReach(NormalCone cone, int i)
{
    const float norm = dopNorm(i);
    if (!(cone.m_cosine > 0.0f)) return norm;
    const float along = drapeMin(drapeAbs(dopProject(cone.m_axis, i)) / norm, 1.0f);
    const float cosine = drapeMin(cone.m_cosine, 1.0f);
    if (along >= cosine) return norm;
    const float most = along * cosine + sineOf(along) * sineOf(cosine);
    return norm * drapeMin(most + DRAPE_CONE_PAD, 1.0f);
}

DRAPE_NAMESPACE_END

#endif
