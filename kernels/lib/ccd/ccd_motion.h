// The motion of a vertex and a face, or of two edges, over a step: F(t,u,v) = D(t) - u E(t) - v G(t). F is the offset
// between the points (u,v) on the features at the time t; D, E and G are differences of vertices that are linear in
// t. F is linear in each of t, u and v, so over a box its extremes are at the box's corners. This holds along any
// direction, and a proof along any direction is valid. See ccd.h for the search that uses it.
#ifndef DRAPE_LIB_CCD_MOTION_H
#define DRAPE_LIB_CCD_MOTION_H

#include "../geometry/local_frame.h"

DRAPE_NAMESPACE_BEGIN

// D, E and G at the step's start and end, in the pair's own frame.
typedef struct CcdVectors
{
    Vec3 m_d0, m_d1, m_e0, m_e1, m_g0, m_g1;
} CcdVectors;

// Views of F along several directions, each taken as exact. The first three are x, y and z. Along the features' common
// normal F does not vary with u and v. Along the other two it does not vary with t and v, or with t and u.
#define DRAPE_CCD_VIEWS 6
#define DRAPE_CCD_NORMAL 3
#define DRAPE_CCD_ALONG_U 4
#define DRAPE_CCD_ALONG_V 5
// An additional view for the side of a face on which u + v = 1.
#define DRAPE_CCD_ALONG_SIDE 6
#define DRAPE_CCD_ALL_VIEWS 7

#define DRAPE_CCD_TWELVE_UNITS 7.1525574e-7f  // 12 · 2^-24

typedef struct CcdMotion
{
    CcdVectors m_vectors;
    float m_scale;
    float m_d0[DRAPE_CCD_ALL_VIEWS], m_d1[DRAPE_CCD_ALL_VIEWS];  // D, E and G in each view at the step's ends
    float m_e0[DRAPE_CCD_ALL_VIEWS], m_e1[DRAPE_CCD_ALL_VIEWS];
    float m_g0[DRAPE_CCD_ALL_VIEWS], m_g1[DRAPE_CCD_ALL_VIEWS];
    float m_slack[DRAPE_CCD_ALL_VIEWS];  // more than F's bounds err by rounding
    float m_reach[DRAPE_CCD_ALL_VIEWS];  // slack and separation: bounds beyond it prove F beyond the separation
    float m_separation;                  // in the frame
    float m_rates[3];                    // maximum variation of F along the whole of t, u, v, on any axis
    int m_triangular;                    // u + v ≤ 1
    int m_independent;                   // the skew views' directions span space; see ccdAim
} CcdMotion;

// A box [x, x + width] in each of t, u, v; corners and widths are exact, and so is 1 - t at them.
typedef struct CcdBox
{
    float m_low[3];
    float m_width[3];
} CcdBox;

// Moves a box by its widths along an axis, and scales that width. Written so that a GPU keeps the box in registers,
// which have no index.
DRAPE_FUNCTION void ccdMoveAlong(CcdBox* box, int axis, float widths)
{
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
        if (i == axis) box->m_low[i] += widths * box->m_width[i];
}

DRAPE_FUNCTION void ccdWidenAlong(CcdBox* box, int axis, float factor)
{
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
        if (i == axis) box->m_width[i] *= factor;
}

DRAPE_FUNCTION float ccdMost(float a, float b)
{
    return drapeMax(drapeAbs(a), drapeAbs(b));
}

// Bounds the rounding errors of F along axis i. Let u = 2^-24, and M_D, M_E, M_G be the largest |D|, |E|, |G| at the
// step's ends. Each end is one rounding of a difference (u M). Each value between is two products and a sum (2 u M).
// The products u E and v G add u M each. The two last sums round at most M_D + M_E + M_G each. Together this is 6 u
// (M_D + M_E + M_G); 7 u covers the second-order terms and the rounding of the slack. Flushed denormals add 2^-126
// each, before scaling (12 coordinates and their differences) and after it.
DRAPE_FUNCTION float ccdSlack(const CcdMotion* m, int i)
{
    const float sevenUnits = 4.1723251e-7f;
    const float most =
        ccdMost(m->m_d0[i], m->m_d1[i]) + ccdMost(m->m_e0[i], m->m_e1[i]) + ccdMost(m->m_g0[i], m->m_g1[i]);
    return sevenUnits * most + 32.0f * DRAPE_FLUSH * (1.0f + m->m_scale);
}

DRAPE_FUNCTION float ccdExtent(const CcdVectors* v)
{
    const float ends0 = drapeMax(drapeMax(vec3NormMax(v->m_d0), vec3NormMax(v->m_e0)), vec3NormMax(v->m_g0));
    const float ends1 = drapeMax(drapeMax(vec3NormMax(v->m_d1), vec3NormMax(v->m_e1)), vec3NormMax(v->m_g1));
    return drapeMax(ends0, ends1);
}

// Along an axis, n is a unit vector: the products are exact.
DRAPE_FUNCTION void ccdProject(CcdMotion* m, int i, Vec3 n)
{
    const CcdVectors* v = &m->m_vectors;
    m->m_d0[i] = vec3Dot(n, v->m_d0);
    m->m_d1[i] = vec3Dot(n, v->m_d1);
    m->m_e0[i] = vec3Dot(n, v->m_e0);
    m->m_e1[i] = vec3Dot(n, v->m_e1);
    m->m_g0[i] = vec3Dot(n, v->m_g0);
    m->m_g1[i] = vec3Dot(n, v->m_g1);
}

DRAPE_FUNCTION void ccdAddAxis(CcdMotion* m, int i, Vec3 unit)
{
    ccdProject(m, i, unit);
    m->m_slack[i] = ccdSlack(m, i);
    m->m_reach[i] = m->m_separation + m->m_slack[i];
}

// Adds a view along any direction, made of the vectors' rounded coordinates. The view's own slack grows by two terms
// for each vector: u |n|₁ M for its rounding and 3 u |n|₁ M for the dot product, with M ≤ 1 in the frame. For D, E
// and G together these are 12 u |n|₁, plus their flushed products.
DRAPE_FUNCTION Vec3 ccdAddSkewView(CcdMotion* m, int i, Vec3 direction)
{
    const Vec3 n = vec3Scale(direction, localScale(vec3NormMax(direction)));
    ccdProject(m, i, n);
    m->m_slack[i] = ccdSlack(m, i) + DRAPE_CCD_TWELVE_UNITS * vec3Norm1(n) * (1.0f + DRAPE_CCD_TWELVE_UNITS);
    m->m_reach[i] = m->m_slack[i];
    if (m->m_separation > 0.0f)
        m->m_reach[i] += m->m_separation * vec3Length(n) * (1.0f + 2.0f * DRAPE_CCD_TWELVE_UNITS);
    return n;
}

// Returns the derivative of F with respect to t at a point of the features.
DRAPE_FUNCTION Vec3 ccdRate(const CcdVectors* v, float place0, float place1)
{
    Vec3 rate = vec3Sub(v->m_d1, v->m_d0);
    rate = vec3AddScaled(rate, vec3Sub(v->m_e1, v->m_e0), -place0);
    return vec3AddScaled(rate, vec3Sub(v->m_g1, v->m_g0), -place1);
}

// Aims the skew views at the derivatives of F in the middle of a box: each view varies with t, u or v alone there.
// Their proofs hold everywhere. Directions whose volume is below 1e-5, far above its rounding, count as dependent.
DRAPE_FUNCTION void ccdAim(CcdMotion* m, const CcdBox* box)
{
    const CcdVectors* v = &m->m_vectors;
    const float t = box->m_low[0] + 0.5f * box->m_width[0];
    const Vec3 e = vec3Mix(v->m_e0, v->m_e1, t);
    const Vec3 g = vec3Mix(v->m_g0, v->m_g1, t);
    const Vec3 rate = ccdRate(v, box->m_low[1] + 0.5f * box->m_width[1], box->m_low[2] + 0.5f * box->m_width[2]);
    const Vec3 n3 = ccdAddSkewView(m, DRAPE_CCD_NORMAL, vec3Cross(e, g));
    const Vec3 n4 = ccdAddSkewView(m, DRAPE_CCD_ALONG_U, vec3Cross(g, rate));
    const Vec3 n5 = ccdAddSkewView(m, DRAPE_CCD_ALONG_V, vec3Cross(e, rate));
    m->m_independent = drapeAbs(vec3Dot(n3, vec3Cross(n4, n5))) > 1e-5f;
}

// Aims at a face's third side, on which u + v = 1, like ccdAim() at the others: in this view F varies with u + v alone.
// In terms of u + v and v it is D - (u + v) E - v (G - E). G - E is up to 2 and made of two rounded vectors. The twelve
// units of |n|₁ for the vectors become eighteen, which twice the twelve cover.
DRAPE_FUNCTION void ccdAimAtSide(CcdMotion* m, const CcdBox* box)
{
    const CcdVectors* v = &m->m_vectors;
    const int i = DRAPE_CCD_ALONG_SIDE;
    if (!m->m_triangular) return;
    const Vec3 side0 = vec3Sub(v->m_g0, v->m_e0), side1 = vec3Sub(v->m_g1, v->m_e1);
    const Vec3 rate = ccdRate(v, box->m_low[1] + 0.5f * box->m_width[1], box->m_low[2] + 0.5f * box->m_width[2]);
    const Vec3 side = vec3Mix(side0, side1, box->m_low[0] + 0.5f * box->m_width[0]);
    const Vec3 n = ccdAddSkewView(m, i, vec3Cross(side, rate));
    m->m_g0[i] = vec3Dot(n, side0);
    m->m_g1[i] = vec3Dot(n, side1);
    m->m_reach[i] += ccdSlack(m, i) + DRAPE_CCD_TWELVE_UNITS * vec3Norm1(n) * (1.0f + DRAPE_CCD_TWELVE_UNITS);
}

// Scales the differences, given prescaled, so that the largest is in [1/2, 1), and derives the rest. Returns whether
// they are finite.
DRAPE_FUNCTION int ccdPrepare(CcdMotion* m, float separation)
{
    CcdVectors* v = &m->m_vectors;
    const int finite = vec3IsFinite(v->m_d0) && vec3IsFinite(v->m_d1) && vec3IsFinite(v->m_e0) &&
                       vec3IsFinite(v->m_e1) && vec3IsFinite(v->m_g0) && vec3IsFinite(v->m_g1);
    if (!finite) return 0;
    const float scale = localScale(ccdExtent(v));
    v->m_d0 = vec3Scale(v->m_d0, scale);
    v->m_d1 = vec3Scale(v->m_d1, scale);
    v->m_e0 = vec3Scale(v->m_e0, scale);
    v->m_e1 = vec3Scale(v->m_e1, scale);
    v->m_g0 = vec3Scale(v->m_g0, scale);
    v->m_g1 = vec3Scale(v->m_g1, scale);
    m->m_separation = separation * DRAPE_PRESCALE * scale;
    m->m_scale = scale;
    ccdAddAxis(m, 0, vec3(1.0f, 0.0f, 0.0f));
    ccdAddAxis(m, 1, vec3(0.0f, 1.0f, 0.0f));
    ccdAddAxis(m, 2, vec3(0.0f, 0.0f, 1.0f));
    m->m_rates[1] = drapeMax(vec3NormMax(v->m_e0), vec3NormMax(v->m_e1));
    m->m_rates[2] = drapeMax(vec3NormMax(v->m_g0), vec3NormMax(v->m_g1));
    m->m_rates[0] = vec3NormMax(vec3Sub(v->m_d1, v->m_d0)) + vec3NormMax(vec3Sub(v->m_e1, v->m_e0)) +
                    vec3NormMax(vec3Sub(v->m_g1, v->m_g0));
    return 1;
}

// Least and greatest F in each view over the box, at its first time and at its last.
typedef struct CcdRanges
{
    float m_low0[DRAPE_CCD_VIEWS], m_high0[DRAPE_CCD_VIEWS];
    float m_low1[DRAPE_CCD_VIEWS], m_high1[DRAPE_CCD_VIEWS];
} CcdRanges;

// Computes the least and greatest F in view i over the box's points at time t.
DRAPE_FUNCTION void ccdRange(const CcdMotion* m, int i, const CcdBox* box, float t, float* low, float* high)
{
    const float u0 = box->m_low[1], u1 = box->m_low[1] + box->m_width[1];
    const float v0 = box->m_low[2], v1 = box->m_low[2] + box->m_width[2];
    const float s = 1.0f - t;
    const float d = s * m->m_d0[i] + t * m->m_d1[i];
    const float e = s * m->m_e0[i] + t * m->m_e1[i];
    const float g = s * m->m_g0[i] + t * m->m_g1[i];
    *low = d - drapeMax(u0 * e, u1 * e) - drapeMax(v0 * g, v1 * g);
    *high = d - drapeMin(u0 * e, u1 * e) - drapeMin(v0 * g, v1 * g);
}

DRAPE_FUNCTION void ccdBounds(const CcdMotion* m, const CcdBox* box, CcdRanges* r)
{
    const float t0 = box->m_low[0], t1 = box->m_low[0] + box->m_width[0];
    for (int i = 0; i < DRAPE_CCD_VIEWS; ++i)
        ccdRange(m, i, box, t0, r->m_low0 + i, r->m_high0 + i);
    for (int i = 0; i < DRAPE_CCD_VIEWS; ++i)
        ccdRange(m, i, box, t1, r->m_low1 + i, r->m_high1 + i);
}

#define DRAPE_CCD_APART 0
#define DRAPE_CCD_OPEN 1
#define DRAPE_CCD_WITHIN 2

// Classifies the box: F provably stays beyond the separation over all of it, or within it (to rounding), or neither.
DRAPE_FUNCTION int ccdTest(const CcdMotion* m, const CcdRanges* r)
{
    int apart = 0;
    for (int i = 0; i < DRAPE_CCD_VIEWS; ++i)
    {
        const float low = drapeMin(r->m_low0[i], r->m_low1[i]), high = drapeMax(r->m_high0[i], r->m_high1[i]);
        apart |= (low > m->m_reach[i]) | (-high > m->m_reach[i]);
    }
    if (apart) return DRAPE_CCD_APART;
    float gaps = 0.0f;
    int within = 1;
    for (int i = 0; i < 3; ++i)
    {
        const float low = drapeMin(r->m_low0[i], r->m_low1[i]), high = drapeMax(r->m_high0[i], r->m_high1[i]);
        const float gap = drapeMax(drapeMax(low, -high) - m->m_slack[i], 0.0f);
        gaps += gap * gap;
        // A cube with this half-width lies in the ball of the separation.
        within = within && drapeMax(-low, high) <= m->m_slack[i] + 0.57735f * m->m_separation;
    }
    // The box of F's values may miss the ball of the separation though not the ball's box. 8 u covers the roundings.
    const float ball = m->m_separation * m->m_separation * 1.0000005f + DRAPE_FLUSH;
    if (m->m_separation > 0.0f && gaps > ball) return DRAPE_CCD_APART;
    return within ? DRAPE_CCD_WITHIN : DRAPE_CCD_OPEN;
}

// Returns whether F stays beyond the separation over the part of the box with u + v ≤ 1, along the view for that
// side.
DRAPE_FUNCTION int ccdBeyondSide(const CcdMotion* m, const CcdBox* box)
{
    const int i = DRAPE_CCD_ALONG_SIDE;
    if (!m->m_triangular) return 0;
    // The part in coordinates u + v and v, see ccdAimAtSide().
    CcdBox part = *box;
    part.m_low[1] = box->m_low[1] + box->m_low[2];
    part.m_width[1] = drapeMin(box->m_width[1] + box->m_width[2], 1.0f - part.m_low[1]);
    float low0, high0, low1, high1;
    ccdRange(m, i, &part, part.m_low[0], &low0, &high0);
    ccdRange(m, i, &part, part.m_low[0] + part.m_width[0], &low1, &high1);
    return drapeMin(low0, low1) > m->m_reach[i] || -drapeMax(high0, high1) > m->m_reach[i];
}

// Returns whether F changes sign in view i between the ends of the box, everywhere: between the ranges at both ends.
DRAPE_FUNCTION int ccdCrosses(float low0, float high0, float low1, float high1, float slack)
{
    return (high0 < -slack && low1 > slack) || (low0 > slack && high1 < -slack);
}

// Computes the ranges in view i at the lower and the upper end of u (or v), over all of t and of the other coordinate.
DRAPE_FUNCTION int ccdCrossesSide(const CcdMotion* m, const CcdBox* box, int i, int axis)
{
    float low[2], high[2];
    for (int end = 0; end < 2; ++end)
    {
        CcdBox side = *box;
        ccdMoveAlong(&side, axis, end ? 1.0f : 0.0f);
        ccdWidenAlong(&side, axis, 0.0f);
        float low1, high1;
        ccdRange(m, i, &side, side.m_low[0], low + end, high + end);
        ccdRange(m, i, &side, side.m_low[0] + side.m_width[0], &low1, &high1);
        low[end] = drapeMin(low[end], low1);
        high[end] = drapeMax(high[end], high1);
    }
    return ccdCrosses(low[0], high[0], low[1], high[1], m->m_slack[i]);
}

// Proves that F vanishes somewhere in the box. Three views that span space each change sign between opposite sides of
// the box (Poincaré and Miranda's theorem). Failure proves nothing.
DRAPE_FUNCTION int ccdHolds(const CcdMotion* m, const CcdBox* box)
{
    const int n = DRAPE_CCD_NORMAL;
    float low0, high0, low1, high1;
    if (!m->m_independent) return 0;
    ccdRange(m, n, box, box->m_low[0], &low0, &high0);
    ccdRange(m, n, box, box->m_low[0] + box->m_width[0], &low1, &high1);
    if (!ccdCrosses(low0, high0, low1, high1, m->m_slack[n])) return 0;
    const float farthest = box->m_low[1] + box->m_width[1] + box->m_low[2] + box->m_width[2];
    if (m->m_triangular && farthest > 1.0f) return 0;
    return ccdCrossesSide(m, box, DRAPE_CCD_ALONG_U, 1) && ccdCrossesSide(m, box, DRAPE_CCD_ALONG_V, 2);
}

DRAPE_NAMESPACE_END

#endif
