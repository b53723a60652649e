// Refit: recomputes the volumes of a hierarchy whose topology stays. Nodes lie by height, the root last.
#include "../lib/dop.h"

// A work-item is a leaf, whose node has its number. Reads the triangle's vertices at the step's start and end, writes the leaf's
// volume, grown by the mesh's radius (m). A negative radius takes the mesh out of the step: its leaves get empty volumes.
// Positions that are invalid (positionIsValid) are counted by the triangle that owns the vertex. counters must be zero before;
// its atomic only counts.
__kernel void refitLeaves(__global BvhNode* restrict nodes, __global const uint* restrict order,
                          __global const Triangle* restrict triangles,
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
    dopStore(nodes + leaf, &dop);
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
