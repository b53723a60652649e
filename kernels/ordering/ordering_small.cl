// Does the work of two or three launches of ordering.cl in one, for few slots on a GPU: every work-item sums the
// slots before its own.
#include "../lib/hit_list.h"

// Stores where a slot's contacts begin, and records whether they exceed `ranked`.
static void placeSlot(__global const uint* restrict slotCount, __global const uint* restrict slotSums,
                      __local const uint* wide, const uint slot, const uint ranked, __global uint* restrict slotFirst,
                      __global StepCounters* restrict counters)
{
    slotFirst[slot] = hitsBefore(slotCount, slotSums, wide, slot);
    if (slotCount[slot] > ranked) atomic_inc(&counters->m_crowded);
}

// Processes slots, and contacts, which a work-item lists among their slots' members. hitPlaces, slotCount, slotSums:
// see listHit(). slotFirst: first position of each slot's members. keys, members: see orderingGather. Leaves the
// next step's counters zero.
__kernel void orderingGatherFew(__global const Contact* restrict hits, const uint hitCapacity,
                                  __global const uint* restrict hitPlaces, __global const uint* restrict slotCount,
                                  __global const uint* restrict slotSums, const uint slots, const uint ranked,
                                  __global uint* restrict slotFirst, __global uint* restrict members,
                                  __global uint* restrict keys, __global StepCounters* restrict counters,
                                  __global StepCounters* restrict next)
{
    __local uint wide[DRAPE_WIDE_SUMS];
    const uint count = min(counters->m_contactsFound, hitCapacity), id = get_global_id(0), size = get_global_size(0);
    sumRows(slotSums, wide);
    if (id < sizeof(StepCounters) / sizeof(uint)) ((__global uint*)next)[id] = 0;
    if (id == 0) counters->m_contactsStored = count;
    for (uint slot = id; slot < slots; slot += size)
        placeSlot(slotCount, slotSums, wide, slot, ranked, slotFirst, counters);
    // Starts with the work-items that have processed one slot less.
    for (uint hit = (id + size - slots % size) % size; hit < count; hit += size)
    {
        const uint slot = hits[hit].m_slot;
        const uint place = hitsBefore(slotCount, slotSums, wide, slot) + hitPlaces[hit];
        members[place] = hit;
        keys[place] = hits[hit].m_obstacleFeature;
    }
}
