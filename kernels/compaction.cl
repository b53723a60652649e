// Compaction: hits into canonical order, by slot (cloth feature) and then obstacle feature. A counting sort over the slots:
// sums per block, scan of the blocks by one group, first place of every slot, members of every slot, and the place of each
// hit among them.
#include "lib/group_scan.h"
#include "shared/contact.h"
#include "shared/patch.h"

// Slots a work-group handles. Each work-item takes DRAPE_BLOCK / group size adjacent ones.
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

// A work-group sums the hits of one block of slots. scratch: one uint per work-item.
__kernel void compactionCount(__global const uint* restrict slotCount, const uint slots,
                              __global uint* restrict blockCount, __local uint* scratch)
{
    uint first, last, total;
    groupPrefix(scratch, countShare(slotCount, slots, &first, &last), &total);
    if (get_local_id(0) == 0) blockCount[get_group_id(0)] = total;
}

// One work-group replaces the sums by the sums before them and stores their total as counters->m_hits.
__kernel void compactionScan(__global uint* restrict blockCount, const uint blocks,
                             __global StepCounters* restrict counters, __local uint* scratch)
{
    uint base = 0;
    for (uint first = 0; first < blocks; first += get_local_size(0))
    {
        const uint block = first + get_local_id(0);
        uint total;
        const uint before = groupPrefix(scratch, block < blocks ? blockCount[block] : 0, &total);
        if (block < blocks) blockCount[block] = base + before;
        base += total;
    }
    if (get_local_id(0) == 0) counters->m_hits = base;
}

// A work-group writes where the hits of each slot of its block begin.
__kernel void compactionPlace(__global const uint* restrict slotCount, const uint slots,
                              __global const uint* restrict blockCount, __global uint* restrict slotFirst,
                              __local uint* scratch)
{
    uint first, last, total;
    uint place = blockCount[get_group_id(0)];
    place += groupPrefix(scratch, countShare(slotCount, slots, &first, &last), &total);
    for (uint slot = first; slot < last; ++slot)
    {
        slotFirst[slot] = place;
        place += slotCount[slot];
    }
}

// A work-item takes every stride-th place of the hits' list and lists a hit among its slot's members, last to first as the
// items come; the atomic gives each a place of its own. Places whose slot is DRAPE_NO_FEATURE hold no hit. Leaves slotCount zero for the next step.
__kernel void compactionGather(__global const Contact* restrict hits, const uint hitCapacity,
                               __global volatile uint* slotCount, __global const uint* restrict slotFirst,
                               __global uint* restrict members, __global const StepCounters* restrict counters)
{
    const uint count = min(counters->m_listed, hitCapacity);
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        const uint slot = hits[i].m_slot;
        if (slot == DRAPE_NO_FEATURE) continue;
        members[slotFirst[slot] + atomic_dec(slotCount + slot) - 1] = i;
    }
}

// A work-item takes every stride-th place of the members' list, counts the members of the same slot with a lesser obstacle
// feature, and writes the hit where that number puts it. A feature pair is tested once, so features of a slot differ and
// every place is written once.
__kernel void compactionWrite(__global const Contact* restrict hits, const uint hitCapacity,
                              __global const uint* restrict slotFirst, __global const uint* restrict members,
                              __global Contact* restrict contacts, __global const StepCounters* restrict counters)
{
    const uint count = min(counters->m_hits, hitCapacity);
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        const Contact hit = hits[members[i]];
        const uint first = slotFirst[hit.m_slot];
        uint before = 0;
        for (uint j = first; j < count && hits[members[j]].m_slot == hit.m_slot; ++j)
        {
            before += hits[members[j]].m_obstacleFeature < hit.m_obstacleFeature;
        }
        contacts[first + before] = hit;
    }
}
