// Reduces a triangle with invalid corners (NaN, infinite or too far out, see positionIsValid) to its valid ones.
//
// A triangle with an invalid corner still owns features of its other corners (DRAPE_OWNS_VERTEX), which must be
// tested. It acts as the segment or point that its valid corners span. A feature with an invalid corner makes no
// contact.
#ifndef DRAPE_LIB_FINITE_CORNERS_H
#define DRAPE_LIB_FINITE_CORNERS_H

#include "../../shared/mesh.h"
#include "vec3.h"

DRAPE_NAMESPACE_BEGIN

// All features of a triangle: bits as in Triangle::m_owned.
#define DRAPE_ALL_FEATURES 63u

DRAPE_FUNCTION float cornersSum(const Vec3* p)
{
    return (vec3Norm1(p[0]) + vec3Norm1(p[1])) + vec3Norm1(p[2]);
}

// Replaces each corner that is invalid at the step's start or end by a valid one (m, three each; may be the same
// array). Returns the valid features, bits as in Triangle::m_owned: the valid corners and the edges between them.
// Without a valid corner all stay unchanged.
DRAPE_FUNCTION DRAPE_UINT replaceInvalidCorners(Vec3* start, Vec3* end)
{
    // Decides the usual case quickly: a sum with NaN or too large a term fails the comparison.
    if (cornersSum(start) + cornersSum(end) <= DRAPE_FARTHEST) return DRAPE_ALL_FEATURES;
    DRAPE_UINT valid = 0;
    Vec3 startStand = start[0], endStand = end[0];
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
    {
        if (!positionIsValid(start[i]) || !positionIsValid(end[i])) continue;
        valid |= DRAPE_OWNS_VERTEX(i);
        startStand = start[i];
        endStand = end[i];
    }
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
    {
        if (valid == 0u || (valid & DRAPE_OWNS_VERTEX(i))) continue;
        start[i] = startStand;
        end[i] = endStand;
    }
    for (int i = 0; i < 3; ++i)
    {
        const DRAPE_UINT ends = DRAPE_OWNS_VERTEX(i) | DRAPE_OWNS_VERTEX(i == 2 ? 0 : i + 1);
        if ((valid & ends) == ends) valid |= DRAPE_OWNS_EDGE(i);
    }
    return valid;
}

DRAPE_NAMESPACE_END

#endif
