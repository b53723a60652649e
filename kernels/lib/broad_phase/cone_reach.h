// Bounds how far a contact can reach along a direction of the volumes, given the cone of the contact's direction.
//
// A contact without a meeting joins two points by an offset that the obstacle feature's normal cone admits
// (feature_contact.h). Across a cone's axis, an offset of length r extends at most r sin(half-angle). If all features
// of a patch face much the same way, cloth beside the patch is therefore out of reach long before its distance
// exceeds the reach.
//
// Cones are double, as coneAdmits() takes them. Results are rounded to the safe side by DRAPE_CONE_PAD, thousands of
// roundings of the cones' own numbers.
#ifndef DRAPE_LIB_CONE_REACH_H
#define DRAPE_LIB_CONE_REACH_H

#include "../../shared/patch.h"
#include "../geometry/dop.h"

DRAPE_NAMESPACE_BEGIN

// Padding of a cosine or of a share of the reach.
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

// Returns the cosine of the half-angle, about `axis` (unit), of a cone that contains `cone`; -1 for a right angle or
// more.
DRAPE_FUNCTION float cosineAround(Vec3 axis, NormalCone cone)
{
    const float between = drapeMin(drapeAbs(vec3Dot(axis, cone.m_axis)), 1.0f);
    if (!(cone.m_cosine > 0.0f)) return -1.0f;
    const float cosine = between * cone.m_cosine - sineOf(between) * sineOf(drapeMin(cone.m_cosine, 1.0f));
    return cosine > 0.0f ? cosine : -1.0f;
}

// Returns cosineAround() for a cone that contains all directions that a triangle's corners and edges admit. cones: of
// its corners, then of its edges.
DRAPE_FUNCTION float cosineOfCones(Vec3 axis, const NormalCone* cones)
{
    float cosine = 1.0f;
    for (int k = 0; k < 6 && cosine > 0.0f; ++k)
        cosine = drapeMin(cosine, cosineAround(axis, cones[k]));
    return cosine;
}

// Radians by which the angle between a cone's axis and a normal may be off: where it is small, the root of twice the
// error of their product, of some 30 roundings. That of a triangle's normal is 2e-5 (DRAPE_CULL_THIN).
#define DRAPE_SPREAD_SLACK 2e-3f
// Directions steeper than 1.4 radians beside a face are taken as unbounded: the tangent grows without limit.
#define DRAPE_SPREAD_COSINE 0.17f

// Returns a face's spread (patch.h). face: its normal as a cone; cones: see cosineOfCones(). All must use the narrow
// phase's positions: corners that are rounded to an obstacle's pose turn small faces, and do not turn the cones.
DRAPE_FUNCTION float faceSpread(NormalCone face, const NormalCone* cones)
{
    if (!(face.m_cosine > 0.0f)) return DRAPE_ANY_SPREAD;
    const float admitted = cosineOfCones(face.m_axis, cones);
    // cos(a + b) ≥ cos a - b sin a - b² / 2
    const float slack = DRAPE_SPREAD_SLACK;
    const float cosine = admitted - slack * sineOf(admitted) - 0.5f * slack * slack;
    return cosine > DRAPE_SPREAD_COSINE ? sineOf(cosine) / cosine : DRAPE_ANY_SPREAD;
}

// Returns the maximum extent along direction i of the volumes of a unit vector in the cone or its opposite, rounded up.
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
