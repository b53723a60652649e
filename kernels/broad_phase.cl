// Broad phase: triangle pairs whose volumes overlap, by traversal of both hierarchies at once.
#include "lib/dop.h"

// Candidates a work-item gathers before it reserves room for them with one atomic.
#define DRAPE_GATHER 16

// Moves gathered candidates to the list. The demand counts on past the capacity; what does not fit is not written, and the
// host repeats the step with a larger list. Returns 0 when more than limit were counted: then the traversal may end, since
// the step is over its limit whatever follows, and a count that ran on could wrap around.
static int flushCandidates(__global Candidate* restrict candidates, __global StepCounters* restrict counters,
                            const uint capacity, const uint limit, const Candidate* gathered, const uint count)
{
    const uint place = atomic_add(&counters->m_candidates, count);
    for (uint i = 0; i < count; ++i)
    {
        if (place + i < capacity) candidates[place + i] = gathered[i];
    }
    return place < limit;
}

// A work-item is a pair of subtrees: one of clothCount nodes from clothFirst, one of obstacleCount nodes from obstacleFirst,
// each a whole height of its hierarchy, so that few triangles still fill a wide device. thickness holds cloths × obstacles
// values, negative where the pair is not tested. counters->m_candidates must be zero before; its atomic reserves disjoint
// ranges, whose order does not matter. Up to limit candidates the count is exact; beyond it only says that there are more.
__kernel void broadPhaseTraverse(__global const BvhNode* restrict clothNodes, __global const uint* restrict clothOrder,
                                 __global const Triangle* restrict clothTriangles, const uint clothFirst,
                                 const uint clothCount, __global const BvhNode* restrict obstacleNodes,
                                 __global const uint* restrict obstacleOrder,
                                 __global const Triangle* restrict obstacleTriangles, const uint obstacleFirst,
                                 const uint obstacleCount, __global const float* restrict thickness,
                                 const uint obstacleMeshes, __global Candidate* restrict candidates,
                                 __global StepCounters* restrict counters, const uint capacity, const uint limit)
{
    const uint item = get_global_id(0);
    if (item >= clothCount * obstacleCount) return;
    Candidate gathered[DRAPE_GATHER];
    uint gatheredCount = 0;
    uint clothStack[DRAPE_STACK_DEPTH];
    uint obstacleStack[DRAPE_STACK_DEPTH];
    uint depth = 1;
    clothStack[0] = clothFirst + item % clothCount;
    obstacleStack[0] = obstacleFirst + item / clothCount;
    while (depth > 0)
    {
        --depth;
        const uint a = clothStack[depth];
        const uint b = obstacleStack[depth];
        __global const BvhNode* clothNode = clothNodes + a;
        __global const BvhNode* obstacleNode = obstacleNodes + b;
        if (!nodesOverlap(clothNode, obstacleNode)) continue;
        if (clothNode->m_count == 0 && obstacleNode->m_count == 0)
        {
            Candidate candidate;
            candidate.m_cloth = clothOrder[clothNode->m_first];
            candidate.m_obstacle = obstacleOrder[obstacleNode->m_first];
            const uint clothMesh = clothTriangles[candidate.m_cloth].m_mesh;
            const uint obstacleMesh = obstacleTriangles[candidate.m_obstacle].m_mesh;
            if (thickness[clothMesh * obstacleMeshes + obstacleMesh] < 0.0f) continue;
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
    if (gatheredCount > 0) flushCandidates(candidates, counters, capacity, limit, gathered, gatheredCount);
}
