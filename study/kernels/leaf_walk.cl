// A walk of a cloth's triangles through an obstacle's tree, each from the root: what a tree of any shape costs to walk.
#include "lib/candidate_list.h"
#include "lib/traversal.h"

// Candidates a work-item gathers before it reserves room for them with one atomic.
#define DRAPE_GATHER 16
// A step takes one node and leaves at most four: enough for a 4-wide tree of 24 heights, or a binary one of 48, more
// than builders make, and for a bundle of 16 leaves.
#define DRAPE_LEAF_STACK 96

// A work-item is a cloth triangle, whose volume has its number. counters->m_candidates must be zero before.
__kernel void leafWalk(__global const BvhNode* restrict volumes, const uint count,
                       __global const BvhNode* restrict nodes, __global const uint* restrict order, const uint root,
                       __global Candidate* restrict candidates, __global TraversalCounters* restrict counters,
                       const uint capacity)
{
    const uint triangle = get_global_id(0);
    if (triangle >= count) return;
    Candidate gathered[DRAPE_GATHER];
    uint gatheredCount = 0;
    uint stack[DRAPE_LEAF_STACK];
    uint depth = 1;
    stack[0] = root;
    while (depth > 0)
    {
        __global const BvhNode* node = nodes + stack[--depth];
        if (!nodesOverlap(volumes + triangle, node)) continue;
        if (node->m_count > 0)
        {
            for (uint i = 0; i < node->m_count; ++i)
                stack[depth++] = node->m_first + i;
            continue;
        }
        gathered[gatheredCount].m_cloth = triangle;
        gathered[gatheredCount++].m_obstacle = order[node->m_first];
        if (gatheredCount < DRAPE_GATHER) continue;
        if (!flushCandidates(candidates, counters, capacity, UINT_MAX, gathered, gatheredCount)) return;
        gatheredCount = 0;
    }
    flushCandidates(candidates, counters, capacity, UINT_MAX, gathered, gatheredCount);
}
