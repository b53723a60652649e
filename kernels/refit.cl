// Refit: recomputes the volumes of a hierarchy whose topology stays. Nodes lie by height, the root last.
#include "lib/rigid_motion.h"

// A work-item is a leaf; leafNodes names its node. Reads the triangle's vertices at the step's start and end, writes the leaf's
// volume, grown by the mesh's radius (m). A negative radius takes the mesh out of the step: its leaves get empty volumes.
// Positions that are invalid (positionIsValid) are counted by the triangle that owns the vertex. counters must be zero before;
// its atomic only counts.
__kernel void refitLeaves(__global BvhNode* restrict nodes, __global const uint* restrict leafNodes,
                          __global const uint* restrict order, __global const Triangle* restrict triangles,
                          __global const float* restrict start, __global const float* restrict end,
                          __global const float* restrict meshRadius, __global StepCounters* restrict counters,
                          const uint leafCount)
{
    const uint leaf = get_global_id(0);
    if (leaf >= leafCount) return;
    __global const Triangle* triangle = triangles + order[leaf];
    const float radius = meshRadius[triangle->m_mesh];
    Dop dop;
    const uint invalid = leafVolume(&dop, triangle, start, end, radius);
    if (invalid > 0) atomic_add(&counters->m_invalidNodes, invalid);
    dopStore(nodes + leafNodes[leaf], &dop);
}

// A work-item is a leaf of the cloths, after refitLeaves. Grows it by the paths that moving obstacles see, so that every pair
// is found whose features come near each other in the obstacle's frame. thickness: m, cloths × obstacles.
__kernel void refitMovingLeaves(__global BvhNode* restrict nodes, __global const uint* restrict leafNodes,
                                __global const uint* restrict order, __global const Triangle* restrict triangles,
                                __global const float* restrict start, __global const float* restrict end,
                                __global const float* restrict meshRadius,
                                __global const ObstacleMotion* restrict motions, const uint motionCount,
                                __global const float* restrict thickness, const uint obstacleMeshes,
                                const uint leafCount)
{
    const uint leaf = get_global_id(0);
    if (leaf >= leafCount) return;
    __global const Triangle* triangle = triangles + order[leaf];
    const float radius = meshRadius[triangle->m_mesh];
    if (radius < 0.0f) return;
    growByMotions(nodes + leafNodes[leaf], motions, motionCount, thickness + triangle->m_mesh * obstacleMeshes, triangle, start,
                  end, radius);
}

// A work-item is a node of one height. Its children were written by the launch before.
__kernel void refitLevel(__global BvhNode* restrict nodes, const uint first, const uint count)
{
    const uint i = get_global_id(0);
    if (i < count) dopMergeChildren(nodes, first + i);
}

// One work-group climbs the heights that are too small for a launch each. levels holds levelCount pairs (first node, node
// count), lowest first. The barrier orders a height's writes before the next one's reads: all are of this group.
__kernel void refitTop(__global BvhNode* nodes, __global const uint* restrict levels, const uint levelCount)
{
    for (uint level = 0; level < levelCount; ++level)
    {
        const uint first = levels[2 * level];
        const uint count = levels[2 * level + 1];
        for (uint i = get_local_id(0); i < count; i += get_local_size(0)) dopMergeChildren(nodes, first + i);
        barrier(CLK_GLOBAL_MEM_FENCE);
    }
}
