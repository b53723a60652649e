// Narrow phase of cloths with themselves. Launches have a fixed width and walk the list in strides: its length is only on the
// device.
#include "lib/self_contact.h"

// Hits of the self tests lie behind the places of the obstacles' tests, of which there are obstacleCapacity at most; with 0 of
// those before all others.
static uint firstPlace(__global const StepCounters* counters, const uint obstacleCapacity)
{
    return min(counters->m_candidates, obstacleCapacity);
}

// A work-item takes every stride-th of the tests that selfCull lists and writes each hit at its test's place; a test without a
// hit leaves DRAPE_NO_FEATURE as slot, also one that needs the continuous test: those are listed in swept, in no particular
// order. rest: x y z per node, m. slotCount counts the hits of each slot; it and counters->m_selfSwept must be zero before.
__kernel void selfFeature(__global const FeatureTest* restrict tests, const uint testCapacity,
                          __global const float* restrict start, __global const float* restrict end,
                          __global const float* restrict rest, __global const Triangle* restrict triangles,
                          __global const Edge* restrict edges, const uint nodeCount, const uint triangleCount,
                          const uint firstSlot, const uint mode, const float reachScale, __global Contact* restrict hits,
                          const uint hitCapacity, const uint obstacleCapacity, __global uint* restrict swept,
                          __global volatile uint* slotCount, __global StepCounters* restrict counters)
{
    const SelfView view =
        selfView(clothView(start, end, triangles, edges, nodeCount, triangleCount, mode, 0), rest, reachScale);
    const uint first = firstPlace(counters, obstacleCapacity);
    const uint count = min(min(counters->m_selfTests, testCapacity), hitCapacity - first);
    if (get_global_id(0) == 0) counters->m_listed = first + count;
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        Contact contact;
        const int found = selfContact(&view, tests[i], firstSlot, &contact);
        if (found != DRAPE_IS_CONTACT)
        {
            if (found == DRAPE_UNDECIDED) swept[atomic_inc(&counters->m_selfSwept)] = i;
            hits[first + i].m_slot = DRAPE_NO_FEATURE;
            continue;
        }
        atomic_inc(slotCount + contact.m_slot);
        hits[first + i] = contact;
    }
}

// A work-item takes every stride-th of the tests that selfFeature left to the continuous test and writes their hits.
__kernel void selfSwept(__global const FeatureTest* restrict tests, __global const float* restrict start,
                        __global const float* restrict end, __global const float* restrict rest,
                        __global const Triangle* restrict triangles, __global const Edge* restrict edges,
                        const uint nodeCount, const uint triangleCount, const uint firstSlot, const uint mode,
                        const float reachScale, __global Contact* restrict hits, const uint obstacleCapacity,
                        __global const uint* restrict swept, __global volatile uint* slotCount,
                        __global const StepCounters* restrict counters)
{
    const SelfView view =
        selfView(clothView(start, end, triangles, edges, nodeCount, triangleCount, mode, 1), rest, reachScale);
    const uint first = firstPlace(counters, obstacleCapacity);
    for (uint i = get_global_id(0); i < counters->m_selfSwept; i += get_global_size(0))
    {
        const uint place = swept[i];
        Contact contact;
        if (selfContact(&view, tests[place], firstSlot, &contact) != DRAPE_IS_CONTACT) continue;
        atomic_inc(slotCount + contact.m_slot);
        hits[first + place] = contact;
    }
}
