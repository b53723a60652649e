// Narrow phase of cloths with themselves. Launches have a fixed width: the list's length is only on the device.
#include "../lib/cloth_cloth/self_tests.h"
#include "../lib/work_items/item_runs.h"

// Runs a work-item's part of the tests that were left to the continuous test, and lists their contacts. The input's
// cloth counts the searches.
static void runSweptSelfTests(const SelfInput* input, const ContactSink* sink, __global const uint* swept,
                              __global const StepCounters* counters)
{
    const uint count = counters->m_selfSwept;
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        Contact contact;
        if (selfContact(&input->m_view, input->m_tests[swept[runs.m_item]], input->m_firstFeature, &contact) ==
            DRAPE_IS_CONTACT)
            listContact(sink, &contact);
    }
}

#ifdef __OPENCL_VERSION__
#include "self_arena_views.h"

#ifndef DRAPE_CPU
// Runs the tests that the cull lists, each work-item its part, and lists the contacts. Tests that need the continuous
// test go to `swept`, unsorted. counters->m_selfSwept must be zero before. A CPU's selfFeature is in
// self_contact_simd.cl.
__kernel void selfFeature(DRAPE_SELF_FEATURE)
{
    const SelfInput input = selfInput(&values, tests, counters, nodes, rest, cloths, 0);
    const ContactSink sink =
        contactSink(contacts, values.m_contactCapacity, ranks, featureCounts, values.m_sums, counters);
    for (ItemRuns runs = itemRuns(input.m_count, 1); runs.m_item < input.m_count; nextItem(&runs))
        testSelf(tests, runs.m_item, &input.m_view, input.m_firstFeature, &sink, swept, counters);
}
#endif

// Runs the tests that selfFeature left to the continuous test.
__kernel void selfSwept(DRAPE_SELF_SWEPT)
{
    uint searches = 0;
    const SelfInput input = selfInput(&values, tests, counters, nodes, rest, cloths, &searches);
    const ContactSink sink =
        contactSink(contacts, values.m_contactCapacity, ranks, featureCounts, values.m_sums, counters);
    runSweptSelfTests(&input, &sink, swept, counters);
}
#endif
