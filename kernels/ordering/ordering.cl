// Ordering puts unsorted contacts into canonical order: by cloth feature, then by obstacle feature.
//
// The method is a counting sort over the features: sums per block, the first position of every feature, the members of
// every feature, and the position of each contact among them. That position comes from counting where a feature has few
// members, from a sort where it has many. On a GPU, few features take one or two launches less (ordering_small.cl).
#include "../lib/work_items/prefetch.h"
#include "../lib/work_items/group_scan.h"
#include "../lib/work_items/item_runs.h"
#include "../lib/narrow_phase/list_contacts.h"
#include "../lib/ordering/member_order.h"
#include "ordering_bindings.h"

// Features per work-group. Each work-item takes DRAPE_BLOCK / group size adjacent ones.
#define DRAPE_BLOCK 1024

static uint countShare(__global const uint* featureCounts, const uint features, uint* first, uint* last)
{
    const uint share = DRAPE_BLOCK / get_local_size(0);
    *first = min(features, (uint)(get_group_id(0) * DRAPE_BLOCK + get_local_id(0) * share));
    *last = min(features, *first + share);
    uint sum = 0;
    for (uint feature = *first; feature < *last; ++feature)
        sum += featureCounts[feature];
    return sum;
}

// Sums the contacts of one block of features per work-group. scratch: one uint per work-item.
__kernel void orderingCount(DRAPE_ORDERING_COUNT)
{
    uint first, last, total;
    groupPrefix(scratch, countShare(featureCounts, values.m_features, &first, &last), &total);
    if (get_local_id(0) == 0) blockCounts[get_group_id(0)] = total;
}

// Writes where the contacts of each feature of the group's block begin, the first at `index`, and counts the features
// that have more than `ranked`. Returns where the contacts after the block begin.
static uint placeBlock(__global const uint* restrict featureCounts, const uint features, const uint ranked,
                       const uint index, __global uint* restrict firsts, __global StepCounters* restrict counters,
                       __local uint* scratch)
{
    uint first, last, total;
    uint next = index + groupPrefix(scratch, countShare(featureCounts, features, &first, &last), &total);
    for (uint feature = first; feature < last; ++feature)
    {
        firsts[feature] = next;
        next += featureCounts[feature];
        if (featureCounts[feature] > ranked) atomic_inc(&counters->m_crowded);
    }
    return index + total;
}

// Processes a block of features per work-group, and sums the contacts of all earlier features. The last group stores
// counters->m_contactsStored. sums: of blocks, by orderingCount, and m_block 1; for few features sums is featureCounts,
// and m_block DRAPE_BLOCK. m_ranked: maximum contacts of a feature that the next launch sorts itself; features with
// more are counted.
__kernel void orderingPlace(DRAPE_ORDERING_PLACE)
{
    const uint before = groupSumOf(sums, get_group_id(0) * values.m_block, scratch);
    const uint found = placeBlock(featureCounts, values.m_features, values.m_ranked, before, firsts, counters, scratch);
    if (get_group_id(0) == get_num_groups(0) - 1 && get_local_id(0) == 0) counters->m_contactsStored = found;
}

// Lists each contact among its feature's members. A work-item goes through its part of the contacts' list; the atomic
// gives each contact its own position, filled from last to first. keys: the obstacle features of members. Leaves
// featureCounts and the next step's counters zero.
__kernel void orderingGather(DRAPE_ORDERING_GATHER)
{
    const uint count = min(counters->m_contactsFound, values.m_capacity);
    if (get_global_id(0) < sizeof(StepCounters) / sizeof(uint)) ((__global uint*)next)[get_global_id(0)] = 0;
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        const uint feature = unsorted[i].m_featureIndex;
        const uint index = firsts[feature] + atomic_dec(featureCounts + feature) - 1;
        members[index] = i;
        keys[index] = unsorted[i].m_obstacleFeature;
    }
}

// Sorts the members of features with more than `ranked`, one work-group per block of at most DRAPE_BLOCK features.
// Their keys (see orderingGather) are invalid afterwards.
__kernel void orderingSort(DRAPE_ORDERING_SORT)
{
    __local uint crowded[DRAPE_BLOCK], own[DRAPE_COUNTED], ownKeys[DRAPE_COUNTED];
    __local uint crowdedCount;
    const uint count = min(counters->m_contactsStored, values.m_capacity), features = values.m_features;
    const uint begin = get_group_id(0) * values.m_block;
    const uint end = min(features, begin + values.m_block);
    if (get_local_id(0) == 0) crowdedCount = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint feature = begin + get_local_id(0); feature < end; feature += get_local_size(0))
    {
        const uint last = feature + 1 < features ? min(firsts[feature + 1], count) : count;
        if (last > firsts[feature] && last - firsts[feature] > values.m_ranked)
            crowded[atomic_inc(&crowdedCount)] = feature;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint toSort = crowdedCount;
    for (uint i = 0; i < toSort; ++i)
    {
        const uint feature = crowded[i], first = firsts[feature];
        const uint last = feature + 1 < features ? min(firsts[feature + 1], count) : count;
        orderMembers(members + first, keys + first, last - first, own, ownKeys);
    }
}

// Copies each contact to its position in canonical order. `parts` work-items (1, 2 or 4) share a contact, and each
// goes through its part of the members' list. They count the members of the same feature with a lesser obstacle
// feature; that number is the contact's position in its feature. Where the feature has more members than `ranked`,
// orderingSort has sorted them and the contact keeps its position. A feature pair is tested once, so obstacle features
// of a cloth feature differ and every position is written once. keys: see orderingGather. contacts: behind a head with
// the counters. Leaves featureCounts and their sums zero for the next step where there are sums.
__kernel void orderingWrite(DRAPE_ORDERING_WRITE)
{
    const uint count = min(counters->m_contactsStored, values.m_capacity), features = values.m_features;
    if (values.m_sums > 0) clearSums(featureCounts, featureCounts + values.m_sums, features);
    if (get_global_id(0) == 0) *(__global StepCounters*)contacts = *counters;
    for (ItemRuns runs = itemRuns(count, values.m_parts); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        prefetchWord(unsorted + members[min(i + DRAPE_AHEAD, count - 1)]);
        __global const Contact* contact = unsorted + members[i];
        const uint feature = contact->m_featureIndex, first = firsts[feature];
        const uint last = feature + 1 < features ? min(firsts[feature + 1], count) : count;
        const int sorted = last - first > values.m_ranked;
        const uint key = keys[i];
        uint before = 0;
#ifndef DRAPE_CPU
        // Loads several keys together; on a GPU the loads would otherwise wait for each other.
        __attribute__((opencl_unroll_hint(DRAPE_TOGETHER)))
#endif
        for (uint j = first; j < last && !sorted; ++j) before += keys[j] < key;
        copyContact(contacts + DRAPE_CONTACT_HEAD + (sorted ? i : first + before), contact, values.m_parts);
    }
}
