// Narrow phase of cloths with themselves. Launches have a fixed width: the list's length is only on the device.
#include "../lib/item_runs.h"
#include "../lib/self_tests.h"

#ifndef DRAPE_CPU
// Runs the tests that the cull lists, each work-item its part, and lists the contacts. Tests that need the continuous
// test go to `swept`, unsorted. counters->m_selfSwept must be zero before. A CPU's selfFeature is in
// self_contact_simd.cl.
__kernel void selfFeature(DRAPE_SELF_ARGUMENTS, __global uint* restrict swept)
{
    const HitList list = DRAPE_HIT_LIST;
    const SelfView view = DRAPE_SELF_VIEW(0);
    const uint count = min(counters->m_selfTests, testCapacity);
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
        testSelf(tests, runs.m_item, &view, firstSlot, &list, swept, counters);
}
#endif

// Runs the tests that selfFeature left to the continuous test, each work-item its part, and lists their contacts.
__kernel void selfSwept(DRAPE_SELF_ARGUMENTS, __global const uint* restrict swept)
{
    const HitList list = DRAPE_HIT_LIST;
    uint searches = 0;
    const SelfView view = DRAPE_SELF_VIEW(&searches);
    const uint count = counters->m_selfSwept;
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        Contact contact;
        if (selfContact(&view, tests[swept[runs.m_item]], firstSlot, &contact) == DRAPE_IS_CONTACT)
            listHit(&list, &contact);
    }
}
