// Pairs of features of one cloth that a broad phase lists (kernels/cloth_cloth/self_cull_simd.cl,
// self_traversal_gpu.cl). For kernels only.
#ifndef DRAPE_LIB_SELF_PAIRS_H
#define DRAPE_LIB_SELF_PAIRS_H

#include "../broad_phase/cull_packet.h"
#include "../work_items/simd_group.h"
#include "self_contact.h"
#include "self_cull.h"

// A cloth over the step. start: the end's positions in a discrete step.
typedef struct SelfCloth
{
    __global const Triangle* m_triangles;
    __global const Edge* m_edges;
    __global const float* m_start;
    __global const float* m_end;
    float m_radius, m_thickness;  // m
} SelfCloth;

// Returns whether all nodes of two features are valid, and the features' volumes overlap: see nodeVolumesOverlap().
#if DRAPE_LANES > 1
// Tests one direction per lane, including the axes, as far as rounding cannot change the answer; decides the rest
// with scalars.
static int volumesOverlap(const Vec3 from[4], const Vec3 to[4], const int split, const float radius)
{
    const Directions directions = directionLanes();
    Lanes low[4], high[4], inner = lanesSplat(0.0f), sum = inner;
    DRAPE_UNROLL
    for (int k = 0; k < 4; ++k)
    {
        const Lanes start = lanesDotUniform(directions.m_along, from[k]);
        const Lanes end = lanesDotUniform(directions.m_along, to[k]);
        low[k] = lanesMin(start, end);
        high[k] = lanesMax(start, end);
        sum += lanesAbs(start) + lanesAbs(end);
#if DRAPE_DOP_DIRECTIONS == 7 || DRAPE_DOP_DIRECTIONS == 13
        inner = lanesMax(inner, lanesSplat(drapeMax(vec3Norm1(from[k]), vec3Norm1(to[k]))));  // any two coordinates
#endif
    }
    const Lanes both = lanesMin(low[2], low[3]), bothHigh = lanesMax(high[2], high[3]);
    const Lanes own = split == 2 ? lanesMin(low[0], low[1]) : low[0];
    const Lanes ownHigh = split == 2 ? lanesMax(high[0], high[1]) : high[0];
    const Lanes other = split == 2 ? both : lanesMin(low[1], both);
    const Lanes otherHigh = split == 2 ? bothHigh : lanesMax(high[1], bothHigh);
    const Lanes grown = 2.0f * radius * directions.m_norm;
    const Lanes gap = own - otherHigh, gapOther = other - ownHigh;
    const Lanes pad = DRAPE_SELF_PAD * (grown + inner + lanesAbs(own) + lanesAbs(otherHigh));
    const Lanes padOther = DRAPE_SELF_PAD * (grown + inner + lanesAbs(other) + lanesAbs(ownHigh));
    if (anyLane((gap > grown + pad + directions.m_ignored) | (gapOther > grown + padOther + directions.m_ignored)))
        return 0;
    // If even the sum is not far, all nodes are valid.
    const LaneMask unsure = (gap > grown - pad) | (gapOther > grown - padOther) | lanesNot(sum <= DRAPE_FARTHEST);
    return !anyLane(unsure) || (placesAreValid(from, to) && nodeVolumesOverlap(from, to, split, radius));
}
#else
static int volumesOverlap(const Vec3 from[4], const Vec3 to[4], const int split, const float radius)
{
    return placesAreValid(from, to) && !nodesFarApart(from, to, split, radius) &&
           nodeVolumesOverlap(from, to, split, radius);
}
#endif

// Lists a pair of features that share no node, and whose boxes overlap, if their volumes do. kind: DRAPE_SELF_TEST_NODE
// …; a, b: node and face, or edges.
static void keepPair(DRAPE_GROUP_MEMORY SimdGroup* group, const SelfCloth* cloth, const uint a, const uint b,
                     const uint kind, const TestList* list)
{
    const int edges = kind == DRAPE_SELF_TEST_EDGE;
    uint nodes[4];
    if (edges)
    {
        const Edge e = cloth->m_edges[a], o = cloth->m_edges[b];
        nodes[0] = e.m_vertices[0];
        nodes[1] = e.m_vertices[1];
        nodes[2] = o.m_vertices[0];
        nodes[3] = o.m_vertices[1];
    }
    else
    {
        nodes[0] = a;
        for (int i = 0; i < 3; ++i)
            nodes[1 + i] = cloth->m_triangles[b].m_vertices[i];
    }
    Vec3 from[4], to[4];
    for (int k = 0; k < 4; ++k)
    {
        from[k] = vec3Load(cloth->m_start, nodes[k]);
        to[k] = vec3Load(cloth->m_end, nodes[k]);
    }
    if (!volumesOverlap(from, to, edges ? 2 : 1, cloth->m_radius)) return;
    FeatureTest test;
    test.m_cloth = a;
    test.m_lane = b;
    test.m_reach = cloth->m_thickness;
    test.m_motion = kind;
    simdKeep(group, list, test);
}

#endif
