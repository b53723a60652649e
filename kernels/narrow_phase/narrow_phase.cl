// Narrow phase over pairs of features. Launches have a fixed width: the list's length is only on the device.
#include "../lib/narrow_phase/feature_tests.h"

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
    uint index = item < count ? atomic_inc(kinds + kind) : 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < count)
    {
        for (uint k = 0; k < kind; ++k)
            index += kinds[k];
        order[index] = (ushort)lane;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return item < count ? first + order[lane] : count;
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

// Runs every stride-th of the tests that were left to the continuous test, and lists their contacts, unless there are
// more than mostSwept. None of these is a node's test: a node's path crosses a resting face in closed form. The
// input's cloth counts the searches.
static void runSweptTests(const FeatureInput* input, const ContactSink* sink, __global const uint* swept,
                          const uint mostSwept, __global const StepCounters* counters)
{
    ClothView cloth = input->m_cloth;
    const KindShare share = kindShare(1);
    const uint count = counters->m_swept <= mostSwept ? counters->m_swept : 0;
    for (uint i = share.m_first; i < count; i += share.m_stride)
    {
        const FeatureTest test = input->m_tests[swept[i]];
        Contact contact;
        if (kindOfTest(test) != share.m_kind) continue;
        cloth.m_motion = motionOfTest(input->m_motions, test);
        if (featureContact(test, &cloth, &input->m_obstacle, &input->m_patches, &contact) == DRAPE_IS_CONTACT)
            listContact(sink, &contact);
    }
}

#ifdef __OPENCL_VERSION__
#include "../lib/step_data/arena_views.h"
#include "narrow_phase_bindings.h"

static FeatureInput featureInput(const FeatureValues* values, __global const FeatureTest* tests, const uint count,
                                 const ClothView cloth, __global const ObstacleWord* obstacles,
                                 __global const PatchWord* patches, __global const ObstacleMotion* motions)
{
    FeatureInput input;
    input.m_tests = tests;
    input.m_count = count;
    input.m_cloth = cloth;
    input.m_obstacle = obstacleAt(obstacles, &values->m_obstacle);
    input.m_patches = patchesAt(patches, &values->m_patches);
    input.m_motions = motions;
    return input;
}

#ifndef DRAPE_CPU
// Runs the feature tests that the cull lists, each group its part, as many at a time as it has work-items, and lists
// the contacts. Tests that need the continuous test go to `swept`, unsorted. counters->m_swept must be zero before. A
// CPU's narrowPhaseFeature is in narrow_phase_simd.cl.
__kernel __attribute__((reqd_work_group_size(DRAPE_FEATURE_GROUP, 1, 1))) void narrowPhaseFeature(
    DRAPE_NARROW_PHASE_FEATURE)
{
    __local uint kinds[DRAPE_TEST_KINDS];
    __local ushort order[DRAPE_FEATURE_GROUP];
    const uint count = min(counters->m_candidates, values.m_testCapacity);
    ClothView cloth = clothAt(nodes, cloths, &values.m_cloth, values.m_mode, 0);
    const FeatureInput input = featureInput(&values, tests, count, cloth, obstacles, patches, motions);
    const ContactSink sink =
        contactSink(contacts, values.m_contactCapacity, ranks, featureCounts, values.m_sums, counters);
    for (uint first = get_group_id(0) * get_local_size(0); first < count; first += get_global_size(0))
    {
        const uint item = testByKind(tests, first, count, kinds, order);
        if (item < count)
            testFeature(tests, item, &cloth, &input.m_obstacle, &input.m_patches, motions, &sink, swept, counters);
    }
}
#endif

// Runs the tests that narrowPhaseFeature left to the continuous test.
__kernel void narrowPhaseSwept(DRAPE_NARROW_PHASE_SWEPT)
{
    uint searches = 0;
    const FeatureInput input =
        featureInput(&values, tests, 0, clothAt(nodes, cloths, &values.m_cloth, values.m_mode, &searches), obstacles,
                     patches, motions);
    const ContactSink sink =
        contactSink(contacts, values.m_contactCapacity, ranks, featureCounts, values.m_sums, counters);
    runSweptTests(&input, &sink, swept, values.m_most, counters);
}

// Runs both phases in one launch, for few tests: each runs the continuous test where it needs it. Does nothing if
// there are more than values.m_most.
__kernel void narrowPhaseSmall(DRAPE_NARROW_PHASE_SMALL)
{
    uint searches = 0;
    const uint count = counters->m_candidates <= values.m_most ? min(counters->m_candidates, values.m_testCapacity) : 0;
    ClothView cloth = clothAt(nodes, cloths, &values.m_cloth, values.m_mode, &searches);
    const FeatureInput input = featureInput(&values, tests, count, cloth, obstacles, patches, motions);
    const ContactSink sink =
        contactSink(contacts, values.m_contactCapacity, ranks, featureCounts, values.m_sums, counters);
    const KindShare share = kindShare(0);
    for (uint i = share.m_first; i < count; i += share.m_stride)
    {
        const FeatureTest test = tests[i];
        Contact contact;
        if (kindOfTest(test) != share.m_kind) continue;
        cloth.m_motion = motionOfTest(motions, test);
        if (featureContact(test, &cloth, &input.m_obstacle, &input.m_patches, &contact) == DRAPE_IS_CONTACT)
            listContact(&sink, &contact);
    }
    if (searches > 0) atomic_add(&counters->m_swept, searches);
}
#endif
