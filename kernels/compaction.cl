// Compaction: winners of the slots, in slot order, which is the canonical order of contacts. Three launches: count per
// block, scan of the blocks by one group, write.
#include "lib/contact_slot.h"
#include "lib/group_scan.h"
#include "shared/mesh.h"

// Slots a work-group handles. Each work-item takes DRAPE_BLOCK / group size adjacent ones.
#define DRAPE_BLOCK 1024

// A work-group counts the winners of one block of slots.
__kernel void compactionCount(__global const uint* restrict slotFeature, const uint slotCount,
                              __global uint* restrict blockCount, __local uint* scratch)
{
    const uint share = DRAPE_BLOCK / get_local_size(0);
    const uint first = get_group_id(0) * DRAPE_BLOCK + get_local_id(0) * share;
    uint winners = 0;
    for (uint slot = first; slot < first + share && slot < slotCount; ++slot)
    {
        winners += slotFeature[slot] != DRAPE_NO_CONTACT;
    }
    uint total;
    groupPrefix(scratch, winners, &total);
    if (get_local_id(0) == 0) blockCount[get_group_id(0)] = total;
}

// One work-group replaces the counts by the sums before them and stores the total.
__kernel void compactionScan(__global uint* restrict blockCount, const uint blockTotal,
                             __global StepCounters* restrict counters, __local uint* scratch)
{
    uint base = 0;
    for (uint first = 0; first < blockTotal; first += get_local_size(0))
    {
        const uint block = first + get_local_id(0);
        uint total;
        const uint before = groupPrefix(scratch, block < blockTotal ? blockCount[block] : 0, &total);
        if (block < blockTotal) blockCount[block] = base + before;
        base += total;
    }
    if (get_local_id(0) == 0) counters->m_contacts = base;
}

// A work-group writes the contacts of one block and empties its slots for the next step.
__kernel void compactionWrite(__global uint* restrict slotRank, __global uint* restrict slotFeature,
                              __global const uint* restrict slotHit, const uint slotCount,
                              __global const uint* restrict blockCount, __global const Contact* restrict hits,
                              __global Contact* restrict contacts, const uint capacity, __local uint* scratch)
{
    const uint share = DRAPE_BLOCK / get_local_size(0);
    const uint first = get_group_id(0) * DRAPE_BLOCK + get_local_id(0) * share;
    uint winners = 0;
    for (uint slot = first; slot < first + share && slot < slotCount; ++slot)
    {
        winners += slotFeature[slot] != DRAPE_NO_CONTACT;
    }
    uint total;
    uint place = blockCount[get_group_id(0)] + groupPrefix(scratch, winners, &total);
    if (winners == 0) return;
    for (uint slot = first; slot < first + share && slot < slotCount; ++slot)
    {
        if (slotFeature[slot] == DRAPE_NO_CONTACT) continue;
        if (place < capacity) contacts[place] = hits[slotHit[slot]];
        ++place;
        slotRank[slot] = DRAPE_NO_CONTACT;
        slotFeature[slot] = DRAPE_NO_CONTACT;
    }
}
