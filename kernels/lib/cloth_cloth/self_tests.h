// Tests of cloths with themselves that a cull lists: their input data, and how to run one. For kernels only.
#ifndef DRAPE_LIB_SELF_TESTS_H
#define DRAPE_LIB_SELF_TESTS_H

#include "../narrow_phase/list_contacts.h"
#include "self_views.h"

// Tests the item-th pair. Lists its contact, or the test in `swept` if only the continuous test can decide.
static void testSelf(__global const FeatureTest* tests, const uint item, const SelfView* view, const uint firstFeature,
                     const ContactSink* sink, __global uint* swept, __global StepCounters* counters)
{
    Contact contact;
    const int found = selfContact(view, tests[item], firstFeature, &contact);
    if (found == DRAPE_IS_CONTACT)
        listContact(sink, &contact);
    else if (found == DRAPE_UNDECIDED)
        swept[atomic_inc(&counters->m_selfSwept)] = item;
}

#endif
