// Which hits of a slot stay that has more than a group holds, by the whole group. For OpenCL C only.
#ifndef DRAPE_LIB_CROWDED_SLOT_H
#define DRAPE_LIB_CROWDED_SLOT_H

#include "group_scan.h"
#include "reduction_slots.h"

// What is known of a member of a crowded slot; places of hits are less.
#define DRAPE_DROPPED 0x80000000u
#define DRAPE_KEEPER 0x40000000u

// The group's deepest member that nothing is known of, DRAPE_NO_FEATURE without one. Each work-item looks at its own.
static uint deepestLeft(const SlotLists* lists, __global const uint* kept, const uint count, __local uint* scratch)
{
    const uint id = get_local_id(0);
    uint best = DRAPE_NO_FEATURE;
    for (uint i = id; i < count; i += get_local_size(0))
    {
        if (kept[i] & (DRAPE_DROPPED | DRAPE_KEEPER)) continue;
        if (best == DRAPE_NO_FEATURE || isDeeper(lists->m_hits + kept[i], lists->m_hits + kept[best])) best = i;
    }
    scratch[id] = best;
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    uint width = get_local_size(0) / 2;
    do
    {
        if (id < width)
        {
            const uint a = scratch[id], b = scratch[id + width];
            if (a == DRAPE_NO_FEATURE ||
                (b != DRAPE_NO_FEATURE && isDeeper(lists->m_hits + kept[b], lists->m_hits + kept[a])))
                scratch[id] = b;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        width /= 2;
    } while (width > 0);
    best = scratch[0];
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    return best;
}

// Each work-item drops those of its own members that the nodes or the keeper, which may be null, imply.
static void dropImplied(const ReductionView* view, const SlotLists* lists, const ReducedFeature* feature,
                        __global uint* kept, const uint count, __global const Contact* keeper)
{
    NodeBounds bounds;
    ReducedContact before, deepest;
    int any = 0;  // bounds are those of before
    if (keeper) deepest = reducedContact(view, feature->m_cloth, keeper);
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        if (kept[i] & (DRAPE_DROPPED | DRAPE_KEEPER)) continue;
        __global const Contact* hit = lists->m_hits + kept[i];
        const ReducedContact contact = reducedContact(view, feature->m_cloth, hit);
        if (!isReducible(view, &contact, hit->m_time)) continue;
        boundNodes(view, lists, feature, &contact, any ? &before : 0, &bounds);
        before = contact;
        any = 1;
        if (bounds.m_lack <= 0.0f ||
            (keeper && impliedBy(view, feature->m_way, feature->m_count, &bounds, &contact, &deepest)))
            kept[i] |= DRAPE_DROPPED;
    }
}

// Brings the members that stay to the front in the order that they have. Returns how many they are.
static uint closeRanks(__global uint* kept, const uint count, __local uint* scratch)
{
    uint stay = 0, base = 0;
    do
    {
        const uint i = base + get_local_id(0);
        const uint member = i < count ? kept[i] : DRAPE_DROPPED;
        const uint stays = !(member & DRAPE_DROPPED);
        uint total;
        barrier(CLK_GLOBAL_MEM_FENCE);  // all of this stretch are read before any is written
        const uint before = groupPrefix(scratch, stays, &total);
        if (stays) kept[stay + before] = member & ~DRAPE_KEEPER;
        stay += total;
        base += get_local_size(0);
    } while (base < count);
    barrier(CLK_GLOBAL_MEM_FENCE);
    for (uint i = stay + get_local_id(0); i < count; i += get_local_size(0)) kept[i] = DRAPE_NO_FEATURE;
    return stay;
}

// A work-group reduces a slot whose members are in order: a round finds the deepest that is left and drops what it implies.
// Returns how many stay.
static uint reduceCrowded(const ReductionView* view, const SlotLists* lists, __global uint* kept, const uint first,
                          const uint count, __local uint* scratch)
{
    kept += first;
    for (uint i = get_local_id(0); i < count; i += get_local_size(0)) kept[i] = lists->m_members[first + i];
    if (isSelf(lists, first)) return count;
    __global const Contact* any = lists->m_hits + lists->m_members[first];
    const ReducedFeature feature = reducedFeature(view, lists, any->m_kind, any->m_clothFeature);
    if (feature.m_mayEmpty) dropImplied(view, lists, &feature, kept, count, 0);
    uint rounds = 0, deepest;
    do
    {
        deepest = deepestLeft(lists, kept, count, scratch);
        if (deepest != DRAPE_NO_FEATURE)
        {
            if (deepest % get_local_size(0) == get_local_id(0)) kept[deepest] |= DRAPE_KEEPER;
            dropImplied(view, lists, &feature, kept, count, lists->m_hits + lists->m_members[first + deepest]);
        }
        ++rounds;
    } while (deepest != DRAPE_NO_FEATURE && rounds < DRAPE_KEEPERS);
    return closeRanks(kept, count, scratch);
}

#endif
