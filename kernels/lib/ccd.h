// Continuous collision of a vertex with a face and of an edge with an edge: do they come within a separation while all
// their vertices move linearly over the step, and when first?
//
// Both are one question: where is F(t,u,v) of ccd_motion.h within the separation of zero? A box of (t,u,v) is dropped
// when the bounds of F over it prove it away, else halved in the direction in which F varies most, the earlier half
// first. A box that provably holds a zero is a hit, and so is what cannot be dropped at the finest size.
// Method: B. Wang et al., A large-scale benchmark and an inclusion-based algorithm for continuous collision detection,
// 2021; bounds of our own, since theirs are not conservative for every frame (see ccdSlack), and views along the
// directions in which t, u and v come apart, which take an eighth of the boxes that the axes alone need.
//
// Guarantee: no pair that truly comes within the separation is called apart, and the time is no later than the true
// one. Pairs that miss each other by less than about 1e-6 of their extent may be called hits. Input that is not finite
// is no hit. Host and devices give the same bits. Cost: the depth of the search is bounded by 63 and kept in 24 bytes.
#ifndef DRAPE_LIB_CCD_H
#define DRAPE_LIB_CCD_H

#include "../shared/query.h"
#include "ccd_motion.h"

DRAPE_NAMESPACE_BEGIN

// Halvings per direction. 2^-21 of a feature or of the step: below the rounding of F, and three times 21 places fit the
// path's 64 bits.
#define DRAPE_CCD_LEVELS 21

// Halvings after which the views are aimed anew. On the published queries 3 to 8 cost the same, and never doing it five
// times as much.
#define DRAPE_CCD_AIM 6

DRAPE_FUNCTION CcdSettings ccdSettings(float separation, float tolerance, float timeTolerance, DRAPE_UINT boxLimit)
{
    CcdSettings settings;
    settings.m_separation = separation;
    settings.m_tolerance = tolerance;
    settings.m_timeTolerance = timeTolerance;
    settings.m_boxLimit = boxLimit;
    return settings;
}

// 1e-6: 0 misses and 157 false hits on the 6,593 hardest published negatives. A step is seldom worth more than 2^-14 of
// it (1 µs of 1/60 s). Of the 114,540 published hits, 27 take more than 4,096 boxes, and without a limit two would not
// end within a million.
DRAPE_FUNCTION CcdSettings ccdDefaults(void)
{
    return ccdSettings(0.0f, 1e-6f, 6.1035156e-5f, 4096u);
}

// The way from the whole domain to a box: a place per halving, 0 the first. Bit i of m_upper: the box is in the upper
// half; m_axis holds the direction in two bit sets.
typedef struct CcdPath
{
    DRAPE_ULONG m_upper;
    DRAPE_ULONG m_axis[2];
    int m_depth;
} CcdPath;

// The direction in which F varies most over the box; -1 when it varies no more than the tolerance in any, or no
// direction can be halved again.
DRAPE_FUNCTION int ccdAxis(const CcdMotion* m, const CcdBox* box, float tolerance)
{
    const float finest = 1.0f / (float)(1 << DRAPE_CCD_LEVELS);
    int axis = -1;
    float most = tolerance;
    for (int i = 0; i < 3; ++i)
    {
        const float variation = m->m_rates[i] * box->m_width[i];
        if (variation > most && box->m_width[i] > finest)
        {
            axis = i;
            most = variation;
        }
    }
    return axis;
}

DRAPE_FUNCTION void ccdDescend(CcdBox* box, CcdPath* path, int axis)
{
    const DRAPE_ULONG bit = (DRAPE_ULONG)1 << path->m_depth++;
    path->m_upper &= ~bit;
    path->m_axis[0] = (axis & 1) ? path->m_axis[0] | bit : path->m_axis[0] & ~bit;
    path->m_axis[1] = (axis & 2) ? path->m_axis[1] | bit : path->m_axis[1] & ~bit;
    box->m_width[axis] *= 0.5f;
}

// Goes on to the next box that was put off: the upper half of the latest halving of which the lower half is done.
// Returns whether there is one.
DRAPE_FUNCTION int ccdNext(CcdBox* box, CcdPath* path)
{
    while (path->m_depth > 0)
    {
        const DRAPE_ULONG bit = (DRAPE_ULONG)1 << (path->m_depth - 1);
        const int axis = ((path->m_axis[0] & bit) ? 1 : 0) + ((path->m_axis[1] & bit) ? 2 : 0);
        if (!(path->m_upper & bit))
        {
            path->m_upper |= bit;
            box->m_low[axis] += box->m_width[axis];
            return 1;
        }
        box->m_low[axis] -= box->m_width[axis];
        box->m_width[axis] *= 2.0f;
        --path->m_depth;
    }
    return 0;
}

// Earliest start of this box and of those put off: no impact is earlier.
DRAPE_FUNCTION float ccdEarliest(CcdBox box, CcdPath path)
{
    float earliest = box.m_low[0];
    while (ccdNext(&box, &path))
        earliest = drapeMin(earliest, box.m_low[0]);
    return earliest;
}

DRAPE_FUNCTION void ccdStoreHit(CcdResult* result, const CcdBox* box)
{
    result->m_hit = 1;
    result->m_time = box->m_low[0];
    result->m_u = drapeMin(box->m_low[1] + 0.5f * box->m_width[1], 1.0f);
    result->m_v = drapeMin(box->m_low[2] + 0.5f * box->m_width[2], 1.0f);
}

// Whether there is nothing to find in the box, told before it is looked at.
DRAPE_FUNCTION int ccdPasses(const CcdMotion* m, CcdSettings settings, const CcdBox* box, const CcdResult* result)
{
    if (m->m_triangular && box->m_low[1] + box->m_low[2] > 1.0f) return 1;
    return result->m_hit && box->m_low[0] + settings.m_timeTolerance >= result->m_time;
}

// Looks at a box: the direction in which to halve it, or -1 when it is done with. Stores a hit.
DRAPE_FUNCTION int ccdLook(const CcdMotion* m, CcdSettings settings, const CcdBox* box, CcdResult* result)
{
    CcdRanges ranges;
    ccdBounds(m, box, &ranges);
    const int state = ccdTest(m, &ranges);
    if (state == DRAPE_CCD_APART) return -1;
    int axis = state == DRAPE_CCD_OPEN ? ccdAxis(m, box, settings.m_tolerance) : -1;
    if (axis >= 0 && ccdHolds(m, box, &ranges)) axis = box->m_width[0] > settings.m_timeTolerance ? 0 : -1;
    if (axis < 0) ccdStoreHit(result, box);
    return axis;
}

// Depth first, the earlier half first. After a hit only boxes that start earlier by the time tolerance are looked at,
// so the hit in hand at the end is the earliest to that tolerance; its time is given that much earlier.
DRAPE_FUNCTION CcdResult ccdSearch(CcdMotion* m, CcdSettings settings)
{
    CcdResult result = {0u, 1.0f, 0.0f, 0.0f, 0u};
    CcdBox box = {{0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}};
    CcdPath path = {0u, {0u, 0u}, 0};
    ccdAim(m, &box);
    do
    {
        while (!ccdPasses(m, settings, &box, &result))
        {
            if (++result.m_boxes > settings.m_boxLimit)
            {
                const float earliest = ccdEarliest(box, path);
                if (!result.m_hit) ccdStoreHit(&result, &box);
                result.m_time = drapeMax(drapeMin(result.m_time, earliest) - settings.m_timeTolerance, 0.0f);
                return result;
            }
            const int axis = ccdLook(m, settings, &box, &result);
            if (axis < 0) break;
            ccdDescend(&box, &path, axis);
            if (path.m_depth % DRAPE_CCD_AIM == 0) ccdAim(m, &box);
        }
    } while (ccdNext(&box, &path));
    if (result.m_hit) result.m_time = drapeMax(result.m_time - settings.m_timeTolerance, 0.0f);
    return result;
}

DRAPE_FUNCTION CcdResult ccdRun(const CcdVectors* vectors, int triangular, CcdSettings settings)
{
    CcdResult none = {0u, 1.0f, 0.0f, 0.0f, 0u};
    CcdMotion motion;
    motion.m_vectors = *vectors;
    motion.m_triangular = triangular;
    if (!ccdPrepare(&motion, settings.m_separation)) return none;
    return ccdSearch(&motion, settings);
}

DRAPE_FUNCTION Vec3 ccdDifference(Vec3 a, Vec3 b)
{
    return vec3Sub(vec3Prescaled(a), vec3Prescaled(b));
}

// start, end: the vertex and the face's three corners, in any frame. (m_u, m_v): weights of the second and third
// corner.
DRAPE_FUNCTION CcdResult ccdVertexFace(const Vec3 start[4], const Vec3 end[4], CcdSettings settings)
{
    CcdVectors v;
    v.m_d0 = ccdDifference(start[0], start[1]);
    v.m_d1 = ccdDifference(end[0], end[1]);
    v.m_e0 = ccdDifference(start[2], start[1]);
    v.m_e1 = ccdDifference(end[2], end[1]);
    v.m_g0 = ccdDifference(start[3], start[1]);
    v.m_g1 = ccdDifference(end[3], end[1]);
    return ccdRun(&v, 1, settings);
}

// start, end: the ends of one edge, then of the other, in any frame. m_u, m_v: weights of the edges' second ends.
DRAPE_FUNCTION CcdResult ccdEdgeEdge(const Vec3 start[4], const Vec3 end[4], CcdSettings settings)
{
    CcdVectors v;
    v.m_d0 = ccdDifference(start[0], start[2]);
    v.m_d1 = ccdDifference(end[0], end[2]);
    v.m_e0 = ccdDifference(start[0], start[1]);
    v.m_e1 = ccdDifference(end[0], end[1]);
    v.m_g0 = ccdDifference(start[3], start[2]);
    v.m_g1 = ccdDifference(end[3], end[2]);
    return ccdRun(&v, 0, settings);
}

DRAPE_FUNCTION CcdResult ccdOfKind(DRAPE_UINT kind, const Vec3 start[4], const Vec3 end[4], CcdSettings settings)
{
    return kind == DRAPE_VERTEX_FACE ? ccdVertexFace(start, end, settings) : ccdEdgeEdge(start, end, settings);
}

DRAPE_NAMESPACE_END

#endif
