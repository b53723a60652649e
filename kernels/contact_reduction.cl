// Writes the hits that stay. Which these are is told before, by contact_reduction_hits.cl on a GPU and by
// contact_reduction_slots.cl on a CPU.
#include "lib/ask_for.h"
#include "lib/hit_list.h"
#include "lib/item_runs.h"
#include "shared/patch.h"

// The hit that stays at place i of the members' list, of `count`; DRAPE_NO_FEATURE where none does.
static uint keptAt(__global const Contact* restrict hits, __global const uint* restrict kept, const uint i,
                   const uint count)
{
    const uint ahead = kept[min(i + DRAPE_AHEAD, count - 1)];
    if (ahead != DRAPE_NO_FEATURE) askFor(hits + ahead);
    return kept[i];
}

// `parts` work-items (1, 2 or 4) share a place of the members' list, and go through their part: they copy the hit that stays
// there, if one does. keptFirst: where the contacts of each slot begin. contacts: behind a head with the counters.
__kernel void reductionWrite(__global const Contact* restrict hits, const uint hitCapacity,
                             __global const uint* restrict slotFirst, const uint parts,
                             __global const uint* restrict kept, __global const uint* restrict keptFirst,
                             __global Contact* restrict contacts, __global const StepCounters* restrict counters)
{
    const uint count = min(counters->m_listed, hitCapacity);
    if (get_global_id(0) == 0) *(__global StepCounters*)contacts = *counters;
    for (ItemRuns runs = itemRuns(count, parts); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item, member = keptAt(hits, kept, i, count);
        if (member == DRAPE_NO_FEATURE) continue;
        const uint slot = hits[member].m_slot;
        copyHit(contacts + DRAPE_CONTACT_HEAD + keptFirst[slot] + i - slotFirst[slot], hits + member, parts);
    }
}

// The same where slots are few, on a GPU, without a launch before it that places them: keptSums are sums over slotKept.
// Leaves slotCount and slotSums zero for the next step.
__kernel void reductionWriteFew(__global const Contact* restrict hits, const uint hitCapacity,
                                __global const uint* restrict slotFirst, const uint slots, const uint parts,
                                __global const uint* restrict kept, __global const uint* restrict slotKept,
                                __global const uint* restrict keptSums, __global Contact* restrict contacts,
                                __global const StepCounters* restrict counters, __global uint* restrict slotCount,
                                __global uint* restrict slotSums)
{
    __local uint wide[DRAPE_WIDE_SUMS];
    const uint count = min(counters->m_listed, hitCapacity);
    sumRows(keptSums, wide);
    clearSums(slotCount, slotSums, slots);
    if (get_global_id(0) == 0)
    {
        StepCounters all = *counters;
        all.m_hits = sumOfWide(wide, DRAPE_WIDE_SUMS);
        *(__global StepCounters*)contacts = all;
    }
    for (ItemRuns runs = itemRuns(count, parts); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item, member = keptAt(hits, kept, i, count);
        if (member == DRAPE_NO_FEATURE) continue;
        const uint slot = hits[member].m_slot;
        const uint place = hitsBefore(slotKept, keptSums, wide, slot) + i - slotFirst[slot];
        copyHit(contacts + DRAPE_CONTACT_HEAD + place, hits + member, parts);
    }
}
