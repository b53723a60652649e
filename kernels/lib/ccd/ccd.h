// Continuous collision of a vertex with a face and of an edge with an edge: decides whether they come within a
// separation while all their vertices move linearly over the step, and when first.
//
// Input: a motion (ccd_motion.h), separation, tolerances and a limit of boxes. Method: bisection of boxes of (t,u,v),
// after B. Wang et al., A large-scale benchmark and an inclusion-based algorithm for continuous collision detection,
// 2021, with bounds of our own. docs/design_notes/ccd.md explains it.
//
// Guarantee: a pair that truly comes within the separation is never called apart, and the time is no later than the
// true one. Pairs that miss each other by less than about 1e-6 of their extent may be called hits. Input that is not
// finite is no hit. Host and devices give the same bits. Cost: the search's depth is at most 63, stored in 24 bytes.
#ifndef DRAPE_LIB_CCD_H
#define DRAPE_LIB_CCD_H

#include "../../shared/query.h"
#include "ccd_guess.h"

DRAPE_NAMESPACE_BEGIN

// Halvings per direction. 2^-21 of a feature or of the step: below the rounding of F, and three times 21 places fit the
// path's 64 bits.
#define DRAPE_CCD_LEVELS 21

// Halvings after which the views are aimed again. On the published queries 3 to 8 cost the same, and never aiming again
// costs five times as much.
#define DRAPE_CCD_AIM 6

// Divisor of the box limit for searches for the time, relative to the search for any hit: 256 of 4,096 by default. One
// published hit in 27 takes more than that in all.
#define DRAPE_CCD_PARTS 16u

DRAPE_FUNCTION CcdSettings ccdSettings(float separation, float tolerance, float timeTolerance, DRAPE_UINT boxLimit)
{
    CcdSettings settings;
    settings.m_separation = separation;
    settings.m_tolerance = tolerance;
    settings.m_timeTolerance = timeTolerance;
    settings.m_boxLimit = boxLimit;
    return settings;
}

// Default settings. A tolerance of 1e-6 gives 0 misses and 157 false hits on the 6,598 published negatives. A step is
// seldom worth more than 2^-14 of it (1 µs of 1/60 s). Three of the 114,540 published hits take more than 4,096 boxes
// to be found; the mean is 22, and 90 for the time.
DRAPE_FUNCTION CcdSettings ccdDefaults(void)
{
    return ccdSettings(0.0f, 1e-6f, 6.1035156e-5f, 4096u);
}

// The path of halvings from the whole domain to a box, 0 the first. Bit i of m_upper: the box is in the upper half;
// m_axis holds the direction in two bit sets.
typedef struct CcdPath
{
    DRAPE_ULONG m_upper;
    DRAPE_ULONG m_axis[2];
    int m_depth;
} CcdPath;

// Returns whether the halves of the box in time begin and end at multiples of 2^-24, as the box does. Only then are
// times, and the rest of the step after them, exact, and the halves cover exactly the box.
DRAPE_FUNCTION int ccdHalvesInTime(const CcdBox* box)
{
    const float width = 0.5f * box->m_width[0], middle = box->m_low[0] + width;
    return middle - box->m_low[0] == width && 1.0f - (1.0f - middle) == middle;
}

// Returns the direction in which F varies most over the box; -1 if it varies at most the tolerance in each, or no
// direction can be halved again.
DRAPE_FUNCTION int ccdAxis(const CcdMotion* m, const CcdBox* box, float tolerance)
{
    const float finest = 1.0f / (float)(1 << DRAPE_CCD_LEVELS);
    int axis = -1;
    float most = tolerance;
    for (int i = 0; i < 3; ++i)
    {
        const float variation = m->m_rates[i] * box->m_width[i];
        if (variation > most && box->m_width[i] > finest && (i > 0 || ccdHalvesInTime(box)))
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
    ccdWidenAlong(box, axis, 0.5f);
}

// Continues with the next deferred box: the upper half of the latest halving whose lower half is done. Returns whether
// there is one.
DRAPE_FUNCTION int ccdNext(CcdBox* box, CcdPath* path)
{
    while (path->m_depth > 0)
    {
        const DRAPE_ULONG bit = (DRAPE_ULONG)1 << (path->m_depth - 1);
        const int axis = ((path->m_axis[0] & bit) ? 1 : 0) + ((path->m_axis[1] & bit) ? 2 : 0);
        if (!(path->m_upper & bit))
        {
            path->m_upper |= bit;
            ccdMoveAlong(box, axis, 1.0f);
            return 1;
        }
        ccdMoveAlong(box, axis, -1.0f);
        ccdWidenAlong(box, axis, 2.0f);
        --path->m_depth;
    }
    return 0;
}

DRAPE_FUNCTION void ccdStoreHit(CcdResult* result, const CcdBox* box)
{
    result->m_hit = 1;
    result->m_time = box->m_low[0];
    result->m_u = drapeMin(box->m_low[1] + 0.5f * box->m_width[1], 1.0f);
    result->m_v = drapeMin(box->m_low[2] + 0.5f * box->m_width[2], 1.0f);
}

// A search of the part [low, low + width] of the step, for the time to the tolerance, or for any hit if that is 1.
typedef struct CcdTask
{
    float m_low;
    float m_width;
    float m_timeTolerance;
    float m_tolerance;
    DRAPE_UINT m_boxLimit;
} CcdTask;

DRAPE_FUNCTION CcdBox ccdTaskBox(const CcdTask* task)
{
    const CcdBox box = {{task->m_low, 0.0f, 0.0f}, {task->m_width, 1.0f, 1.0f}};
    return box;
}

// Returns whether the box is known to hold no result before it is tested.
DRAPE_FUNCTION int ccdPasses(const CcdMotion* m, const CcdTask* task, const CcdBox* box, const CcdResult* result)
{
    if (m->m_triangular && box->m_low[1] + box->m_low[2] > 1.0f) return 1;
    return result->m_hit && box->m_low[0] + task->m_timeTolerance >= result->m_time;
}

// Tests a box. Returns the direction in which to halve it, or -1 when it is finished. Stores a hit.
DRAPE_FUNCTION int ccdLook(const CcdMotion* m, const CcdTask* task, const CcdBox* box, CcdResult* result)
{
    CcdRanges ranges;
    ccdBounds(m, box, &ranges);
    const int state = ccdTest(m, &ranges);
    if (state == DRAPE_CCD_APART || ccdBeyondSide(m, box)) return -1;
    int axis = state == DRAPE_CCD_OPEN ? ccdAxis(m, box, task->m_tolerance) : -1;
    if (axis >= 0 && ccdHolds(m, box)) axis = box->m_width[0] > task->m_timeTolerance && ccdHalvesInTime(box) ? 0 : -1;
    if (axis < 0) ccdStoreHit(result, box);
    return axis;
}

// Searches depth first, the earlier half first. After a hit it tests only boxes that start earlier by the time
// tolerance, so that the final hit is the earliest to that tolerance. If the search exceeds its limit of boxes, as
// m_boxes shows, the hit may be missing or later. The views must be aimed.
DRAPE_FUNCTION CcdResult ccdSearch(CcdMotion* m, const CcdTask* task)
{
    CcdResult result = {0u, 1.0f, 0.0f, 0.0f, 0u};
    CcdBox box = ccdTaskBox(task);
    CcdPath path = {0u, {0u, 0u}, 0};
    do
    {
        while (!ccdPasses(m, task, &box, &result))
        {
            if (++result.m_boxes > task->m_boxLimit) return result;
            const int axis = ccdLook(m, task, &box, &result);
            if (axis < 0) break;
            ccdDescend(&box, &path, axis);
            if (path.m_depth % DRAPE_CCD_AIM == 0)
            {
                ccdAim(m, &box);
                ccdAimAtSide(m, &box);
            }
        }
    } while (ccdNext(&box, &path));
    return result;
}

// Aims the views at the time when the features are in one plane, or at the beginning of a box about it that holds a
// zero. The result is then a hit unless something precedes it. Returns 0 if nothing can.
DRAPE_FUNCTION int ccdGuess(CcdMotion* m, const CcdTask* whole, CcdResult* result, CcdBox* aim, CcdBox* guess)
{
    const int inside = ccdGuessBox(m, whole->m_timeTolerance, aim, guess);
    if (inside) aim->m_low[0] = guess->m_low[0];
    ccdAim(m, aim);
    ccdAimAtSide(m, aim);
    if (!inside) return 1;
    result->m_boxes = 1u;
    if (!ccdHolds(m, guess)) return 1;
    result->m_hit = 1u;
    result->m_time = guess->m_low[0];
    result->m_u = aim->m_low[1];
    result->m_v = aim->m_low[2];
    return guess->m_low[0] > 0.0f;
}

// Pieces that are searched before the whole step, at first with views aimed by a guess. 0: the whole step, with one
// box test; 1: the time before the guess; 2: the guess's time; 3: the time after it. All begin and end at multiples
// of 2^-24.
#define DRAPE_CCD_PIECES 4
DRAPE_FUNCTION CcdTask ccdPiece(const CcdTask* whole, DRAPE_UINT part, const CcdBox* guess, int piece)
{
    const float begin = guess->m_low[0], end = begin + guess->m_width[0];
    CcdTask task = {0.0f, 1.0f, 1.0f, whole->m_tolerance, piece == 0 ? 1u : part};
    if (piece > 1) task.m_low = piece == 2 ? begin : end;
    if (piece > 0) task.m_width = (piece == 1 ? begin : piece == 2 ? end : 1.0f) - task.m_low;
    return task;
}

// Starts from a guess: a hit if nothing precedes it, otherwise perhaps a proof that there is none. If that fails,
// searches the whole step for hit and time at once.
//
// Some searches take too many boxes, for features that touch along a line, or nearly. The search then first decides
// whether there is a hit at all, and bisects the step for its time. An earlier half without a hit is finished; a half
// that takes too many boxes counts as having one.
DRAPE_RARE_FUNCTION CcdResult ccdFind(CcdMotion* m, CcdSettings settings)
{
    const int timed = settings.m_timeTolerance < 1.0f;
    const DRAPE_UINT part = settings.m_boxLimit / DRAPE_CCD_PARTS;
    const CcdTask whole = {0.0f, 1.0f, settings.m_timeTolerance, settings.m_tolerance,
                           timed ? part : settings.m_boxLimit};
    CcdTask task = whole;
    CcdResult found = {0u, 1.0f, 0.0f, 0.0f, 0u};
    CcdBox aim, guess;
    if (!ccdGuess(m, &whole, &found, &aim, &guess)) return found;
    for (int round = (found.m_hit ? 1 : 0) - DRAPE_CCD_PIECES;; ++round)
    {
        if (round < 0) task = ccdPiece(&whole, part, &guess, round + DRAPE_CCD_PIECES);
        if (round > 0) aim = ccdTaskBox(&task);
        if (round >= 0)
        {
            ccdAim(m, &aim);
            ccdAimAtSide(m, &aim);
        }
        CcdResult result = ccdSearch(m, &task);
        const int exhausted = result.m_boxes > task.m_boxLimit;
        result.m_boxes += found.m_boxes;
        found.m_boxes = result.m_boxes;
        if (round < 0)
        {
            const int empty = !result.m_hit && !exhausted;
            if (empty && (found.m_hit || round == -DRAPE_CCD_PIECES || round == -1)) return found;
            // Searches the whole step: all that is known is that there may be a hit.
            if (!empty && round > -DRAPE_CCD_PIECES) round = -1;
            if (round == -1) task = whole;
            continue;
        }
        if (round == 0 && !exhausted) return result;
        if (round == 1 && !exhausted && !result.m_hit) return result;
        // A refuted half ends the part of the step without a hit; otherwise the search continues with the hit in it.
        const int hit = result.m_hit || exhausted;
        if (hit && result.m_hit) found = result;
        if (!timed || (round > 1 && task.m_width <= settings.m_timeTolerance))
        {
            found.m_hit = 1u;
            found.m_time = hit ? task.m_low : task.m_low + task.m_width;
            return found;
        }
        if (round > 1 && !hit) task.m_low += task.m_width;
        if (round > 0) task.m_width *= 0.5f;
        task.m_timeTolerance = 1.0f;
        task.m_boxLimit = round == 0 ? settings.m_boxLimit : part;
    }
}

DRAPE_FUNCTION CcdResult ccdRun(const CcdVectors* vectors, int triangular, CcdSettings settings)
{
    CcdResult none = {0u, 1.0f, 0.0f, 0.0f, 0u};
    CcdMotion motion;
    settings.m_timeTolerance = drapeMax(settings.m_timeTolerance, 0.0f);
    motion.m_vectors = *vectors;
    motion.m_triangular = triangular;
    if (!ccdPrepare(&motion, settings.m_separation)) return none;
    CcdResult result = ccdFind(&motion, settings);
    if (result.m_hit) result.m_time = drapeMax(result.m_time - settings.m_timeTolerance, 0.0f);
    return result;
}

DRAPE_FUNCTION Vec3 ccdDifference(Vec3 a, Vec3 b)
{
    return vec3Sub(vec3Prescaled(a), vec3Prescaled(b));
}

// start, end: the vertex and the face's three corners, or the ends of one edge and then of the other, in any frame.
// m_u, m_v of the result: weights of the face's second and third corner, or of the edges' second ends.
DRAPE_FUNCTION CcdVectors ccdVectors(DRAPE_UINT kind, const Vec3 start[4], const Vec3 end[4])
{
    const int face = kind == DRAPE_VERTEX_FACE;
    // D = p0 - base, E = p2 - p1 and G = p3 - p1 of a face, E = p0 - p1 and G = p3 - p2 of edges.
    CcdVectors v;
    v.m_d0 = ccdDifference(start[0], face ? start[1] : start[2]);
    v.m_d1 = ccdDifference(end[0], face ? end[1] : end[2]);
    v.m_e0 = ccdDifference(face ? start[2] : start[0], start[1]);
    v.m_e1 = ccdDifference(face ? end[2] : end[0], end[1]);
    v.m_g0 = ccdDifference(start[3], face ? start[1] : start[2]);
    v.m_g1 = ccdDifference(end[3], face ? end[1] : end[2]);
    return v;
}

DRAPE_FUNCTION CcdResult ccdOfKind(DRAPE_UINT kind, const Vec3 start[4], const Vec3 end[4], CcdSettings settings)
{
    const CcdVectors vectors = ccdVectors(kind, start, end);
    return ccdRun(&vectors, kind == DRAPE_VERTEX_FACE, settings);
}

DRAPE_NAMESPACE_END

#endif
