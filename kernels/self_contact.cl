// Narrow phase of cloths with themselves. Launches have a fixed width: the list's length is only on the device.
#include "lib/hit_list.h"
#include "lib/item_runs.h"
#include "lib/self_contact.h"

#ifndef DRAPE_CPU
// A work-item goes through its part of the tests that the cull lists and lists the hits; the tests that need the continuous
// test it lists in swept, in no particular order. rest: x y z per node, m. counters->m_selfSwept must be zero before. A
// CPU's selfFeature is in self_contact_lanes.cl.
__kernel void selfFeature(__global const FeatureTest* restrict tests, const uint testCapacity,
                          __global const float* restrict start, __global const float* restrict end,
                          __global const float* restrict rest, __global const Triangle* restrict triangles,
                          __global const Edge* restrict edges, const uint nodeCount, const uint triangleCount,
                          const uint firstSlot, const uint mode, const float reachScale, __global uint* restrict swept,
                          DRAPE_HIT_ARGUMENTS)
{
    const HitList list = DRAPE_HIT_LIST;
    const SelfView view =
        selfView(clothView(start, end, triangles, edges, nodeCount, triangleCount, mode, 0), rest, reachScale);
    const uint count = min(counters->m_selfTests, testCapacity);
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        Contact contact;
        const int found = selfContact(&view, tests[i], firstSlot, &contact);
        if (found == DRAPE_IS_CONTACT)
            listHit(&list, &contact);
        else if (found == DRAPE_UNDECIDED)
            swept[atomic_inc(&counters->m_selfSwept)] = i;
    }
}
#endif

// A work-item goes through its part of the tests that selfFeature left to the continuous test and lists their hits.
__kernel void selfSwept(__global const FeatureTest* restrict tests, __global const float* restrict start,
                        __global const float* restrict end, __global const float* restrict rest,
                        __global const Triangle* restrict triangles, __global const Edge* restrict edges,
                        const uint nodeCount, const uint triangleCount, const uint firstSlot, const uint mode,
                        const float reachScale, __global const uint* restrict swept, DRAPE_HIT_ARGUMENTS)
{
    const HitList list = DRAPE_HIT_LIST;
    uint searches = 0;
    const SelfView view =
        selfView(clothView(start, end, triangles, edges, nodeCount, triangleCount, mode, &searches), rest, reachScale);
    const uint count = counters->m_selfSwept;
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        Contact contact;
        if (selfContact(&view, tests[swept[i]], firstSlot, &contact) == DRAPE_IS_CONTACT) listHit(&list, &contact);
    }
}
