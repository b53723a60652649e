// Broad phase by a uniform grid: obstacle triangles are listed in every cell that their box covers, sorted by cell;
// each cloth triangle looks into the cells that its own covers. No inner node of a tree is read.
#include "lib/candidate_list.h"
#include "lib/grid.h"
#include "lib/tree_layout.h"
#include "traversal_bindings.h"

// Candidates a work-item gathers before it reserves room for them with one atomic.
#define DRAPE_GATHER 16

// A work-item is an obstacle leaf; it lists itself in its cells. counters->m_entries must be zero before, keys must
// hold DRAPE_GRID_CELLS; the demand counts on past the capacity. The order of a cell's entries does not matter.
__kernel void gridEntries(DRAPE_GRID_ENTRIES)
{
    const uint leaf = get_global_id(0);
    if (leaf >= values.m_leafCount) return;
    const uint place = leafPlace(nodes, leaf, values.m_leafCount);
    GridRange range;
    if (!gridRange(&range, nodes + place, values.m_frame)) return;
    uint count = 1;
    for (int axis = 0; axis < 3; ++axis)
        count *= range.m_last[axis] - range.m_first[axis] + 1;
    uint entry = atomic_add(&counters->m_entries, count);
    for (uint k = range.m_first[2]; k <= range.m_last[2]; ++k)
        for (uint j = range.m_first[1]; j <= range.m_last[1]; ++j)
            for (uint i = range.m_first[0]; i <= range.m_last[0]; ++i, ++entry)
            {
                if (entry >= values.m_entryCapacity) return;
                keys[entry] = gridKey(i, j, k);
                places[entry] = place;
            }
}

// A work-item is a sorted entry, or the end behind the last. It writes where the cells after the entry before, up to
// its own, begin. Each cell's begin is written by one work-item.
__kernel void gridStarts(DRAPE_GRID_STARTS)
{
    const uint i = get_global_id(0);
    if (i > count) return;
    const uint first = i == 0 ? 0 : min(keys[i - 1], DRAPE_GRID_CELLS) + 1;
    const uint last = i == count ? DRAPE_GRID_CELLS : min(keys[i], DRAPE_GRID_CELLS);
    for (uint cell = first; cell <= last; ++cell)
        starts[cell] = i;
}

// A work-item is a cloth leaf. A pair counts in one of the cells that both cover, see gridPairKey().
// counters->m_candidates must be zero before.
__kernel void gridPairs(DRAPE_GRID_PAIRS)
{
    const uint leaf = get_global_id(0);
    if (leaf >= values.m_leafCount) return;
    const GridFrame frame = values.m_frame;
    const ListValues list = values.m_list;
    __global const BvhNode* own = clothNodes + leafPlace(clothNodes, leaf, values.m_leafCount);
    GridRange range;
    if (!gridRange(&range, own, frame)) return;
    Candidate gathered[DRAPE_GATHER];
    uint gatheredCount = 0, visits = 0;
    const uint3 size = (uint3)(range.m_last[0] - range.m_first[0] + 1, range.m_last[1] - range.m_first[1] + 1,
                               range.m_last[2] - range.m_first[2] + 1);
    for (uint cell = 0; cell < size.x * size.y * size.z; ++cell)
    {
        const uint key = gridKey(range.m_first[0] + cell % size.x, range.m_first[1] + cell / size.x % size.y,
                                 range.m_first[2] + cell / (size.x * size.y));
        for (uint entry = starts[key]; entry < starts[key + 1]; ++entry)
        {
            __global const BvhNode* other = obstacleNodes + places[entry];
            ++visits;
            if (!nodesOverlap(own, other) || gridPairKey(own, other, frame) != key) continue;
            Candidate candidate;
            candidate.m_cloth = clothOrder[own->m_first];
            candidate.m_obstacle = obstacleOrder[other->m_first];
            if (!meshesPaired(candidate, clothTriangles, obstacleTriangles, thickness, list.m_obstacleMeshes)) continue;
            gathered[gatheredCount++] = candidate;
            if (gatheredCount < DRAPE_GATHER) continue;
            if (!flushCandidates(candidates, counters, list.m_capacity, list.m_limit, gathered, gatheredCount)) return;
            gatheredCount = 0;
        }
    }
    flushCandidates(candidates, counters, list.m_capacity, list.m_limit, gathered, gatheredCount);
    DRAPE_VISITS(counters, visits);
}
