// Compaction: hits into canonical order, by slot (cloth feature) and then obstacle feature. A counting sort over the slots:
// sums per block, first place of every slot, members of every slot, and the place of each
// hit among them: by counting where a slot has few, by a sort where it has many.
#include "lib/group_scan.h"
#include "lib/hit_list.h"
#include "lib/item_runs.h"

// Slots a work-group handles. Each work-item takes DRAPE_BLOCK / group size adjacent ones.
#define DRAPE_BLOCK 1024
// Members of a slot that a work-group puts in order by counting, in local memory; more are sorted where they are.
#define DRAPE_COUNTED 512

static uint countShare(__global const uint* slotCount, const uint slots, uint* first, uint* last)
{
    const uint share = DRAPE_BLOCK / get_local_size(0);
    *first = min(slots, (uint)(get_group_id(0) * DRAPE_BLOCK + get_local_id(0) * share));
    *last = min(slots, *first + share);
    uint sum = 0;
    for (uint slot = *first; slot < *last; ++slot) sum += slotCount[slot];
    return sum;
}

// A work-group sums the hits of one block of slots. scratch: one uint per work-item.
__kernel void compactionCount(__global const uint* restrict slotCount, const uint slots,
                              __global uint* restrict blockCount, __local uint* scratch)
{
    uint first, last, total;
    groupPrefix(scratch, countShare(slotCount, slots, &first, &last), &total);
    if (get_local_id(0) == 0) blockCount[get_group_id(0)] = total;
}

// Writes where the hits of each slot of the group's block begin, the first at `place`, and counts the slots that have more
// than `ranked`. Returns where the hits behind the block begin.
static uint placeBlock(__global const uint* restrict slotCount, const uint slots, const uint ranked, const uint place,
                       __global uint* restrict slotFirst, __global StepCounters* restrict counters, __local uint* scratch)
{
    uint first, last, total;
    uint next = place + groupPrefix(scratch, countShare(slotCount, slots, &first, &last), &total);
    for (uint slot = first; slot < last; ++slot)
    {
        slotFirst[slot] = next;
        next += slotCount[slot];
        if (slotCount[slot] > ranked) atomic_inc(&counters->m_crowded);
    }
    return place + total;
}

// Slots, or blocks of them, that a work-item loads together: loads that do not wait for each other.
#define DRAPE_TOGETHER 8

// The sum of the first `count` numbers, by all of the group's work-items together.
static uint sumOf(__global const uint* restrict numbers, const uint count, __local uint* scratch)
{
    uint sum = 0, total;
    for (uint first = get_local_id(0); first < count; first += DRAPE_TOGETHER * get_local_size(0))
    {
        DRAPE_UNROLL
        for (uint i = 0; i < DRAPE_TOGETHER; ++i)
        {
            const uint other = first + i * get_local_size(0);
            sum += other < count ? numbers[other] : 0;
        }
    }
    groupPrefix(scratch, sum, &total);
    return total;
}

// A work-group takes a block of slots, and sums those of the blocks before itself. The last one stores counters->m_hits.
// ranked: most hits of a slot that the launch behind puts in order itself; those with more are counted.
__kernel void compactionPlace(__global const uint* restrict slotCount, const uint slots, const uint ranked,
                              __global const uint* restrict blockCount, __global uint* restrict slotFirst,
                              __global StepCounters* restrict counters, __local uint* scratch)
{
    const uint before = sumOf(blockCount, get_group_id(0), scratch);
    const uint hits = placeBlock(slotCount, slots, ranked, before, slotFirst, counters, scratch);
    if (get_group_id(0) == get_num_groups(0) - 1 && get_local_id(0) == 0) counters->m_hits = hits;
}

// The same without sums of blocks, for slots that are few.
__kernel void compactionPlaceFew(__global const uint* restrict slotCount, const uint slots, const uint ranked,
                                 __global uint* restrict slotFirst, __global StepCounters* restrict counters,
                                 __local uint* scratch)
{
    const uint before = sumOf(slotCount, get_group_id(0) * DRAPE_BLOCK, scratch);
    const uint hits = placeBlock(slotCount, slots, ranked, before, slotFirst, counters, scratch);
    if (get_group_id(0) == get_num_groups(0) - 1 && get_local_id(0) == 0) counters->m_hits = hits;
}

// A work-item goes through its part of the hits' list and lists a hit among its slot's members, last to first as the items
// come; the atomic gives each a place of its own. keys: the obstacle features of members. Leaves slotCount zero for the next
// step, and its counters.
__kernel void compactionGather(__global const Contact* restrict hits, const uint hitCapacity,
                               __global volatile uint* slotCount, __global const uint* restrict slotFirst,
                               __global uint* restrict members, __global uint* restrict keys,
                               __global const StepCounters* restrict counters, __global StepCounters* restrict next)
{
    const uint count = min(counters->m_listed, hitCapacity);
    if (get_global_id(0) < sizeof(StepCounters) / sizeof(uint)) ((__global uint*)next)[get_global_id(0)] = 0;
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        const uint slot = hits[i].m_slot;
        const uint place = slotFirst[slot] + atomic_dec(slotCount + slot) - 1;
        members[place] = i;
        keys[place] = hits[i].m_obstacleFeature;
    }
}

// Puts one pair of members in order.
static void orderPair(__global const Contact* hits, __global uint* low, __global uint* high)
{
    const uint a = *low, b = *high;
    if (hits[a].m_obstacleFeature <= hits[b].m_obstacleFeature) return;
    *low = b;
    *high = a;
}

// A work-group sorts count members by obstacle feature, in place: Batcher's bitonic network, its merges begun with a
// mirrored step so that the lesser always goes to the lower place. So places from count on count as greater than all and
// need not exist. In a step every place is in one pair; the barrier orders the steps.
static void sortMembers(__global const Contact* hits, __global uint* members, const uint count)
{
    for (uint size = 2; size / 2 < count; size *= 2)
    {
        const uint pairs = (count + size - 1) / size * (size / 2);
        for (uint stride = size / 2; stride > 0; stride /= 2)
        {
            for (uint i = get_local_id(0); i < pairs; i += get_local_size(0))
            {
                const uint begin = i / stride * stride * 2, offset = i % stride;
                const uint high = begin + (stride == size / 2 ? size - 1 - offset : stride + offset);
                if (high < count) orderPair(hits, members + begin + offset, members + high);
            }
            barrier(CLK_GLOBAL_MEM_FENCE);
        }
    }
}

// The same for DRAPE_COUNTED members at most: each goes behind as many as have a lesser feature. keys, own: that many.
static void countMembers(__global const Contact* hits, __global uint* members, const uint count, __local uint* keys,
                         __local uint* own)
{
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        own[i] = members[i];
        keys[i] = hits[own[i]].m_obstacleFeature;
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        const uint key = keys[i];
        uint before = 0;
        for (uint j = 0; j < count; ++j) before += keys[j] < key;
        members[before] = own[i];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// A work-group sorts the members of those slots of its block (of at most DRAPE_BLOCK slots) that have more than `ranked`.
// Their keys stay as they were, and are not read any more.
__kernel void compactionOrder(__global const Contact* restrict hits, const uint hitCapacity,
                              __global const uint* restrict slotFirst, const uint slots, const uint ranked,
                              const uint block, __global uint* members, __global const StepCounters* restrict counters)
{
    __local uint crowded[DRAPE_BLOCK], keys[DRAPE_COUNTED], own[DRAPE_COUNTED];
    __local uint crowdedCount;
    const uint count = min(counters->m_hits, hitCapacity);
    const uint begin = get_group_id(0) * block;
    const uint end = min(slots, begin + block);
    if (get_local_id(0) == 0) crowdedCount = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint slot = begin + get_local_id(0); slot < end; slot += get_local_size(0))
    {
        const uint last = slot + 1 < slots ? min(slotFirst[slot + 1], count) : count;
        if (last > slotFirst[slot] + ranked) crowded[atomic_inc(&crowdedCount)] = slot;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint toSort = crowdedCount;
    for (uint i = 0; i < toSort; ++i)
    {
        const uint slot = crowded[i];
        const uint last = slot + 1 < slots ? min(slotFirst[slot + 1], count) : count;
        const uint size = last - slotFirst[slot];
        if (size <= DRAPE_COUNTED)
            countMembers(hits, members + slotFirst[slot], size, keys, own);
        else
            sortMembers(hits, members + slotFirst[slot], size);
    }
}

// `parts` work-items (1, 2 or 4) share a hit, and go through their part of the members' list: they count the members of the
// same slot with a lesser obstacle feature, and copy the hit to where that number puts it. Where the slot has more members
// than `ranked` compactionOrder has sorted them and the hit keeps its place. A feature pair is tested once, so features of a
// slot differ and every place is written once. keys: see compactionGather. contacts: behind a head with the counters.
__kernel void compactionWrite(__global const Contact* restrict hits, const uint hitCapacity,
                              __global const uint* restrict slotFirst, const uint slots, const uint ranked,
                              const uint parts, __global const uint* restrict members,
                              __global const uint* restrict keys, __global Contact* restrict contacts,
                              __global const StepCounters* restrict counters)
{
    const uint count = min(counters->m_hits, hitCapacity);
    if (get_global_id(0) == 0) *(__global StepCounters*)contacts = *counters;
    for (ItemRuns runs = itemRuns(count, parts); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        __global const Contact* hit = hits + members[i];
        const uint slot = hit->m_slot, first = slotFirst[slot];
        const uint last = slot + 1 < slots ? min(slotFirst[slot + 1], count) : count;
        const int sorted = last - first > ranked;
        const uint key = keys[i];
        uint before = 0;
        for (uint j = first; j < last && !sorted; ++j) before += keys[j] < key;
        copyHit(contacts + DRAPE_CONTACT_HEAD + (sorted ? i : first + before), hit, parts);
    }
}
