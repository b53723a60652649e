// Broad phase over wide nodes: every cloth triangle walks the obstacles' hierarchy, eight children at a time.
#include "lib/candidate_list.h"
#include "lib/traversal.h"

// A work-item is a slot of a wide node: it copies the volume of the node that stands there. Slots without one were made
// empty by the host and stay so.
__kernel void wideGather(__global const BvhNode* restrict nodes, __global const uint* restrict sources,
                         const uint slotCount, __global WideNode* restrict wides)
{
    const uint i = get_global_id(0);
    if (i >= slotCount || sources[i] == DRAPE_WIDE_NONE) return;
    __global const BvhNode* node = nodes + sources[i];
    __global WideNode* wide = wides + i / DRAPE_WIDE;
    const uint slot = i % DRAPE_WIDE;
    for (uint direction = 0; direction < DRAPE_DOP_DIRECTIONS; ++direction)
    {
        wide->m_low[direction][slot] = node->m_low[direction];
        wide->m_high[direction][slot] = node->m_high[direction];
    }
}

// Candidates a work-item gathers before it reserves room for them with one atomic.
#define DRAPE_GATHER 32

// For CPUs: a work-item is a cloth leaf, whose node leafNodes names, and tests the slots of a node as one vector.
// counters->m_candidates must be zero before.
__kernel void broadPhaseWideLeaves(__global const BvhNode* restrict clothNodes, __global const uint* restrict clothOrder,
                                   __global const Triangle* restrict clothTriangles,
                                   __global const uint* restrict leafNodes, const uint leafCount,
                                   __global const WideNode* restrict wides,
                                   __global const Triangle* restrict obstacleTriangles,
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
    Candidate candidate;
    candidate.m_cloth = clothOrder[clothNode->m_first];
    uint stack[DRAPE_WIDE_STACK_DEPTH];
    uint depth = 1;
    stack[0] = 0;
    while (depth > 0)
    {
        __global const WideNode* wide = wides + stack[--depth];
        visits += DRAPE_WIDE;
        for (uint overlaps = wideOverlaps(clothNode, wide); overlaps != 0; overlaps &= overlaps - 1)
        {
            const uint child = wide->m_child[popcount((overlaps & -overlaps) - 1)];
            if (!(child & DRAPE_WIDE_LEAF))
            {
                stack[depth++] = child;
                continue;
            }
            candidate.m_obstacle = child & ~DRAPE_WIDE_LEAF;
            if (!meshesPaired(candidate, clothTriangles, obstacleTriangles, thickness, obstacleMeshes)) continue;
            gathered[gatheredCount++] = candidate;
            if (gatheredCount < DRAPE_GATHER) continue;
            if (!flushCandidates(candidates, counters, capacity, limit, gathered, gatheredCount)) return;
            gatheredCount = 0;
        }
    }
    flushCandidates(candidates, counters, capacity, limit, gathered, gatheredCount);
    DRAPE_VISITS(counters, visits);
}

// Pairs that wait in a group's local memory: 8 KiB.
#define DRAPE_GROUP_STACK 1024u
// Used when the rest is full: room for one pair's whole way down.
#define DRAPE_GROUP_RESERVE DRAPE_WIDE_STACK_DEPTH
// Candidates gathered in local memory: a round adds at most one a work-item.
#define DRAPE_GROUP_GATHER 512u

// One slot of a pair of a cloth leaf and a wide node. Pushes the slot's wide node behind size, or gathers a candidate.
static void testSlot(const uint2 pair, const uint slot, __global const BvhNode* clothNodes,
                     __global const uint* clothOrder, __global const Triangle* clothTriangles,
                     __global const WideNode* wides, __global const Triangle* obstacleTriangles,
                     __global const float* thickness, const uint obstacleMeshes, __local uint2* stack, const uint size,
                     __local uint* pushed, __local uint2* gathered, __local uint* gatheredCount)
{
    __global const WideNode* wide = wides + pair.y;
    if (!wideSlotOverlaps(clothNodes + pair.x, wide, slot)) return;
    const uint child = wide->m_child[slot];
    if (!(child & DRAPE_WIDE_LEAF))
    {
        stack[size + atomic_inc(pushed)] = (uint2)(pair.x, child);
        return;
    }
    Candidate candidate;
    candidate.m_cloth = clothOrder[clothNodes[pair.x].m_first];
    candidate.m_obstacle = child & ~DRAPE_WIDE_LEAF;
    if (!meshesPaired(candidate, clothTriangles, obstacleTriangles, thickness, obstacleMeshes)) return;
    gathered[atomic_inc(gatheredCount)] = (uint2)(candidate.m_cloth, candidate.m_obstacle);
}

// For GPUs: a work-group walks for leavesPerGroup cloth leaves, at most one a work-item. Eight work-items take a pair of a
// leaf and a wide node from a stack that the group shares, so that one leaf deep in contact does not keep the rest waiting.
// A round takes as many pairs as there is room for what they can leave behind, and at least one: nothing is ever lost.
// leafNodes names the leaves' nodes; candidates are written as pairs of numbers. counters->m_candidates must be zero before.
__kernel void broadPhaseWideGroups(__global const BvhNode* restrict clothNodes, __global const uint* restrict clothOrder,
                                   __global const Triangle* restrict clothTriangles,
                                   __global const uint* restrict leafNodes, const uint leafCount,
                                   const uint leavesPerGroup, __global const WideNode* restrict wides,
                                   __global const Triangle* restrict obstacleTriangles,
                                   __global const float* restrict thickness, const uint obstacleMeshes,
                                   __global uint2* restrict candidates, __global StepCounters* restrict counters,
                                   const uint capacity, const uint limit)
{
    __local uint2 stack[DRAPE_GROUP_STACK];
    __local uint2 gathered[DRAPE_GROUP_GATHER];
    __local uint pushed[3];
    __local uint gatheredCount, place;
    const uint id = get_local_id(0);
    const uint mine = id / DRAPE_WIDE;
    const uint firstLeaf = get_group_id(0) * leavesPerGroup;
    uint size = min(leavesPerGroup, leafCount - firstLeaf);
    uint visits = 0;
    if (id < size) stack[id] = (uint2)(leafNodes[firstLeaf + id], 0);
    if (id < 3) pushed[id] = 0;
    if (id == 0) gatheredCount = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint round = 0; size > 0; ++round)
    {
        const uint room = DRAPE_GROUP_STACK - DRAPE_GROUP_RESERVE;
        const uint allowed = size < room ? (room - size) / (DRAPE_WIDE - 1) : 0;
        const uint taken = min(size, clamp(allowed, 1u, (uint)get_local_size(0) / DRAPE_WIDE));
        size -= taken;
        const uint2 pair = stack[size + min(mine, taken - 1)];
        // The three counts take turns: one is pushed to, one may still be read by the round before, one is cleared.
        if (id == 0) pushed[(round + 1) % 3] = 0;
        // Orders the reads of the stack against the pushes below, which may go to the same places; the one after the test
        // orders the pushes against the next round's reads.
        barrier(CLK_LOCAL_MEM_FENCE);
        if (mine < taken)
        {
            ++visits;
            testSlot(pair, id % DRAPE_WIDE, clothNodes, clothOrder, clothTriangles, wides, obstacleTriangles, thickness,
                     obstacleMeshes, stack, size, &pushed[round % 3], gathered, &gatheredCount);
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        size += pushed[round % 3];
        const uint found = gatheredCount;
        if (found > DRAPE_GROUP_GATHER - get_local_size(0) || size == 0)
        {
            if (!groupFlush(candidates, &counters->m_candidates, capacity, limit, gathered, found, &place)) return;
            if (id == 0) gatheredCount = 0;
        }
    }
    DRAPE_VISITS(counters, visits);
}
