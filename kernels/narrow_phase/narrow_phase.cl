// Narrow phase over pairs of features. Launches have a fixed width: the list's length is only on the device.
#include "../lib/feature_tests.h"

#ifndef DRAPE_CPU
// Work-items of a group (kFeatureGroupGpu in narrow_phase.cpp).
#define DRAPE_FEATURE_GROUP 256

// Assigns a group's work-items as many tests, from `first` on, so that tests of one kind are adjacent: lanes of
// different kinds would wait for each other. Returns this work-item's test, or `count` if it has none. The whole
// group calls it together. The next turn's writes need no barrier: it clears `kinds` after everyone has passed the
// last one here, and writes `order` after two of its own.
static uint testByKind(__global const FeatureTest* tests, const uint first, const uint count, __local uint* kinds,
                       __local ushort* order)
{
    const uint lane = get_local_id(0), item = first + lane;
    if (lane < DRAPE_TEST_KINDS) kinds[lane] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint kind = item < count ? kindOfTest(tests[item]) : DRAPE_TEST_KINDS;
    uint place = item < count ? atomic_inc(kinds + kind) : 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < count)
    {
        for (uint k = 0; k < kind; ++k) place += kinds[k];
        order[place] = (ushort)lane;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return item < count ? first + order[lane] : count;
}

// Runs the feature tests that the cull lists, each group its part, as many at a time as it has work-items, and lists
// the contacts. Tests that need the continuous test go to `swept`, unsorted. counters->m_swept must be zero before. A
// CPU's narrowPhaseFeature is in narrow_phase_simd.cl.
__kernel __attribute__((reqd_work_group_size(DRAPE_FEATURE_GROUP, 1, 1))) void narrowPhaseFeature(
    DRAPE_FEATURE_ARGUMENTS, __global uint* restrict swept)
{
    DRAPE_FEATURE_VIEWS;
    __local uint kinds[DRAPE_TEST_KINDS];
    __local ushort order[DRAPE_FEATURE_GROUP];
    ClothView cloth = DRAPE_CLOTH_VIEW(0);
    const uint count = min(counters->m_candidates, testCapacity);
    for (uint first = get_group_id(0) * get_local_size(0); first < count; first += get_global_size(0))
    {
        const uint item = testByKind(tests, first, count, kinds, order);
        if (item < count) testFeature(tests, item, &cloth, &obstacle, &packed, motions, &list, swept, counters);
    }
}
#endif

// Divides the tests among groups by kind: groups alternate between the kinds. Lanes of different kinds in one group
// would wait for each other. Consecutive tests of a kind go to different groups, so that a few long tests do not
// delay each other. This applies to a CPU, too: compared with the tests themselves, misses of the cache cost little.
typedef struct KindShare
{
    uint m_kind, m_first, m_stride;
} KindShare;

// Divides the kinds from `kind` on. There must be a group for each.
static KindShare kindShare(const uint kind)
{
    KindShare share;
    const uint kinds = DRAPE_TEST_KINDS - kind;
    const uint groups = get_num_groups(0) / kinds, group = get_group_id(0);
    share.m_kind = kind + group % kinds;
    share.m_first = get_local_id(0) * groups + group / kinds;
    share.m_stride = get_local_size(0) * groups;
    if (group >= groups * kinds) share.m_first = UINT_MAX;  // one too many
    return share;
}

// Runs every stride-th of the tests that narrowPhaseFeature left to the continuous test, per work-item, and lists
// their contacts, unless there are more than mostSwept. None of these is a node's test: a node's path crosses a
// resting face in closed form.
__kernel void narrowPhaseSwept(DRAPE_FEATURE_ARGUMENTS, __global const uint* restrict swept, const uint mostSwept)
{
    DRAPE_FEATURE_VIEWS;
    uint searches = 0;
    ClothView cloth = DRAPE_CLOTH_VIEW(&searches);
    const KindShare share = kindShare(1);
    const uint count = counters->m_swept <= mostSwept ? counters->m_swept : 0;
    for (uint i = share.m_first; i < count; i += share.m_stride)
    {
        const FeatureTest test = tests[swept[i]];
        Contact contact;
        if (kindOfTest(test) != share.m_kind) continue;
        cloth.m_motion = motionOfTest(motions, test);
        if (featureContact(test, &cloth, &obstacle, &packed, &contact) == DRAPE_IS_CONTACT) listHit(&list, &contact);
    }
}

// Runs both phases in one launch, for few tests: each runs the continuous test where it needs it. Does nothing if
// there are more than mostTests.
__kernel void narrowPhaseFew(DRAPE_FEATURE_ARGUMENTS, const uint mostTests)
{
    DRAPE_FEATURE_VIEWS;
    uint searches = 0;
    ClothView cloth = DRAPE_CLOTH_VIEW(&searches);
    const KindShare share = kindShare(0);
    const uint count = counters->m_candidates <= mostTests ? min(counters->m_candidates, testCapacity) : 0;
    for (uint i = share.m_first; i < count; i += share.m_stride)
    {
        const FeatureTest test = tests[i];
        Contact contact;
        if (kindOfTest(test) != share.m_kind) continue;
        cloth.m_motion = motionOfTest(motions, test);
        if (featureContact(test, &cloth, &obstacle, &packed, &contact) == DRAPE_IS_CONTACT) listHit(&list, &contact);
    }
    if (searches > 0) atomic_add(&counters->m_swept, searches);
}
