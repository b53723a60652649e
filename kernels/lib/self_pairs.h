// Pairs of features of one cloth that a device's broad phase lists (kernels/self_cull.cl, self_walk.cl). For OpenCL C only.
#ifndef DRAPE_LIB_SELF_PAIRS_H
#define DRAPE_LIB_SELF_PAIRS_H

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
    if (!nodeVolumesOverlap(cloth->m_start, cloth->m_end, nodes, edges ? 2 : 1, cloth->m_radius)) return;
    FeatureTest test;
    test.m_cloth = a;
    test.m_lane = b;
    test.m_reach = cloth->m_thickness;
    test.m_motion = kind;
    teamKeep(team, list, test);
}

#endif
