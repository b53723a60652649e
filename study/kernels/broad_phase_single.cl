// Broad phase as in the thesis, section 3.3.1: one work-group takes pairs of nodes from a queue in local memory and
// opens both nodes of a pair that overlaps. What the queue cannot hold waits in global memory, so nothing is lost.
#include "lib/candidate_list.h"
#include "lib/traversal.h"
#include "traversal_bindings.h"

// Pairs in local memory: 8 KiB, about what the thesis had.
#define DRAPE_QUEUE 1024u
// Candidates gathered in local memory; a round adds at most one a work-item, of which there are at most 256.
#define DRAPE_GROUP_GATHER 512u

// One side as the traversal sees it.
typedef struct QueueSide
{
    __global const BvhNode* m_nodes;
    __global const uint* m_order;
    __global const Triangle* m_triangles;
} QueueSide;

// The pairs from m_head to m_tail wait in a ring; what does not fit is written behind the spilled pairs. The counts are
// the same in every work-item.
typedef struct PairQueue
{
    __local uint2* m_ring;
    __local uint* m_pushed;  // by this round
    __global uint2* m_spill;
    uint m_spillCapacity;
    uint m_head;
    uint m_tail;
    uint m_spilled;
    uint m_mostSpilled;
} PairQueue;

static uint roomOf(const PairQueue* queue)
{
    return DRAPE_QUEUE - (queue->m_tail - queue->m_head);
}

static void pushPair(const PairQueue* queue, const uint place, const uint2 pair)
{
    const uint room = roomOf(queue);
    if (place < room)
    {
        queue->m_ring[(queue->m_tail + place) % DRAPE_QUEUE] = pair;
        return;
    }
    const uint beyond = queue->m_spilled + place - room;
    if (beyond < queue->m_spillCapacity) queue->m_spill[beyond] = pair;
}

// Queues every pair of a child, or of the node itself where it is a leaf.
static void openBoth(const PairQueue* queue, const uint2 pair, __global const BvhNode* a, __global const BvhNode* b)
{
    const uint2 first = (uint2)(a->m_count > 0 ? a->m_first : pair.x, b->m_count > 0 ? b->m_first : pair.y);
    const uint2 count = max((uint2)(a->m_count, b->m_count), (uint2)(1, 1));
    const uint place = atomic_add(queue->m_pushed, count.x * count.y);
    for (uint i = 0; i < count.x * count.y; ++i)
    {
        pushPair(queue, place + i, first + (uint2)(i % count.x, i / count.x));
    }
}

// Gathers a candidate or opens the pair. Two conditions instead of one with two branches: PoCL 5.0's compiler aborts
// when the loop of openBoth() stands in a branch beside another one in front of a barrier.
static void testPair(const uint2 pair, const PairQueue* queue, const QueueSide* cloth, const QueueSide* obstacle,
                     __global const float* thickness, const uint obstacleMeshes, __local uint2* gathered,
                     __local uint* gatheredCount)
{
    __global const BvhNode* a = cloth->m_nodes + pair.x;
    __global const BvhNode* b = obstacle->m_nodes + pair.y;
    if (!nodesOverlap(a, b)) return;
    if (a->m_count == 0 && b->m_count == 0)
    {
        Candidate candidate;
        candidate.m_cloth = cloth->m_order[a->m_first];
        candidate.m_obstacle = obstacle->m_order[b->m_first];
        if (meshesPaired(candidate, cloth->m_triangles, obstacle->m_triangles, thickness, obstacleMeshes))
        {
            gathered[atomic_inc(gatheredCount)] = (uint2)(candidate.m_cloth, candidate.m_obstacle);
        }
    }
    if ((a->m_count | b->m_count) != 0) openBoth(queue, pair, a, b);
}

// Takes the pairs of this round into the queue, and their number.
static void closeRound(PairQueue* queue)
{
    const uint pushed = *queue->m_pushed;
    const uint queued = min(pushed, roomOf(queue));
    queue->m_tail += queued;
    queue->m_spilled += pushed - queued;
    queue->m_mostSpilled = max(queue->m_mostSpilled, queue->m_spilled);
    queue->m_spilled = min(queue->m_spilled, queue->m_spillCapacity);
}

// Brings spilled pairs back into an empty ring. The latest come first: the deepest, so that few wait.
static void bringBack(PairQueue* queue)
{
    const uint back = min(queue->m_spilled, DRAPE_QUEUE / 2);
    queue->m_spilled -= back;
    for (uint i = get_local_id(0); i < back; i += get_local_size(0))
    {
        queue->m_ring[(queue->m_tail + i) % DRAPE_QUEUE] = queue->m_spill[queue->m_spilled + i];
    }
    queue->m_tail += back;
}

// One work-group. The counters of candidates and spill must be zero before. m_spill becomes the most pairs that had to
// wait in spill; more than fits says that the result is not complete.
__kernel void broadPhaseSingle(DRAPE_BROAD_PHASE_SINGLE)
{
    __local uint2 ring[DRAPE_QUEUE];
    __local uint2 gathered[DRAPE_GROUP_GATHER];
    __local uint pushed[3];
    __local uint gatheredCount, place;
    const QueueSide cloth = {clothNodes, clothOrder, clothTriangles};
    const QueueSide obstacle = {obstacleNodes, obstacleOrder, obstacleTriangles};
    const uint id = get_local_id(0);
    PairQueue queue = {ring, pushed, (__global uint2*)spill, values.m_spillCapacity, 0, 1, 0, 0};
    uint visits = 0;
    if (id == 0) ring[0] = (uint2)(values.m_clothRoot, values.m_obstacleRoot);
    if (id < 3) pushed[id] = 0;
    if (id == 0) gatheredCount = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint round = 0; queue.m_head != queue.m_tail; ++round)
    {
        const uint taken = min(queue.m_tail - queue.m_head, (uint)get_local_size(0));
        const uint2 pair = ring[(queue.m_head + min(id, taken - 1)) % DRAPE_QUEUE];
        queue.m_head += taken;
        // The three counts take turns: one is pushed to, one may still be read by the round before, one is cleared.
        queue.m_pushed = &pushed[round % 3];
        if (id == 0) pushed[(round + 1) % 3] = 0;
        // Orders the reads of the ring against the pushes below, which may go to the same places.
        barrier(CLK_LOCAL_MEM_FENCE);
        visits += id < taken;
        if (id < taken)
        {
            testPair(pair, &queue, &cloth, &obstacle, thickness, values.m_list.m_obstacleMeshes, gathered,
                     &gatheredCount);
        }
        // Orders the pushes, to either memory, against the reads of a later round.
        barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
        closeRound(&queue);
        if (queue.m_head == queue.m_tail && queue.m_spilled > 0)
        {
            bringBack(&queue);
            barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
        }
        const uint found = gatheredCount;
        if (found > DRAPE_GROUP_GATHER - get_local_size(0) || queue.m_head == queue.m_tail)
        {
            if (!groupFlush((__global uint2*)candidates, &counters->m_candidates, values.m_list.m_capacity,
                            values.m_list.m_limit, gathered, found, &place))
                return;
            if (id == 0) gatheredCount = 0;
        }
    }
    if (id == 0) counters->m_spill = queue.m_mostSpilled;
    DRAPE_VISITS(counters, visits);
}
