// k-DOP volumes: intervals along k/2 directions, nine in the product. Leaves are padded for every rounding; merging is
// exact.
#ifndef DRAPE_LIB_DOP_H
#define DRAPE_LIB_DOP_H

#include "finite_corners.h"

DRAPE_NAMESPACE_BEGIN

// Directions: the axes; then x+y x+z y+z x-y x-z y-z for 18 and 26 sides; then x+y+z x+y-z x-y+z x-y-z for 14 and 26.
#define DRAPE_DOP_EDGES (DRAPE_DOP_DIRECTIONS >= 9 ? 6 : 0)

// √2 and √3 rounded up: lengths of the diagonal directions.
#define DRAPE_DIAGONAL 1.4142137f
#define DRAPE_SPACE_DIAGONAL 1.7320509f
// Smallest normal float, added to a pad so that flushed denormals cannot shrink a volume.
#define DRAPE_TINY 1.17549435e-38f
// 2^-23, see dopGrowInterval().
#define DRAPE_DOP_PAD 1.1920929e-7f

typedef struct Dop
{
    float m_low[DRAPE_DOP_DIRECTIONS];
    float m_high[DRAPE_DOP_DIRECTIONS];
} Dop;

DRAPE_FUNCTION void dopClear(Dop* dop)
{
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        dop->m_low[i] = DRAPE_INFINITY;
        dop->m_high[i] = -DRAPE_INFINITY;
    }
}

// Length of a direction, rounded up.
DRAPE_FUNCTION float dopNorm(int i)
{
    return i < 3 ? 1.0f : i < 3 + DRAPE_DOP_EDGES ? DRAPE_DIAGONAL : DRAPE_SPACE_DIAGONAL;
}

// p along a direction, rounded.
DRAPE_FUNCTION float dopProject(Vec3 p, int i)
{
    if (i < 3) return i == 0 ? p.x : i == 1 ? p.y : p.z;
    if (i < 3 + DRAPE_DOP_EDGES)
    {
        const int pair = (i - 3) % 3;
        const float first = pair == 2 ? p.y : p.x;
        const float second = pair == 0 ? p.y : p.z;
        return i < 6 ? first + second : first - second;
    }
    const int corner = i - 3 - DRAPE_DOP_EDGES;
    const float sum = corner < 2 ? p.x + p.y : p.x - p.y;
    return corner % 2 == 0 ? sum + p.z : sum - p.z;
}

// |x| + |y| where a direction's projection has three terms, else 0: bounds the rounding of the first sum.
DRAPE_FUNCTION float dopInner(Vec3 p, int i)
{
    return i < 3 + DRAPE_DOP_EDGES ? 0.0f : drapeAbs(p.x) + drapeAbs(p.y);
}

// Grows an interval along a direction to contain the balls of radius r around some points. The points' projections lie
// in [least, greatest], and their inner sums are at most `inner`; reach is r times the direction's length.
//
// With u = 2^-24 the projection v of a point errs by at most u |v| for two terms, and by u·inner more for three; the
// shift s = v ∓ reach errs by u |s|. The pad 2^-23 (|v| + |s|) covers these and its own rounding. It is enough to pad
// the outermost projections: v - u |v| rises with v.
DRAPE_FUNCTION void dopGrowInterval(float* low, float* high, float least, float greatest, float reach, float inner)
{
    const float pad = DRAPE_DOP_PAD;
    const float from = least - reach;
    const float to = greatest + reach;
    *low = drapeMin(*low, from - (pad * (drapeAbs(least) + inner + drapeAbs(from)) + DRAPE_TINY));
    *high = drapeMax(*high, to + (pad * (drapeAbs(greatest) + inner + drapeAbs(to)) + DRAPE_TINY));
}

// Grows the volume to contain the ball of the given radius (m, ≥ 0) around p.
DRAPE_FUNCTION void dopAddPoint(Dop* dop, Vec3 p, float radius)
{
    DRAPE_UNROLL
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        const float v = dopProject(p, i);
        dopGrowInterval(dop->m_low + i, dop->m_high + i, v, v, radius * dopNorm(i), dopInner(p, i));
    }
}

DRAPE_FUNCTION void dopStore(DRAPE_GLOBAL BvhNode* node, const Dop* dop)
{
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        node->m_low[i] = dop->m_low[i];
        node->m_high[i] = dop->m_high[i];
    }
}

// Recomputes the volume of an inner node from its children; a leaf stays.
DRAPE_FUNCTION void dopMergeChildren(DRAPE_GLOBAL BvhNode* nodes, DRAPE_UINT index)
{
    DRAPE_GLOBAL BvhNode* node = nodes + index;
    Dop dop;
    if (node->m_count == 0u) return;
    dopClear(&dop);
    for (DRAPE_UINT child = node->m_first; child < node->m_first + node->m_count; ++child)
    {
        for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
        {
            dop.m_low[i] = drapeMin(dop.m_low[i], nodes[child].m_low[i]);
            dop.m_high[i] = drapeMax(dop.m_high[i], nodes[child].m_high[i]);
        }
    }
    dopStore(node, &dop);
}

// Returns whether the nodes are not proved separate. An empty volume (+∞, -∞) overlaps nothing; volumes never hold
// NaN (see triangleVolume).
DRAPE_FUNCTION int nodesOverlap(const DRAPE_GLOBAL BvhNode* a, const DRAPE_GLOBAL BvhNode* b)
{
    int separate = 0;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        separate |= (a->m_low[i] > b->m_high[i]) | (a->m_high[i] < b->m_low[i]);
    }
    return !separate;
}

DRAPE_FUNCTION float nodeExtent(const DRAPE_GLOBAL BvhNode* node)
{
    return (node->m_high[0] - node->m_low[0]) + (node->m_high[1] - node->m_low[1]) + (node->m_high[2] - node->m_low[2]);
}

// Returns whether a traversal opens a, for two overlapping nodes that are not both leaves: the larger one, so that
// both sides shrink together.
DRAPE_FUNCTION int opensFirst(const DRAPE_GLOBAL BvhNode* a, const DRAPE_GLOBAL BvhNode* b)
{
    if (a->m_count == 0) return 0;
    return b->m_count == 0 || nodeExtent(a) > nodeExtent(b);
}

// Computes the interval of a triangle's volume along direction i, see cornersVolume().
DRAPE_FUNCTION void cornersInterval(const Vec3* p, int i, int moves, float radius, float* low, float* high)
{
    float least = dopProject(p[0], i);
    float greatest = least;
    float inner = dopInner(p[0], i);
    DRAPE_UNROLL
    for (int k = 1; k < 6; ++k)
    {
        if (k >= 3 && !moves) break;
        const float v = dopProject(p[k], i);
        least = drapeMin(least, v);
        greatest = drapeMax(greatest, v);
        inner = drapeMax(inner, dopInner(p[k], i));
    }
    *low = DRAPE_INFINITY;
    *high = -DRAPE_INFINITY;
    dopGrowInterval(low, high, least, greatest, radius * dopNorm(i), inner);
}

// Computes the volume of a triangle over a step of linear motion, grown by the radius. p: its corners at the step's
// start, then at its end; without `moves` only the first three count. The volume excludes invalid corners
// (positionIsValid): one bad node cannot make every ancestor overlap everything, and the other corners' features are
// still found (see finite_corners.h). Without a valid corner the volume is empty. Returns whether all corners are
// valid.
DRAPE_FUNCTION int cornersVolume(Dop* dop, Vec3* p, int moves, float radius)
{
    const DRAPE_UINT valid = replaceInvalidCorners(p, p + 3);
    dopClear(dop);
    if (valid == 0u) return 0;
    DRAPE_UNROLL
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
        cornersInterval(p, i, moves, radius, dop->m_low + i, dop->m_high + i);
    return valid == DRAPE_ALL_FEATURES;
}

// Computes the volume of the positions at the step's start and end. Both may be the same array, which takes half the
// time.
DRAPE_FUNCTION int triangleVolume(Dop* dop, const DRAPE_GLOBAL Triangle* triangle, const DRAPE_GLOBAL float* start,
                                  const DRAPE_GLOBAL float* end, float radius)
{
    Vec3 p[6];
    const int moves = start != end;
    for (int k = 0; k < 3; ++k)
    {
        p[k] = vec3Load(start, triangle->m_vertices[k]);
        p[3 + k] = moves ? vec3Load(end, triangle->m_vertices[k]) : p[k];
    }
    return cornersVolume(dop, p, moves, radius);
}

// Computes a leaf's volume for a step. A negative radius excludes the triangle's mesh from the step: the volume is
// empty. Returns how many vertices are NaN or infinite, counted by the triangle that owns them.
DRAPE_FUNCTION DRAPE_UINT leafVolume(Dop* dop, const DRAPE_GLOBAL Triangle* triangle, const DRAPE_GLOBAL float* start,
                                     const DRAPE_GLOBAL float* end, float radius)
{
    DRAPE_UINT invalid = 0;
    if (radius < 0.0f)
    {
        dopClear(dop);
        return 0;
    }
    if (triangleVolume(dop, triangle, start, end, radius)) return 0;
    for (int i = 0; i < 3; ++i)
    {
        const DRAPE_UINT vertex = triangle->m_vertices[i];
        if ((triangle->m_owned & DRAPE_OWNS_VERTEX(i)) &&
            !(positionIsValid(vec3Load(start, vertex)) && positionIsValid(vec3Load(end, vertex))))
        {
            ++invalid;
        }
    }
    return invalid;
}

DRAPE_NAMESPACE_END

#endif
