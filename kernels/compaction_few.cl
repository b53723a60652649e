// Compaction (compaction.cl) in one launch, for slots and hits that are few: every work-group looks at the slots of all hits,
// which costs less than the launches and the waits between them.
#include "lib/group_scan.h"
#include "lib/hit_list.h"
#include "lib/slot_order.h"

// Most slots of a work-group.
#define DRAPE_BLOCK 1024

// The slots begin … end of a group: how many hits each has, and where its members begin.
typedef struct SlotBlock
{
    uint m_begin, m_end;
    __local uint* m_counts;
    __local uint* m_firsts;  // one more than slots
} SlotBlock;

// The slots of the hits that a work-item looks at together, from `first` on; of those from `count` on none.
static void loadSlots(uint* slots, __global const uint* restrict hitSlots, const uint first, const uint count)
{
    DRAPE_UNROLL
    for (uint k = 0; k < DRAPE_TOGETHER; ++k)
    {
        const uint hit = first + k * get_local_size(0);
        slots[k] = hit < count ? hitSlots[hit] : UINT_MAX;
    }
}

// Counts the block's hits by slot. Returns how many hits slots before it have.
static uint countBlock(const SlotBlock* block, __global const uint* restrict hitSlots, const uint count,
                       __local uint* scratch)
{
    const uint begin = block->m_begin, end = block->m_end, size = get_local_size(0);
    uint earlier = 0, before;
    for (uint slot = begin + get_local_id(0); slot < end; slot += size) block->m_counts[slot - begin] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint first = get_local_id(0); first < count; first += DRAPE_TOGETHER * size)
    {
        uint slots[DRAPE_TOGETHER];
        loadSlots(slots, hitSlots, first, count);
        DRAPE_UNROLL
        for (uint k = 0; k < DRAPE_TOGETHER; ++k)
        {
            earlier += slots[k] < begin;
            if (slots[k] >= begin && slots[k] < end) atomic_inc(block->m_counts + (slots[k] - begin));
        }
    }
    groupPrefix(scratch, earlier, &before);
    return before;
}

// Where each slot's members begin, the first one's at `before`. Returns where those behind the block begin.
static uint placeBlock(const SlotBlock* block, const uint before, __local uint* scratch)
{
    const uint slots = block->m_end - block->m_begin;
    const uint share = (slots + get_local_size(0) - 1) / get_local_size(0);
    const uint first = min(slots, (uint)(get_local_id(0) * share)), last = min(slots, first + share);
    uint sum = 0, total;
    for (uint i = first; i < last; ++i) sum += block->m_counts[i];
    uint next = before + groupPrefix(scratch, sum, &total);
    for (uint i = first; i < last; ++i)
    {
        block->m_firsts[i] = next;
        next += block->m_counts[i];
    }
    if (get_local_id(0) == 0) block->m_firsts[slots] = before + total;
    barrier(CLK_LOCAL_MEM_FENCE);
    return before + total;
}

// Lists the block's hits among their slots' members, in any order. Leaves the counts zero.
static void listMembers(const SlotBlock* block, __global const Contact* restrict hits,
                        __global const uint* restrict hitSlots, const uint count, __global uint* members,
                        __global uint* keys)
{
    const uint begin = block->m_begin, end = block->m_end, size = get_local_size(0);
    for (uint first = get_local_id(0); first < count; first += DRAPE_TOGETHER * size)
    {
        uint slots[DRAPE_TOGETHER];
        loadSlots(slots, hitSlots, first, count);
        DRAPE_UNROLL
        for (uint k = 0; k < DRAPE_TOGETHER; ++k)
        {
            if (slots[k] < begin || slots[k] >= end) continue;
            const uint i = first + k * size, slot = slots[k] - begin;
            const uint place = block->m_firsts[slot] + atomic_dec(block->m_counts + slot) - 1;
            members[place] = i;
            keys[place] = hits[i].m_obstacleFeature;
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
}

// Puts the members of slots that have more than `ranked` in order.
static void orderCrowded(const SlotBlock* block, const uint ranked, __global uint* members, __global uint* keys,
                         __local uint* crowded, __local uint* crowdedCount, __local uint* own, __local uint* ownKeys)
{
    const uint slots = block->m_end - block->m_begin;
    if (get_local_id(0) == 0) *crowdedCount = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = get_local_id(0); i < slots; i += get_local_size(0))
        if (block->m_firsts[i + 1] - block->m_firsts[i] > ranked) crowded[atomic_inc(crowdedCount)] = i;
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint toOrder = *crowdedCount;
    for (uint i = 0; i < toOrder; ++i)
    {
        const uint first = block->m_firsts[crowded[i]];
        orderMembers(members + first, keys + first, block->m_firsts[crowded[i] + 1] - first, own, ownKeys);
    }
}

// Copies the hits of the block's members to their places, `parts` work-items each: places[] is where those of the turn go.
static void writeBlock(const SlotBlock* block, const uint ranked, __global const Contact* hits,
                       __global const uint* hitSlots, __global const uint* members, __global const uint* keys,
                       const uint parts, __global Contact* contacts, __local uint* places)
{
    const uint id = get_local_id(0), size = get_local_size(0);
    const uint behind = block->m_firsts[block->m_end - block->m_begin];
    for (uint base = block->m_firsts[0]; base < behind; base += size)
    {
        const uint turn = min(size, behind - base);
        if (id < turn)
        {
            const uint slot = hitSlots[members[base + id]] - block->m_begin;
            const uint first = block->m_firsts[slot], last = block->m_firsts[slot + 1];
            uint place = base + id;
            if (last - first <= ranked)
            {
                const uint key = keys[place];
                place = first;
                for (uint j = first; j < last; ++j) place += keys[j] < key;
            }
            places[id] = place;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint k = id; k < turn * parts; k += size)
            copyHit(contacts + DRAPE_CONTACT_HEAD + places[k / parts], hits + members[base + k / parts], parts);
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}

// A work-group takes `block` slots, at most DRAPE_BLOCK. hitSlots: see lib/hit_list.h. slotFirst gets where each slot's members
// begin; members gets them, in order in slots with more than `ranked`. contacts: behind a head with the counters, all
// hits in canonical order; parts: work-items that copy one (1, 2 or 4), 0 where none is to be written. scratch: a uint per
// work-item. counters->m_hits is free before. Leaves slotCount zero for the next step, and its counters.
__kernel void compactionFew(__global const Contact* restrict hits, const uint hitCapacity,
                            __global const uint* restrict hitSlots, __global uint* restrict slotCount,
                            __global uint* restrict slotFirst, const uint slots, const uint block, const uint ranked,
                            __global uint* members, __global uint* keys, const uint parts,
                            __global Contact* restrict contacts, __global StepCounters* counters,
                            __global StepCounters* restrict next, __local uint* scratch)
{
    __local uint counts[DRAPE_BLOCK], firsts[DRAPE_BLOCK + 1];
    __local uint crowdedCount, toOrder[DRAPE_COUNTED], toOrderKeys[DRAPE_COUNTED];
    const uint id = get_local_id(0), count = min(counters->m_listed, hitCapacity);
    const uint begin = min(slots, (uint)(get_group_id(0) * block));
    const SlotBlock own = {begin, min(slots, begin + block), counts, firsts};
    const uint before = countBlock(&own, hitSlots, count, scratch);
    placeBlock(&own, before, scratch);
    for (uint slot = begin + id; slot < own.m_end; slot += get_local_size(0))
    {
        slotFirst[slot] = firsts[slot - begin];
        slotCount[slot] = 0;
    }
    listMembers(&own, hits, hitSlots, count, members, keys);
    orderCrowded(&own, ranked, members, keys, counts, &crowdedCount, toOrder, toOrderKeys);
    if (get_group_id(0) == 0 && id < sizeof(StepCounters) / sizeof(uint)) ((__global uint*)next)[id] = 0;
    if (get_group_id(0) == 0 && id == 0)
    {
        StepCounters all = *counters;
        all.m_hits = count;
        if (parts == 0)
            counters->m_hits = count;
        else
            *(__global StepCounters*)contacts = all;
    }
    if (parts > 0) writeBlock(&own, ranked, hits, hitSlots, members, keys, parts, contacts, scratch);
}
