// Pairs of features of one cloth that a device's broad phase lists (kernels/self_cull.cl, self_walk.cl). For OpenCL C only.
#ifndef DRAPE_LIB_SELF_PAIRS_H
#define DRAPE_LIB_SELF_PAIRS_H

#include "cull_packet.h"
#include "self_contact.h"
#include "self_cull.h"
#include "team.h"

// A cloth over the step. start: the end's positions in a discrete step.
typedef struct SelfCloth
{
    __global const Triangle* m_triangles;
    __global const Edge* m_edges;
    __global const float* m_start;
    __global const float* m_end;
    float m_radius, m_thickness;  // m
} SelfCloth;

#if DRAPE_LANES > 1
// nodesFarApart() with a lane for each direction, the axes among them.
static int nodesApart(const Vec3 from[4], const Vec3 to[4], const int split, const float radius)
{
    const Directions directions = directionLanes();
    Lanes low[4], high[4], inner = lanesSplat(0.0f);
    DRAPE_UNROLL
    for (int k = 0; k < 4; ++k)
    {
        const Lanes start = lanesDotUniform(directions.m_along, from[k]);
        const Lanes end = lanesDotUniform(directions.m_along, to[k]);
        low[k] = lanesMin(start, end);
        high[k] = lanesMax(start, end);
#if DRAPE_DOP_DIRECTIONS == 7 || DRAPE_DOP_DIRECTIONS == 13
        inner = lanesMax(inner, lanesSplat(drapeMax(vec3Norm1(from[k]), vec3Norm1(to[k]))));  // of any two coordinates
#endif
    }
    const Lanes own = split == 2 ? lanesMin(low[0], low[1]) : low[0];
    const Lanes ownHigh = split == 2 ? lanesMax(high[0], high[1]) : high[0];
    const Lanes both = lanesMin(low[2], low[3]), bothHigh = lanesMax(high[2], high[3]);
    const Lanes other = split == 2 ? both : lanesMin(low[1], both);
    const Lanes otherHigh = split == 2 ? bothHigh : lanesMax(high[1], bothHigh);
    const Lanes grown = 2.0f * radius * directions.m_norm;
    const Lanes most = grown + DRAPE_SELF_PAD * (grown + inner) + directions.m_ignored;
    return anyLane((own - otherHigh > most + DRAPE_SELF_PAD * (lanesAbs(own) + lanesAbs(otherHigh))) |
                   (other - ownHigh > most + DRAPE_SELF_PAD * (lanesAbs(other) + lanesAbs(ownHigh))));
}
#else
#define nodesApart(from, to, split, radius) nodesFarApart(from, to, split, radius)
#endif

// Lists a pair whose boxes overlap if the features share no vertex and their volumes overlap. kind: DRAPE_SELF_TEST_NODE …;
// a, b: node and face, or edges.
static void keepPair(DRAPE_TEAM Team* team, const SelfCloth* cloth, const uint a, const uint b, const uint kind,
                     const TestList* list)
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
        for (int i = 0; i < 3; ++i) nodes[1 + i] = cloth->m_triangles[b].m_vertices[i];
    }
    // Two nodes of a feature differ.
    if (nodes[0] == nodes[1] || nodes[0] == nodes[2] || nodes[0] == nodes[3] || nodes[1] == nodes[2] || nodes[1] == nodes[3])
        return;
    Vec3 from[4], to[4];
    const int split = edges ? 2 : 1;
    if (!loadNodes(cloth->m_start, cloth->m_end, nodes, from, to) || nodesApart(from, to, split, cloth->m_radius) ||
        !nodeVolumesOverlap(from, to, split, cloth->m_radius))
        return;
    FeatureTest test;
    test.m_cloth = a;
    test.m_lane = b;
    test.m_reach = cloth->m_thickness;
    test.m_motion = kind;
    teamKeep(team, list, test);
}

#endif
