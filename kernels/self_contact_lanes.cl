// Narrow phase of cloths with themselves on a CPU: as narrow_phase_lanes.cl does the contacts with obstacles.
#include "lib/hit_list.h"
#include "lib/item_runs.h"
#include "lib/lane_self_contacts.h"
#include "lib/team.h"

#define DRAPE_SELF_KINDS 2

// What a work-item's tests need.
typedef struct SelfTests
{
    __global const FeatureTest* m_tests;
    SelfView m_view;
    uint m_firstSlot;
    HitList m_list;
    __global uint* m_swept;
    __global StepCounters* m_counters;
} SelfTests;

static void testOne(const SelfTests* work, const uint item)
{
    Contact contact;
    const int found = selfContact(&work->m_view, work->m_tests[item], work->m_firstSlot, &contact);
    if (found == DRAPE_IS_CONTACT)
        listHit(&work->m_list, &contact);
    else if (found == DRAPE_UNDECIDED)
        work->m_swept[atomic_inc(&work->m_counters->m_selfSwept)] = item;
}

// The positions of a test: the node and the face's corners, or the ends of both edges.
static void nodesOf(uint* nodes, const SelfView* view, const FeatureTest test)
{
    if (test.m_motion == DRAPE_SELF_TEST_NODE)
    {
        nodes[0] = test.m_cloth;
        for (int k = 0; k < 3; ++k) nodes[1 + k] = view->m_cloth.m_triangles[test.m_lane].m_vertices[k];
        return;
    }
    for (int k = 0; k < 2; ++k)
    {
        nodes[k] = view->m_cloth.m_edges[test.m_cloth].m_vertices[k];
        nodes[2 + k] = view->m_cloth.m_edges[test.m_lane].m_vertices[k];
    }
}

static void putTest(float* rows, const uint lane, const SelfView* view, const FeatureTest test)
{
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

// Asks what a contact of a lane depends on besides, and stores it. rows: where its test was put.
static int takeContact(const SelfTests* work, const LaneContacts* contacts, const float* rows, const uint lane,
                       const FeatureTest test, const int asks, Contact* contact)
{
    const ClothView* cloth = &work->m_view.m_cloth;
    const int edges = test.m_motion == DRAPE_SELF_TEST_EDGE;
    const Vec3 point = vec3Of(&contacts->m_point, lane), weights = vec3Of(&contacts->m_weights, lane);
    const Vec3 origin = rowOf(rows, 3 * (DRAPE_SELF_POSITIONS + (edges ? 2 : 0)), lane);
    if (asks && nearerBeyond(cloth, cloth->m_triangles + test.m_lane, origin, point, weights,
                             DRAPE_SEAM * laneOf(&contacts->m_distance, lane)))
        return DRAPE_NO_CONTACT;
    nameSelfFeatures(contact, cloth, test, work->m_firstSlot);
    storeContact(contact, vec3Of(&contacts->m_normal, lane), point, weights, laneOf(&contacts->m_gap0, lane),
                 laneOf(&contacts->m_gap1, lane), 1.0f);
    return finishContact(DRAPE_IS_CONTACT, origin, contact);
}

// Tests items[0] … items[count - 1], all of one kind, at most one a lane.
static void testLanes(const SelfTests* work, const uint kind, const uint* items, const uint count)
{
    float rows[DRAPE_SELF_ROWS * DRAPE_LANES];
    LaneContacts contacts;
    Contact hits[DRAPE_LANES];
    uint hitCount = 0;
    for (uint lane = 0; lane < DRAPE_LANES; ++lane)
        putTest(rows, lane, &work->m_view, work->m_tests[items[min(lane, count - 1)]]);
    if (kind == DRAPE_SELF_TEST_NODE)
        laneSelfNodeFace(&contacts, rows, work->m_view.m_cloth.m_mode, work->m_view.m_reachScale);
    else
        laneSelfEdgeEdge(&contacts, rows, work->m_view.m_cloth.m_mode, work->m_view.m_reachScale);
    const uint used = (1u << count) - 1u, asking = laneBits(contacts.m_asks);
    for (uint left = laneBits(contacts.m_found) & used; left; left &= left - 1)
    {
        const uint lane = 31 - clz(left & -left);
        hitCount += takeContact(work, &contacts, rows, lane, work->m_tests[items[lane]], asking >> lane & 1u,
                                hits + hitCount) == DRAPE_IS_CONTACT;
    }
    listHits(&work->m_list, hits, hitCount);
    for (uint left = laneBits(contacts.m_open) & used; left; left &= left - 1) testOne(work, items[31 - clz(left & -left)]);
}

// Tests a run of items, at most DRAPE_MOST_RUN.
static void testRun(const SelfTests* work, const uint first, const uint end)
{
    uint items[DRAPE_SELF_KINDS][DRAPE_MOST_RUN], counts[DRAPE_SELF_KINDS] = {0, 0};
    for (uint item = first; item < end; ++item)
    {
        const uint kind = work->m_tests[item].m_motion;
        items[kind][counts[kind]++] = item;
    }
    const int bySearch = work->m_view.m_cloth.m_mode == DRAPE_CONTINUOUS;
    for (uint kind = 0; kind < DRAPE_SELF_KINDS; ++kind)
    {
        for (uint i = 0; i < counts[kind]; i += DRAPE_LANES)
        {
            const uint count = min(counts[kind] - i, (uint)DRAPE_LANES);
            if (count >= DRAPE_FEWEST_LANES && !bySearch)
                testLanes(work, kind, items[kind] + i, count);
            else
                for (uint k = 0; k < count; ++k) testOne(work, items[kind][i + k]);
        }
    }
}

// As selfFeature of self_contact.cl.
__kernel void selfFeature(__global const FeatureTest* restrict tests, const uint testCapacity,
                          __global const float* restrict start, __global const float* restrict end,
                          __global const float* restrict rest, __global const Triangle* restrict triangles,
                          __global const Edge* restrict edges, const uint nodeCount, const uint triangleCount,
                          const uint firstSlot, const uint mode, const float reachScale, __global uint* restrict swept,
                          DRAPE_HIT_ARGUMENTS)
{
    const HitList list = DRAPE_HIT_LIST;
    const SelfTests work = {
        tests, selfView(clothView(start, end, triangles, edges, nodeCount, triangleCount, mode, 0), rest, reachScale),
        firstSlot, list, swept, counters};
    const uint count = min(counters->m_selfTests, testCapacity);
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextRun(&runs))
        testRun(&work, runs.m_item, runs.m_end);
}
