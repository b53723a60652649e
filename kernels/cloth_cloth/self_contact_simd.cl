// Narrow phase of cloths with themselves on a CPU, like narrow_phase_simd.cl for contacts with obstacles.
#include "../lib/cloth_cloth/lane_self_contacts.h"
#include "../lib/cloth_cloth/self_tests.h"
#include "../lib/narrow_phase/lane_runs.h"

typedef char SelfRowsFit[DRAPE_SELF_ROWS <= DRAPE_LANE_ROWS ? 1 : -1];

struct LaneWork
{
    __global const FeatureTest* m_tests;
    SelfView m_view;
    uint m_firstFeature;
    ContactSink m_sink;
    __global uint* m_swept;
    __global StepCounters* m_counters;
};

static uint kindOf(const LaneWork* work, const uint item)
{
    return work->m_tests[item].m_motion;
}

static void testOne(LaneWork* work, const uint item)
{
    testSelf(work->m_tests, item, &work->m_view, work->m_firstFeature, &work->m_sink, work->m_swept, work->m_counters);
}

// Loads the positions of a test: the node and the face's corners, or the ends of both edges.
static void nodesOf(uint* nodes, const SelfView* view, const FeatureTest test)
{
    if (test.m_motion == DRAPE_SELF_TEST_NODE)
    {
        nodes[0] = test.m_cloth;
        for (int k = 0; k < 3; ++k)
            nodes[1 + k] = view->m_cloth.m_triangles[test.m_lane].m_vertices[k];
        return;
    }
    for (int k = 0; k < 2; ++k)
    {
        nodes[k] = view->m_cloth.m_edges[test.m_cloth].m_vertices[k];
        nodes[2 + k] = view->m_cloth.m_edges[test.m_lane].m_vertices[k];
    }
}

// See lane_self_contacts.h for the rows.
static void putTest(float* rows, const uint lane, LaneWork* work, const uint item)
{
    const FeatureTest test = work->m_tests[item];
    const SelfView* view = &work->m_view;
    uint nodes[DRAPE_SELF_POSITIONS];
    nodesOf(nodes, view, test);
    for (uint k = 0; k < DRAPE_SELF_POSITIONS; ++k)
    {
        putVec3(rows, 3 * k, lane, vec3Load(view->m_cloth.m_start, nodes[k]));
        putVec3(rows, 3 * (DRAPE_SELF_POSITIONS + k), lane, vec3Load(view->m_cloth.m_end, nodes[k]));
        putVec3(rows, 3 * (2 * DRAPE_SELF_POSITIONS + k), lane, vec3Load(view->m_rest, nodes[k]));
    }
    putNumber(rows, DRAPE_SELF_ROWS - 1, lane, test.m_reach);
}

static void askLanes(LaneContacts* contacts, const float* rows, const LaneWork* work, const uint kind)
{
    const uint mode = work->m_view.m_cloth.m_mode;
    if (kind == DRAPE_SELF_TEST_NODE)
        laneSelfNodeFace(contacts, rows, mode, work->m_view.m_reachScale);
    else
        laneSelfEdgeEdge(contacts, rows, mode, work->m_view.m_reachScale);
}

static int takeContact(const NearContact* near, const float* rows, const uint lane, const LaneWork* work,
                       const uint item, Contact* contact)
{
    const FeatureTest test = work->m_tests[item];
    const ClothView* cloth = &work->m_view.m_cloth;
    const int edges = test.m_motion == DRAPE_SELF_TEST_EDGE;
    const Vec3 origin = rowOf(rows, 3 * (DRAPE_SELF_POSITIONS + (edges ? 2 : 0)), lane);
    int found = DRAPE_IS_CONTACT;
    nameSelfFeatures(contact, cloth, test, work->m_firstFeature);
    if (edges)
        storeNear(near, near->m_point, near->m_weights, contact);
    else
        found = acceptSelfNode(near, cloth, cloth->m_triangles + test.m_lane, origin, contact);
    return finishContact(found, origin, contact);
}

// Runs a work-item's part of the tests, and lists their contacts. Tests that need the continuous test go to `swept`,
// unsorted. counters->m_selfSwept must be zero before.
static void runSelfTests(const SelfInput* input, const ContactSink* sink, __global uint* swept,
                         __global StepCounters* counters)
{
    LaneWork work = {input->m_tests, input->m_view, input->m_firstFeature, *sink, swept, counters};
    const uint count = input->m_count;
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextRun(&runs))
        testRun(&work, runs.m_item, runs.m_end, input->m_view.m_cloth.m_mode, sink);
}

#ifdef __OPENCL_VERSION__
#include "self_arena_views.h"

// CPU version of selfFeature in self_contact.cl.
__kernel void selfFeature(DRAPE_SELF_FEATURE)
{
    const SelfInput input = selfInput(&values, tests, counters, nodes, rest, cloths, 0);
    const ContactSink sink =
        contactSink(contacts, values.m_contactCapacity, ranks, featureCounts, values.m_sums, counters);
    runSelfTests(&input, &sink, swept, counters);
}
#endif
