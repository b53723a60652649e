// Broad phase by leaves: every cloth triangle walks the obstacles' hierarchy from its root.
#include "lib/candidate_list.h"
#include "lib/traversal.h"

// Candidates a work-item gathers before it reserves room for them with one atomic.
#define DRAPE_GATHER 16
// A step takes one node and leaves at most four: enough for a 4-wide hierarchy of 24 heights, or a binary one of 48, more
// than builders make, and for a bundle of 16 leaves.
#define DRAPE_LEAF_STACK 96

// A work-item is a cloth leaf; leafNodes names its node. counters->m_candidates must be zero before.
__kernel void broadPhaseLeaves(__global const BvhNode* restrict clothNodes, __global const uint* restrict clothOrder,
                               __global const Triangle* restrict clothTriangles, __global const uint* restrict leafNodes,
                               const uint leafCount, __global const BvhNode* restrict obstacleNodes,
                               __global const uint* restrict obstacleOrder,
                               __global const Triangle* restrict obstacleTriangles, const uint obstacleRoot,
                               __global const float* restrict thickness, const uint obstacleMeshes,
                               __global Candidate* restrict candidates, __global StepCounters* restrict counters,
                               const uint capacity, const uint limit)
{
    const uint leaf = get_global_id(0);
    if (leaf >= leafCount) return;
    __global const BvhNode* clothNode = clothNodes + leafNodes[leaf];
    Candidate gathered[DRAPE_GATHER];
    uint gatheredCount = 0;
    uint visits = 0;
    uint stack[DRAPE_LEAF_STACK];
    uint depth = 1;
    stack[0] = obstacleRoot;
    while (depth > 0)
    {
        __global const BvhNode* node = obstacleNodes + stack[--depth];
        ++visits;
        if (!nodesOverlap(clothNode, node)) continue;
        if (node->m_count > 0)
        {
            for (uint i = 0; i < node->m_count; ++i) stack[depth++] = node->m_first + i;
            continue;
        }
        Candidate candidate;
        candidate.m_cloth = clothOrder[clothNode->m_first];
        candidate.m_obstacle = obstacleOrder[node->m_first];
        if (!meshesPaired(candidate, clothTriangles, obstacleTriangles, thickness, obstacleMeshes)) continue;
        gathered[gatheredCount++] = candidate;
        if (gatheredCount < DRAPE_GATHER) continue;
        if (!flushCandidates(candidates, counters, capacity, limit, gathered, gatheredCount)) return;
        gatheredCount = 0;
    }
    flushCandidates(candidates, counters, capacity, limit, gathered, gatheredCount);
    DRAPE_VISITS(counters, visits);
}
