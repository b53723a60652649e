// Broad phase with a front: the traversal starts at the pairs where the last one stopped, and leaves the pairs where it
// stops itself. A front covers every pair of leaves exactly once, so the candidates are those of a full traversal,
// whatever moved. The fixed rule of clothOpens() gives every pair one parent.
#include "lib/candidate_list.h"
#include "lib/traversal.h"
#include "traversal_bindings.h"

// Pairs that wait in a group's local memory: 8 KiB.
#define DRAPE_GROUP_STACK 1024u
// Used when the rest is full: room for one pair's whole way down. A step leaves three more pairs in two 4-wide
// hierarchies of 24 heights, or one more in two binary ones of 48. Builders make lower ones.
#define DRAPE_GROUP_RESERVE 160u
// Candidates, and pairs of the new front, gathered in local memory: a round adds at most one of each a work-item.
#define DRAPE_GROUP_GATHER 256u

// One side as the traversal sees it.
typedef struct FrontSide
{
    __global const BvhNode* m_nodes;
    __global const BvhLink* m_links;
    __global const uint* m_order;
    __global const Triangle* m_triangles;
} FrontSide;

// The group's lists in local memory.
typedef struct FrontLists
{
    __local uint2* m_stack;
    __local uint2* m_candidates;
    __local uint2* m_front;
    __local uint* m_pushed;
    __local uint* m_candidateCount;
    __local uint* m_frontCount;
} FrontLists;

// Climbs from a pair that is proved separate to the highest ancestor that is, but not above floorDepth (the sum of the
// depths). Below that ancestor all pairs of the front are separate, and one of them is reached by first children only:
// it takes the ancestor's place. Returns whether this is the one, or already stands as high as it can.
static int raisePair(NodePair* pair, const FrontSide* cloth, const FrontSide* obstacle, const uint floorDepth,
                     uint* visits)
{
    while (cloth->m_links[pair->m_cloth].m_depth + obstacle->m_links[pair->m_obstacle].m_depth > floorDepth)
    {
        const NodePair parent = parentPair(*pair, cloth->m_links, obstacle->m_links);
        ++*visits;
        if (nodesOverlap(cloth->m_nodes + parent.m_cloth, obstacle->m_nodes + parent.m_obstacle)) return 1;
        if (!isFirstChild(*pair, parent, cloth->m_nodes, obstacle->m_nodes)) return 0;
        *pair = parent;
    }
    return 1;
}

static void keepPair(const NodePair pair, const FrontLists* lists)
{
    lists->m_front[atomic_inc(lists->m_frontCount)] = (uint2)(pair.m_cloth, pair.m_obstacle);
}

static void openPair(const NodePair pair, const FrontSide* cloth, const FrontSide* obstacle, const FrontLists* lists,
                     const uint size)
{
    __global const BvhNode* a = cloth->m_nodes + pair.m_cloth;
    __global const BvhNode* b = obstacle->m_nodes + pair.m_obstacle;
    const int openCloth =
        clothOpens(a, b, cloth->m_links[pair.m_cloth].m_depth, obstacle->m_links[pair.m_obstacle].m_depth);
    const uint first = openCloth ? a->m_first : b->m_first;
    const uint count = openCloth ? a->m_count : b->m_count;
    const uint place = size + atomic_add(lists->m_pushed, count);
    for (uint i = 0; i < count; ++i)
    {
        lists->m_stack[place + i] = openCloth ? (uint2)(first + i, pair.m_obstacle) : (uint2)(pair.m_cloth, first + i);
    }
}

// Names the work of a traversal besides collecting candidates.
typedef struct FrontTask
{
    uint m_keep;   // write the new front
    uint m_raise;  // pairs of the old front that came apart climb
    uint m_floorDepth;
} FrontTask;

// Tests one pair, of the old front or of the stack: opens it, or takes it into the lists where the traversal stops.
static void testPair(NodePair pair, const int ofFront, const FrontTask* task, const FrontSide* cloth,
                     const FrontSide* obstacle, __global const float* thickness, const uint obstacleMeshes,
                     const FrontLists* lists, const uint size, uint* visits)
{
    __global const BvhNode* a = cloth->m_nodes + pair.m_cloth;
    __global const BvhNode* b = obstacle->m_nodes + pair.m_obstacle;
    ++*visits;
    if (!nodesOverlap(a, b))
    {
        const int climbs = task->m_raise && ofFront;
        if (task->m_keep && (!climbs || raisePair(&pair, cloth, obstacle, task->m_floorDepth, visits)))
        {
            keepPair(pair, lists);
        }
        return;
    }
    if (a->m_count > 0 || b->m_count > 0)
    {
        openPair(pair, cloth, obstacle, lists, size);
        return;
    }
    Candidate candidate;
    candidate.m_cloth = cloth->m_order[a->m_first];
    candidate.m_obstacle = obstacle->m_order[b->m_first];
    if (meshesPaired(candidate, cloth->m_triangles, obstacle->m_triangles, thickness, obstacleMeshes))
    {
        lists->m_candidates[atomic_inc(lists->m_candidateCount)] = (uint2)(candidate.m_cloth, candidate.m_obstacle);
    }
    if (task->m_keep) keepPair(pair, lists);
}

// A work-group takes an equal share of the old front, and opens its pairs with a stack that its work-items share. A
// round takes as many pairs as there is room for what they can leave behind, and at least one: nothing is ever lost.
// Without keep this is a plain traversal from the given pairs. The counters of candidates and front must be zero
// before; both count on past the capacities, and a front that did not fit is of no use.
__kernel void broadPhaseFront(DRAPE_BROAD_PHASE_FRONT)
{
    __local uint2 stack[DRAPE_GROUP_STACK];
    __local uint2 foundPairs[DRAPE_GROUP_GATHER];
    __local uint2 keptPairs[DRAPE_GROUP_GATHER];
    __local uint pushed[3];
    __local uint foundCount, keptCount, place;
    const FrontSide cloth = {clothNodes, links, orders, clothTriangles};
    const FrontSide obstacle = {obstacleNodes, links + values.m_obstacleLinks, orders + values.m_obstacleOrder,
                                obstacleTriangles};
    const FrontTask task = {values.m_keep, values.m_raise, values.m_floorDepth};
    const uint oldCount = values.m_oldCount;
    __global const uint2* starts = (__global const uint2*)oldFront;
    const uint id = get_local_id(0);
    const uint width = get_local_size(0);
    const uint share = (oldCount + (uint)get_num_groups(0) - 1) / (uint)get_num_groups(0);
    uint next = min((uint)get_group_id(0) * share, oldCount);
    const uint last = min(next + share, oldCount);
    uint size = 0;
    uint visits = 0;
    if (id < 3) pushed[id] = 0;
    if (id == 0) foundCount = keptCount = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint round = 0; size > 0 || next < last; ++round)
    {
        const uint room = DRAPE_GROUP_STACK - DRAPE_GROUP_RESERVE;
        const uint allowed = size < room ? (room - size) / DRAPE_MAX_CHILDREN : 0;
        const uint taken = min(clamp(allowed, 1u, width), size + (last - next));
        const uint fromStack = min(taken, size);
        size -= fromStack;
        uint2 entry = (uint2)(0, 0);
        if (id < fromStack) entry = stack[size + id];
        if (id >= fromStack && id < taken) entry = starts[next + id - fromStack];
        next += taken - fromStack;
        // The three counts take turns: one is pushed to, one may still be read by the round before, one is cleared.
        if (id == 0) pushed[(round + 1) % 3] = 0;
        // Orders the reads of the stack against the pushes below, which may go to the same places; the one after them
        // orders the pushes against the next round's reads.
        barrier(CLK_LOCAL_MEM_FENCE);
        if (id < taken)
        {
            const FrontLists lists = {stack, foundPairs, keptPairs, &pushed[round % 3], &foundCount, &keptCount};
            const NodePair pair = {entry.x, entry.y};
            testPair(pair, id >= fromStack, &task, &cloth, &obstacle, thickness, values.m_list.m_obstacleMeshes, &lists,
                     size, &visits);
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        size += pushed[round % 3];
        const uint found = foundCount, kept = keptCount;
        const int done = size == 0 && next >= last;
        if (found > DRAPE_GROUP_GATHER - width || done)
        {
            if (!groupFlush((__global uint2*)candidates, &counters->m_candidates, values.m_list.m_capacity,
                            values.m_list.m_limit, foundPairs, found, &place))
                return;
            if (id == 0) foundCount = 0;
        }
        if (kept > DRAPE_GROUP_GATHER - width || done)
        {
            groupFlush((__global uint2*)newFront, &counters->m_front, values.m_frontCapacity, UINT_MAX, keptPairs, kept,
                       &place);
            if (id == 0) keptCount = 0;
        }
    }
    DRAPE_VISITS(counters, visits);
}
