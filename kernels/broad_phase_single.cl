// Broad phase as in the thesis, section 3.3.1: one work-group takes pairs of nodes from a queue in local memory and opens
// both nodes of a pair that overlaps. What the queue cannot hold waits in global memory, so nothing is lost.
#include "lib/candidate_list.h"
#include "lib/traversal.h"

// Pairs in local memory: 8 KiB, about what the thesis had.
#define DRAPE_QUEUE 1024u
// Candidates gathered in local memory; a round adds at most one a work-item, of which there are at most 256.
#define DRAPE_GROUP_GATHER 512u

// The queue is a ring: m_room places from m_tail are free, what goes beyond them is written behind the spilled pairs.
typedef struct PairQueue
{
    __local uint2* m_ring;
    __local uint* m_pushed;
    __global uint2* m_spill;
    uint m_tail;
    uint m_room;
    uint m_spilled;
    uint m_spillCapacity;
} PairQueue;

static void pushPair(const PairQueue* queue, const uint place, const uint2 pair)
{
    if (place < queue->m_room)
    {
        queue->m_ring[(queue->m_tail + place) % DRAPE_QUEUE] = pair;
        return;
    }
    const uint beyond = queue->m_spilled + place - queue->m_room;
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

// One work-group. The counters of candidates and spill must be zero before. m_spill becomes the most pairs that had to
// wait in spill; more than fits says that the result is not complete.
__kernel void broadPhaseSingle(__global const BvhNode* restrict clothNodes, __global const uint* restrict clothOrder,
                               __global const Triangle* restrict clothTriangles, const uint clothRoot,
                               __global const BvhNode* restrict obstacleNodes, __global const uint* restrict obstacleOrder,
                               __global const Triangle* restrict obstacleTriangles, const uint obstacleRoot,
                               __global const float* restrict thickness, const uint obstacleMeshes,
                               __global uint2* restrict candidates, __global StepCounters* restrict counters,
                               const uint capacity, const uint limit, __global uint2* spill, const uint spillCapacity)
{
    __local uint2 ring[DRAPE_QUEUE];
    __local uint2 gathered[DRAPE_GROUP_GATHER];
    __local uint pushed[3];
    __local uint gatheredCount, place;
    const uint id = get_local_id(0);
    const uint width = get_local_size(0);
    uint head = 0, tail = 1, spilled = 0, mostSpilled = 0, visits = 0;
    if (id == 0) ring[0] = (uint2)(clothRoot, obstacleRoot);
    if (id < 3) pushed[id] = 0;
    if (id == 0) gatheredCount = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint round = 0; head != tail; ++round)
    {
        const uint taken = min(tail - head, width);
        const uint2 pair = ring[(head + min(id, taken - 1)) % DRAPE_QUEUE];
        head += taken;
        // The three counts take turns: one is pushed to, one may still be read by the round before, one is cleared.
        if (id == 0) pushed[(round + 1) % 3] = 0;
        // Orders the reads of the ring against the pushes below, which may go to the same places.
        barrier(CLK_LOCAL_MEM_FENCE);
        const uint room = DRAPE_QUEUE - (tail - head);
        __global const BvhNode* a = clothNodes + pair.x;
        __global const BvhNode* b = obstacleNodes + pair.y;
        visits += id < taken;
        if (id < taken && nodesOverlap(a, b))
        {
            const PairQueue queue = {ring, &pushed[round % 3], spill, tail, room, spilled, spillCapacity};
            if (a->m_count > 0 || b->m_count > 0)
            {
                openBoth(&queue, pair, a, b);
            }
            else
            {
                Candidate candidate;
                candidate.m_cloth = clothOrder[a->m_first];
                candidate.m_obstacle = obstacleOrder[b->m_first];
                if (meshesPaired(candidate, clothTriangles, obstacleTriangles, thickness, obstacleMeshes))
                {
                    gathered[atomic_inc(&gatheredCount)] = (uint2)(candidate.m_cloth, candidate.m_obstacle);
                }
            }
        }
        // Orders the pushes, to either memory, against the reads of a later round.
        barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
        const uint queued = min(pushed[round % 3], room);
        tail += queued;
        spilled += pushed[round % 3] - queued;
        mostSpilled = max(mostSpilled, spilled);
        spilled = min(spilled, spillCapacity);
        if (head == tail && spilled > 0)
        {
            // The latest come back first: the deepest pairs, so that few wait.
            const uint back = min(spilled, DRAPE_QUEUE / 2);
            spilled -= back;
            for (uint i = id; i < back; i += width) ring[(tail + i) % DRAPE_QUEUE] = spill[spilled + i];
            tail += back;
            barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
        }
        const uint found = gatheredCount;
        if (found > DRAPE_GROUP_GATHER - width || head == tail)
        {
            if (!groupFlush(candidates, &counters->m_candidates, capacity, limit, gathered, found, &place)) return;
            if (id == 0) gatheredCount = 0;
        }
    }
    if (id == 0) counters->m_spill = mostSpilled;
    DRAPE_VISITS(counters, visits);
}
