// Tests of cloths with themselves that a cull lists: their input data, and how to run one. For kernels only.
#ifndef DRAPE_LIB_SELF_TESTS_H
#define DRAPE_LIB_SELF_TESTS_H

#include "hit_list.h"
#include "self_contact.h"

// rest: x y z per node, m.
#define DRAPE_SELF_ARGUMENTS                                                                                              \
    __global const FeatureTest *restrict tests, const uint testCapacity, __global const float *restrict start,            \
        __global const float *restrict end, __global const float *restrict rest, __global const Triangle *restrict triangles, \
        __global const Edge *restrict edges, const uint nodeCount, const uint triangleCount, const uint firstSlot,        \
        const uint mode, const float reachScale, DRAPE_HIT_ARGUMENTS
#define DRAPE_SELF_VIEW(searches) \
    selfView(clothView(start, end, triangles, edges, nodeCount, triangleCount, mode, searches), rest, reachScale)

// Tests the item-th pair. Lists its contact, or the test in `swept` if only the continuous test can decide.
static void testSelf(__global const FeatureTest* tests, const uint item, const SelfView* view, const uint firstSlot,
                     const HitList* list, __global uint* swept, __global StepCounters* counters)
{
    Contact contact;
    const int found = selfContact(view, tests[item], firstSlot, &contact);
    if (found == DRAPE_IS_CONTACT)
        listHit(list, &contact);
    else if (found == DRAPE_UNDECIDED)
        swept[atomic_inc(&counters->m_selfSwept)] = item;
}

#endif
