// What is left of a triangle when corners of it are NaN or infinite.
//
// A triangle with an invalid corner still owns features of its other corners (DRAPE_OWNS_VERTEX), which must be tested:
// it acts as the segment or point that its finite corners span, and what uses an invalid corner makes no contact.
#ifndef DRAPE_LIB_FINITE_CORNERS_H
#define DRAPE_LIB_FINITE_CORNERS_H

#include "../shared/mesh.h"
#include "vec3.h"

DRAPE_NAMESPACE_BEGIN

// All features of a triangle: bits as in Triangle::m_owned.
#define DRAPE_ALL_FEATURES 63u

DRAPE_FUNCTION float cornersSum(const Vec3* p)
{
    return ((p[0].x + p[0].y) + (p[0].z + p[1].x)) + ((p[1].y + p[1].z) + (p[2].x + (p[2].y + p[2].z)));
}

// Puts a finite corner in the place of each that is not finite at the step's start and end (m, three each; may be the
// same array). Returns the features that are valid, bits as in Triangle::m_owned: the finite corners and the edges
// between them; without any, the corners stay as they are.
DRAPE_FUNCTION DRAPE_UINT replaceInvalidCorners(Vec3* start, Vec3* end)
{
    // Whatever is not finite makes the sum so. A sum may overflow: then the slow way finds nothing to replace.
    if (drapeIsFinite(cornersSum(start) + cornersSum(end))) return DRAPE_ALL_FEATURES;
    DRAPE_UINT valid = 0;
    int stand = -1;
    for (int i = 0; i < 3; ++i)
    {
        if (!vec3IsFinite(start[i]) || !vec3IsFinite(end[i])) continue;
        valid |= DRAPE_OWNS_VERTEX(i);
        stand = i;
    }
    for (int i = 0; i < 3 && stand >= 0; ++i)
    {
        if (valid & DRAPE_OWNS_VERTEX(i)) continue;
        start[i] = start[stand];
        end[i] = end[stand];
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
