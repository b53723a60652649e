// Broad phase: triangle pairs whose volumes overlap, by traversal of both hierarchies at once.
#include "lib/candidate_list.h"
#include "lib/dop.h"

// Candidates a work-item gathers before it reserves room for them with one atomic.
#define DRAPE_GATHER 16
// A step opens one node of a pair and leaves the other children behind: three in two 4-wide hierarchies of 24 heights, one in
// two binary ones of 48, more than builders make.
#define DRAPE_PAIR_STACK 160

// A work-item is a pair of subtrees; starts holds enough of them that few triangles still fill a wide device.
// counters->m_candidates must be zero before; up to limit candidates the count is exact, beyond it only says that there are
// more.
__kernel void broadPhaseTraverse(__global const BvhNode* restrict clothNodes, __global const uint* restrict clothOrder,
                                 __global const Triangle* restrict clothTriangles,
                                 __global const BvhNode* restrict obstacleNodes,
                                 __global const uint* restrict obstacleOrder,
                                 __global const Triangle* restrict obstacleTriangles,
                                 __global const NodePair* restrict starts, const uint startCount,
                                 __global const float* restrict thickness, const uint obstacleMeshes,
                                 __global Candidate* restrict candidates, __global StepCounters* restrict counters,
                                 const uint capacity, const uint limit)
{
    const uint item = get_global_id(0);
    if (item >= startCount) return;
    Candidate gathered[DRAPE_GATHER];
    uint gatheredCount = 0;
    uint visits = 0;
    uint clothStack[DRAPE_PAIR_STACK];
    uint obstacleStack[DRAPE_PAIR_STACK];
    uint depth = 1;
    clothStack[0] = starts[item].m_cloth;
    obstacleStack[0] = starts[item].m_obstacle;
    while (depth > 0)
    {
        --depth;
        const uint a = clothStack[depth];
        const uint b = obstacleStack[depth];
        __global const BvhNode* clothNode = clothNodes + a;
        __global const BvhNode* obstacleNode = obstacleNodes + b;
        ++visits;
        if (!nodesOverlap(clothNode, obstacleNode)) continue;
        if (clothNode->m_count == 0 && obstacleNode->m_count == 0)
        {
            Candidate candidate;
            candidate.m_cloth = clothOrder[clothNode->m_first];
            candidate.m_obstacle = obstacleOrder[obstacleNode->m_first];
            if (!meshesPaired(candidate, clothTriangles, obstacleTriangles, thickness, obstacleMeshes)) continue;
            gathered[gatheredCount++] = candidate;
            if (gatheredCount == DRAPE_GATHER)
            {
                if (!flushCandidates(candidates, counters, capacity, limit, gathered, gatheredCount)) return;
                gatheredCount = 0;
            }
            continue;
        }
        const int openCloth = opensFirst(clothNode, obstacleNode);
        const uint first = openCloth ? clothNode->m_first : obstacleNode->m_first;
        const uint count = openCloth ? clothNode->m_count : obstacleNode->m_count;
        for (uint child = first; child < first + count; ++child)
        {
            clothStack[depth] = openCloth ? child : a;
            obstacleStack[depth] = openCloth ? b : child;
            ++depth;
        }
    }
    flushCandidates(candidates, counters, capacity, limit, gathered, gatheredCount);
    DRAPE_VISITS(counters, visits);
}
