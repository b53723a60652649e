// Does the work of two or three launches of ordering.cl in one, for few features on a GPU: every work-item sums the
// features before its own.
#include "../lib/narrow_phase/list_contacts.h"
#include "ordering_bindings.h"

// Stores where a feature's contacts begin, and records whether they exceed `ranked`.
static void placeFeature(__global const uint* featureCounts, __global const uint* sums, __local const uint* wide,
                         const uint feature, const uint ranked, __global uint* restrict firsts,
                         __global StepCounters* restrict counters)
{
    firsts[feature] = contactsBefore(featureCounts, sums, wide, feature);
    if (featureCounts[feature] > ranked) atomic_inc(&counters->m_crowded);
}

// Processes features, and contacts, which a work-item lists among their features' members. ranks, featureCounts: see
// ContactSink. firsts: first position of each feature's members. keys, members: see orderingGather. Leaves the next
// step's counters zero.
__kernel void orderingGatherSmall(DRAPE_ORDERING_GATHER_SMALL)
{
    __local uint wide[DRAPE_WIDE_SUMS];
    __global const uint* sums = featureCounts + values.m_sums;
    const uint count = min(counters->m_contactsFound, values.m_capacity), features = values.m_features;
    const uint id = get_global_id(0), size = get_global_size(0);
    sumRows(sums, wide);
    if (id < sizeof(StepCounters) / sizeof(uint)) ((__global uint*)next)[id] = 0;
    if (id == 0) counters->m_contactsStored = count;
    for (uint feature = id; feature < features; feature += size)
        placeFeature(featureCounts, sums, wide, feature, values.m_ranked, firsts, counters);
    // Starts with the work-items that have processed one feature less.
    for (uint i = (id + size - features % size) % size; i < count; i += size)
    {
        const uint feature = unsorted[i].m_featureIndex;
        const uint index = contactsBefore(featureCounts, sums, wide, feature) + ranks[i];
        members[index] = i;
        keys[index] = unsorted[i].m_obstacleFeature;
    }
}
