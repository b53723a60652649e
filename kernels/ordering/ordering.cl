// Ordering puts unsorted contacts into canonical order: by slot (cloth feature), then by obstacle feature.
//
// The method is a counting sort over the slots: sums per block, the first position of every slot, the members of
// every slot, and the position of each contact among them. That position comes from counting where a slot has few
// members, from a sort where it has many. On a GPU, few slots take one or two launches less (ordering_small.cl).
#include "../lib/prefetch.h"
#include "../lib/group_scan.h"
#include "../lib/hit_list.h"
#include "../lib/item_runs.h"
#include "../lib/slot_order.h"

// Slots per work-group. Each work-item takes DRAPE_BLOCK / group size adjacent ones.
#define DRAPE_BLOCK 1024

static uint countShare(__global const uint* slotCount, const uint slots, uint* first, uint* last)
{
    const uint share = DRAPE_BLOCK / get_local_size(0);
    *first = min(slots, (uint)(get_group_id(0) * DRAPE_BLOCK + get_local_id(0) * share));
    *last = min(slots, *first + share);
    uint sum = 0;
    for (uint slot = *first; slot < *last; ++slot) sum += slotCount[slot];
    return sum;
}

// Sums the contacts of one block of slots per work-group. scratch: one uint per work-item.
__kernel void orderingCount(__global const uint* restrict slotCount, const uint slots,
                              __global uint* restrict blockCount, __local uint* scratch)
{
    uint first, last, total;
    groupPrefix(scratch, countShare(slotCount, slots, &first, &last), &total);
    if (get_local_id(0) == 0) blockCount[get_group_id(0)] = total;
}

// Writes where the contacts of each slot of the group's block begin, the first at `place`, and counts the slots that
// have more than `ranked`. Returns where the contacts after the block begin.
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

// Processes a block of slots per work-group, and sums the contacts of all earlier slots. The last group stores
// counters->m_contactsStored. sums: of blocks, by orderingCount, and perBlock 1; for few slots sums is slotCount, and
// perBlock DRAPE_BLOCK. ranked: maximum contacts of a slot that the next launch sorts itself; slots with more are
// counted.
__kernel void orderingPlace(__global const uint* restrict slotCount, const uint slots, const uint ranked,
                              __global const uint* restrict sums, const uint perBlock,
                              __global uint* restrict slotFirst, __global StepCounters* restrict counters,
                              __local uint* scratch)
{
    const uint before = groupSumOf(sums, get_group_id(0) * perBlock, scratch);
    const uint hits = placeBlock(slotCount, slots, ranked, before, slotFirst, counters, scratch);
    if (get_group_id(0) == get_num_groups(0) - 1 && get_local_id(0) == 0) counters->m_contactsStored = hits;
}

// Lists each contact among its slot's members. A work-item goes through its part of the contacts' list; the atomic
// gives each contact its own position, filled from last to first. keys: the obstacle features of members. Leaves
// slotCount and the next step's counters zero.
__kernel void orderingGather(__global const Contact* restrict hits, const uint hitCapacity,
                               __global volatile uint* slotCount, __global const uint* restrict slotFirst,
                               __global uint* restrict members, __global uint* restrict keys,
                               __global const StepCounters* restrict counters,
                               __global StepCounters* restrict next)
{
    const uint count = min(counters->m_contactsFound, hitCapacity);
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

// Sorts the members of slots with more than `ranked`, one work-group per block of at most DRAPE_BLOCK slots. Their keys
// (see orderingGather) are invalid afterwards.
__kernel void orderingOrder(const uint hitCapacity, __global const uint* restrict slotFirst, const uint slots,
                              const uint ranked, const uint block, __global uint* members, __global uint* keys,
                              __global const StepCounters* restrict counters)
{
    __local uint crowded[DRAPE_BLOCK], own[DRAPE_COUNTED], ownKeys[DRAPE_COUNTED];
    __local uint crowdedCount;
    const uint count = min(counters->m_contactsStored, hitCapacity);
    const uint begin = get_group_id(0) * block;
    const uint end = min(slots, begin + block);
    if (get_local_id(0) == 0) crowdedCount = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint slot = begin + get_local_id(0); slot < end; slot += get_local_size(0))
    {
        const uint last = slot + 1 < slots ? min(slotFirst[slot + 1], count) : count;
        if (last > slotFirst[slot] && last - slotFirst[slot] > ranked) crowded[atomic_inc(&crowdedCount)] = slot;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint toSort = crowdedCount;
    for (uint i = 0; i < toSort; ++i)
    {
        const uint slot = crowded[i], first = slotFirst[slot];
        const uint last = slot + 1 < slots ? min(slotFirst[slot + 1], count) : count;
        orderMembers(members + first, keys + first, last - first, own, ownKeys);
    }
}

// Copies each contact to its position in canonical order. `parts` work-items (1, 2 or 4) share a contact, and each
// goes through its part of the members' list. They count the members of the same slot with a lesser obstacle feature;
// that number is the contact's position in its slot. Where the slot has more members than `ranked`, orderingOrder
// has sorted them and the contact keeps its position. A feature pair is tested once, so features of a slot differ and
// every position is written once. keys: see orderingGather. contacts: behind a head with the counters. Leaves
// slotCount and slotSums zero for the next step where slotSums is not null.
__kernel void orderingWrite(__global const Contact* restrict hits, const uint hitCapacity,
                              __global const uint* restrict slotFirst, const uint slots, const uint ranked,
                              const uint parts, __global const uint* restrict members,
                              __global const uint* restrict keys, __global Contact* restrict contacts,
                              __global const StepCounters* restrict counters, __global uint* restrict slotCount,
                              __global uint* restrict slotSums)
{
    const uint count = min(counters->m_contactsStored, hitCapacity);
    clearSums(slotCount, slotSums, slots);
    if (get_global_id(0) == 0) *(__global StepCounters*)contacts = *counters;
    for (ItemRuns runs = itemRuns(count, parts); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        prefetchWord(hits + members[min(i + DRAPE_AHEAD, count - 1)]);
        __global const Contact* hit = hits + members[i];
        const uint slot = hit->m_slot, first = slotFirst[slot];
        const uint last = slot + 1 < slots ? min(slotFirst[slot + 1], count) : count;
        const int sorted = last - first > ranked;
        const uint key = keys[i];
        uint before = 0;
#ifndef DRAPE_CPU
        // Loads several keys together; on a GPU the loads would otherwise wait for each other.
        __attribute__((opencl_unroll_hint(DRAPE_TOGETHER)))
#endif
        for (uint j = first; j < last && !sorted; ++j) before += keys[j] < key;
        copyHit(contacts + DRAPE_CONTACT_HEAD + (sorted ? i : first + before), hit, parts);
    }
}
