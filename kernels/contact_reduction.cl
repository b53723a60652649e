// Reduction of the hits of each slot (lib/contact_reduction.h), between the compaction's order and its writing. Slots with few
// hits are a work-item's, crowded ones a work-group's; both come to the same contacts.
#include "lib/contact_reduction.h"
#include "lib/group_scan.h"
#include "lib/hit_list.h"
#include "lib/item_runs.h"
#include "shared/patch.h"

// Most slots and work-items of a group.
#define DRAPE_BLOCK 1024
#define DRAPE_REDUCE_GROUP 64

// What is known of a member of a crowded slot; places of hits are less.
#define DRAPE_DROPPED 0x80000000u
#define DRAPE_KEEPER 0x40000000u

// Puts a few members in order: by depth, or by obstacle feature.
static void sortFew(__global const Contact* hits, __global uint* members, const uint count, const int byDepth)
{
    for (uint i = 1; i < count; ++i)
    {
        const uint member = members[i];
        uint j = i;
        for (; j > 0; --j)
        {
            __global const Contact* before = hits + members[j - 1];
            const int stays = byDepth ? isDeeper(before, hits + member)
                                      : before->m_obstacleFeature < hits[member].m_obstacleFeature;
            if (stays) break;
            members[j] = members[j - 1];
        }
        members[j] = member;
    }
}

// Contacts of a cloth with itself all stay: nothing rests there for others to be implied by.
static int isSelf(const SlotLists* lists, const uint first)
{
    return lists->m_hits[lists->m_members[first]].m_kind >= DRAPE_SELF_NODE_FACE;
}

// A work-item reduces a slot of at most DRAPE_RANKED members. Returns how many stay.
static uint reduceFew(const ReductionView* view, const SlotLists* lists, __global uint* kept, const uint first,
                      const uint count)
{
    for (uint i = 0; i < count; ++i) kept[first + i] = lists->m_members[first + i];
    uint stay = count;
    if (!isSelf(lists, first))
    {
        sortFew(lists->m_hits, kept + first, count, 1);
        stay = reduceSlot(view, lists, kept + first, count);
    }
    sortFew(lists->m_hits, kept + first, stay, 0);
    for (uint i = stay; i < count; ++i) kept[first + i] = DRAPE_NO_FEATURE;
    return stay;
}

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
    NodeBounds bounds = noBounds();
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        if (kept[i] & (DRAPE_DROPPED | DRAPE_KEEPER)) continue;
        __global const Contact* contact = lists->m_hits + kept[i];
        const uint pair = pairOf(view, feature->m_cloth, contact);
        if (!isReducible(view, contact, pair)) continue;
        boundNodes(view, lists, feature, contact, pair, &bounds);
        if (bounds.m_lack <= 0.0f || (keeper && impliedBy(view, feature, &bounds, contact, pair, keeper)))
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
    const ReducedFeature feature = reducedFeature(view, lists, lists->m_hits + lists->m_members[first]);
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

// A work-group takes a block of at most DRAPE_BLOCK slots. members: in order in slots with more than DRAPE_RANKED; they stay
// as they are, since faces and edges read those of their nodes. kept gets at the front of each slot the members that stay, in
// order, and DRAPE_NO_FEATURE behind them; slotKept their number. counters->m_hits is then free.
__kernel __attribute__((reqd_work_group_size(DRAPE_REDUCE_GROUP, 1, 1))) void reductionKeep(
    __global const Contact* restrict hits, const uint hitCapacity, __global const uint* restrict slotFirst,
    const uint slots, const uint block, __global const uint* restrict members, __global uint* kept,
    __global uint* restrict slotKept, __global const StepCounters* restrict counters, __global const float* restrict start,
    __global const float* restrict end, __global const Triangle* restrict triangles, __global const Edge* restrict edges,
    __global const MeshFirsts* restrict cloths, __global const MeshFirsts* restrict obstacles, const uint clothCount,
    const uint obstacleCount, __global const float* restrict thickness, __global const float* restrict tube)
{
    __local uint crowded[DRAPE_BLOCK];
    __local uint scratch[DRAPE_REDUCE_GROUP];
    __local uint crowdedCount;
    const ReductionView view = {start,     end,         triangles,     edges,     cloths,
                                obstacles, clothCount,  obstacleCount, thickness, tube};
    const SlotLists lists = {hits, members, slotFirst, slots, min(counters->m_hits, hitCapacity)};
    const uint begin = get_group_id(0) * block, last = min(slots, begin + block);
    if (get_local_id(0) == 0) crowdedCount = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint slot = begin + get_local_id(0); slot < last; slot += get_local_size(0))
    {
        const uint first = slotFirst[slot], stop = slotEnd(&lists, slot);
        const uint count = stop > first ? stop - first : 0;
        if (count > DRAPE_RANKED)
            crowded[atomic_inc(&crowdedCount)] = slot;
        else
            slotKept[slot] = count > 0 ? reduceFew(&view, &lists, kept, first, count) : 0;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint toReduce = crowdedCount;
    for (uint i = 0; i < toReduce; ++i)
    {
        const uint slot = crowded[i];
        const uint stay =
            reduceCrowded(&view, &lists, kept, slotFirst[slot], slotEnd(&lists, slot) - slotFirst[slot], scratch);
        if (get_local_id(0) == 0) slotKept[slot] = stay;
    }
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
        const uint i = runs.m_item;
        const uint member = kept[i];
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
