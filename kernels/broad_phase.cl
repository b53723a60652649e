// Broad phase: triangle pairs whose volumes overlap, by leaf-parallel traversal of the obstacles' hierarchy.
#include "lib/dop.h"

// Candidates a work-item gathers before it reserves room for them with one atomic.
#define DRAPE_GATHER 16

// Moves gathered candidates to the list. The demand counts on past the capacity; what does not fit is not written, and the
// host repeats the step with a larger list.
static void flushCandidates(__global Candidate* restrict candidates, __global StepCounters* restrict counters,
                            const uint capacity, const uint cloth, const uint* obstacles, const uint count)
{
    const uint place = atomic_add(&counters->m_candidates, count);
    for (uint i = 0; i < count; ++i)
    {
        if (place + i < capacity)
        {
            candidates[place + i].m_cloth = cloth;
            candidates[place + i].m_obstacle = obstacles[i];
        }
    }
}

// A work-item is a cloth leaf below one of startCount subtrees of the obstacles' hierarchy (nodes startFirst …), so that few
// cloth triangles still fill a wide device. thickness holds cloths × obstacles values, negative where the pair is not
// tested. counters->m_candidates must be zero before; its atomic reserves disjoint ranges, whose order does not matter.
__kernel void broadPhaseTraverse(__global const BvhNode* restrict clothNodes, __global const uint* restrict clothOrder,
                                 __global const Triangle* restrict clothTriangles, const uint clothLeaves,
                                 __global const BvhNode* restrict obstacleNodes,
                                 __global const uint* restrict obstacleOrder,
                                 __global const Triangle* restrict obstacleTriangles, const uint startFirst,
                                 const uint startCount, __global const float* restrict thickness,
                                 const uint obstacleMeshes, __global Candidate* restrict candidates,
                                 __global StepCounters* restrict counters, const uint capacity)
{
    const uint item = get_global_id(0);
    if (item >= clothLeaves * startCount) return;
    const uint leaf = item % clothLeaves;
    Dop dop;
    dopLoad(&dop, clothNodes + leaf);
    const uint cloth = clothOrder[leaf];
    __global const float* pairs = thickness + clothTriangles[cloth].m_mesh * obstacleMeshes;

    uint gathered[DRAPE_GATHER];
    uint gatheredCount = 0;
    uint stack[DRAPE_STACK_DEPTH];
    uint depth = 0;
    stack[depth++] = startFirst + item / clothLeaves;
    while (depth > 0)
    {
        const uint index = stack[--depth];
        __global const BvhNode* node = obstacleNodes + index;
        if (!dopOverlaps(&dop, node)) continue;
        const uint first = node->m_first;
        const uint count = node->m_count;
        if (count > 0)
        {
            for (uint i = count; i > 0; --i) stack[depth++] = first + i - 1;
            continue;
        }
        const uint obstacle = obstacleOrder[first];
        if (pairs[obstacleTriangles[obstacle].m_mesh] < 0.0f) continue;
        gathered[gatheredCount++] = obstacle;
        if (gatheredCount == DRAPE_GATHER)
        {
            flushCandidates(candidates, counters, capacity, cloth, gathered, gatheredCount);
            gatheredCount = 0;
        }
    }
    if (gatheredCount > 0) flushCandidates(candidates, counters, capacity, cloth, gathered, gatheredCount);
}
