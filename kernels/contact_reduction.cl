// Writes the hits that stay. Which these are is told before, by contact_reduction_hits.cl on a GPU and by
// contact_reduction_slots.cl on a CPU.
#include "lib/ask_for.h"
#include "lib/group_scan.h"
#include "lib/hit_list.h"
#include "lib/item_runs.h"
#include "shared/patch.h"

// Most slots of a work-group.
#define DRAPE_BLOCK 1024

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
        const uint i = runs.m_item;
        const uint member = kept[i], ahead = kept[min(i + DRAPE_AHEAD, count - 1)];
        if (ahead != DRAPE_NO_FEATURE) askFor(hits + ahead);
        if (member == DRAPE_NO_FEATURE) continue;
        const uint slot = hits[member].m_slot;
        copyHit(contacts + DRAPE_CONTACT_HEAD + keptFirst[slot] + i - slotFirst[slot], hits + member, parts);
    }
}

// The same where slots are few, without a launch before it that places them: a work-group takes `block` slots, at most
// DRAPE_BLOCK, and sums the contacts of those before. scratch: a uint per work-item.
__kernel void reductionWriteFew(__global const Contact* restrict hits, const uint hitCapacity,
                                __global const uint* restrict slotFirst, const uint slots, const uint block,
                                const uint parts, __global const uint* restrict kept,
                                __global const uint* restrict slotKept, __global Contact* restrict contacts,
                                __global const StepCounters* restrict counters, __local uint* scratch)
{
    __local uint shifts[DRAPE_BLOCK];  // from a slot's members to its contacts, modulo 2^32
    const uint id = get_local_id(0), size = get_local_size(0), count = min(counters->m_listed, hitCapacity);
    const uint begin = min(slots, (uint)(get_group_id(0) * block)), end = min(slots, begin + block);
    const uint before = groupSumOf(slotKept, begin, scratch);
    const uint share = (end - begin + size - 1) / size;
    const uint first = min(end, begin + id * share), last = min(end, first + share);
    uint sum = 0, total;
    for (uint slot = first; slot < last; ++slot) sum += slotKept[slot];
    uint next = before + groupPrefix(scratch, sum, &total);
    for (uint slot = first; slot < last; ++slot)
    {
        shifts[slot - begin] = next - slotFirst[slot];
        next += slotKept[slot];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (get_group_id(0) == get_num_groups(0) - 1 && id == 0)
    {
        StepCounters all = *counters;
        all.m_hits = before + total;
        *(__global StepCounters*)contacts = all;
    }
    if (begin == end) return;
    const uint from = slotFirst[begin], to = end < slots ? slotFirst[end] : count;
    for (uint k = from * parts + id; k < to * parts; k += size)
    {
        const uint i = k / parts, member = kept[i];
        if (member == DRAPE_NO_FEATURE) continue;
        const uint place = shifts[hits[member].m_slot - begin] + i;
        copyHit(contacts + DRAPE_CONTACT_HEAD + place, hits + member, parts);
    }
}
