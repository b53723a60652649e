// 18-DOP volumes: intervals along nine directions. Leaves are padded for every rounding; merging is exact.
#ifndef DRAPE_LIB_DOP_H
#define DRAPE_LIB_DOP_H

#include "../shared/mesh.h"
#include "vec3.h"

DRAPE_NAMESPACE_BEGIN

// √2 rounded up: the length of the six diagonal directions.
#define DRAPE_DIAGONAL 1.4142137f
// Smallest normal float, added to a pad so that flushed denormals cannot shrink a volume.
#define DRAPE_TINY 1.17549435e-38f
#define DRAPE_INFINITY (1.0f / 0.0f)

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

// Grows one interval by the ball of radius r·norm around the projection v. With u = 2^-24 the projection of a point
// errs by at most 2^-23 |v| … and the shift by u |s|; the pad 2^-23 (|v| + |s|) covers both and the pad's own rounding.
DRAPE_FUNCTION void dopAddProjection(Dop* dop, int i, float v, float reach)
{
    const float pad = 1.1920929e-7f;  // 2^-23
    const float low = v - reach;
    const float high = v + reach;
    dop->m_low[i] = drapeMin(dop->m_low[i], low - (pad * (drapeAbs(v) + drapeAbs(low)) + DRAPE_TINY));
    dop->m_high[i] = drapeMax(dop->m_high[i], high + (pad * (drapeAbs(v) + drapeAbs(high)) + DRAPE_TINY));
}

// Grows the volume to hold the ball of the given radius (m, ≥ 0) around p.
DRAPE_FUNCTION void dopAddPoint(Dop* dop, Vec3 p, float radius)
{
    const float diagonal = radius * DRAPE_DIAGONAL;
    dopAddProjection(dop, 0, p.x, radius);
    dopAddProjection(dop, 1, p.y, radius);
    dopAddProjection(dop, 2, p.z, radius);
    dopAddProjection(dop, 3, p.x + p.y, diagonal);
    dopAddProjection(dop, 4, p.x + p.z, diagonal);
    dopAddProjection(dop, 5, p.y + p.z, diagonal);
    dopAddProjection(dop, 6, p.x - p.y, diagonal);
    dopAddProjection(dop, 7, p.x - p.z, diagonal);
    dopAddProjection(dop, 8, p.y - p.z, diagonal);
}

DRAPE_FUNCTION void dopStore(DRAPE_GLOBAL BvhNode* node, const Dop* dop)
{
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        node->m_low[i] = dop->m_low[i];
        node->m_high[i] = dop->m_high[i];
    }
}

// Recomputes the volume of an inner node from its children.
DRAPE_FUNCTION void dopMergeChildren(DRAPE_GLOBAL BvhNode* nodes, DRAPE_UINT index)
{
    DRAPE_GLOBAL BvhNode* node = nodes + index;
    Dop dop;
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

// Not proved separate. An empty volume (+∞, -∞) overlaps nothing; volumes never hold NaN (see triangleVolume).
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

// Of two overlapping nodes that are not both leaves, whether a traversal opens a: the larger one, so that both sides
// shrink together.
DRAPE_FUNCTION int opensFirst(const DRAPE_GLOBAL BvhNode* a, const DRAPE_GLOBAL BvhNode* b)
{
    if (a->m_count == 0) return 0;
    return b->m_count == 0 || nodeExtent(a) > nodeExtent(b);
}

// Volume of a triangle over a step of linear motion, grown by the radius. Invalid corners (positionIsValid) stay out of
// it, so that one bad node cannot make every ancestor overlap everything and features of the others are still found
// (see finite_corners.h); without a valid corner the volume is empty. start and end may be the same array.
DRAPE_FUNCTION void triangleVolume(Dop* dop, const DRAPE_GLOBAL Triangle* triangle, const DRAPE_GLOBAL float* start,
                                   const DRAPE_GLOBAL float* end, float radius)
{
    dopClear(dop);
    for (int i = 0; i < 3; ++i)
    {
        const Vec3 p0 = vec3Load(start, triangle->m_vertices[i]);
        const Vec3 p1 = vec3Load(end, triangle->m_vertices[i]);
        if (!positionIsValid(p0) || !positionIsValid(p1)) continue;
        dopAddPoint(dop, p0, radius);
        dopAddPoint(dop, p1, radius);
    }
}

DRAPE_NAMESPACE_END

#endif
