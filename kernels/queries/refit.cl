// Refit: recomputes the volumes of a hierarchy whose topology stays. Nodes lie by height, the root last.
#include "../lib/geometry/dop.h"
#include "queries_bindings.h"

// A work-item is a leaf, whose node has its number. Reads the triangle's vertices at the step's start and end, writes
// the leaf's volume, grown by the mesh's radius (m). A negative radius takes the mesh out of the step: its leaves get
// empty volumes. Positions that are invalid (positionIsValid) are counted by the triangle that owns the vertex.
// counters must be zero before; its atomic only counts.
__kernel void refitLeaves(DRAPE_REFIT_LEAVES)
{
    const uint leaf = get_global_id(0);
    if (leaf >= leaves.m_count) return;
    __global const Triangle* triangle = triangles + order[leaf];
    const float radius = meshRadius[triangle->m_mesh];
    Dop dop;
    const uint invalid = leafVolume(&dop, triangle, start, end, radius);
    if (invalid > 0) atomic_add(&counters->m_invalidNodes, invalid);
    dopStore(nodes + leaf, &dop);
}

// A work-item is a node of one height. Its children were written by the launch before.
__kernel void refitLevel(DRAPE_REFIT_LEVEL)
{
    const uint i = get_global_id(0);
    if (i < range.m_count) dopMergeChildren(nodes, range.m_first + i);
}

// One work-group climbs the heights that are too small for a launch each, lowest first. The barrier orders a height's
// writes before the next one's reads: all are of this group.
__kernel void refitTop(DRAPE_REFIT_TOP)
{
    for (uint level = 0; level < levelCount; ++level)
    {
        const NodeRange range = levels[level];
        for (uint i = get_local_id(0); i < range.m_count; i += get_local_size(0))
            dopMergeChildren(nodes, range.m_first + i);
        barrier(CLK_GLOBAL_MEM_FENCE);
    }
}
