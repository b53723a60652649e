// Narrow phase over pairs of features on a CPU: a work-item sorts a run of tests by kind, and does as many of one kind side by
// side as a vector has lanes.
#include "lib/feature_tests.h"
#include "lib/item_runs.h"
#include "lib/lane_contacts.h"
#include "lib/team.h"

// From `row` on.
static void putCone(float* rows, const uint row, const uint lane, const NormalCone cone)
{
    putVec3(rows, row, lane, cone.m_axis);
    putNumber(rows, row + 3, lane, cone.m_cosine);
}

// Puts the numbers of a test into its lane, see lane_contacts.h.
static void putTest(float* rows, const uint lane, const FeatureTest feature, const ClothView* cloth,
                    const PackedFeatures* packed)
{
    const uint test = feature.m_cloth >> DRAPE_TEST_SHIFT, packedLane = feature.m_lane;
    __global const Triangle* triangle = cloth->m_triangles + (feature.m_cloth & ((1u << DRAPE_TEST_SHIFT) - 1u));
    if (test < DRAPE_TEST_FACE)
    {
        const uint node = triangle->m_vertices[test];
        putVec3(rows, 0, lane, nodeStart(cloth, node));
        putVec3(rows, 3, lane, vec3Load(cloth->m_end, node));
        for (uint k = 0; k < 3; ++k)
            putVec3(rows, 6 + 3 * k, lane, laneVec3(packed->m_faces, DRAPE_FACE_FLOATS, packedLane, 3 * k));
        putNumber(rows, DRAPE_NODE_FACE_ROWS - 1, lane, feature.m_reach);
        return;
    }
    if (test == DRAPE_TEST_FACE)
    {
        for (uint k = 0; k < 3; ++k)
        {
            putVec3(rows, 3 * k, lane, nodeStart(cloth, triangle->m_vertices[k]));
            putVec3(rows, 9 + 3 * k, lane, vec3Load(cloth->m_end, triangle->m_vertices[k]));
        }
        putVec3(rows, 18, lane, laneVec3(packed->m_vertices, DRAPE_VERTEX_FLOATS, packedLane, 0));
        putCone(rows, 21, lane, laneCone(packed->m_vertices, DRAPE_VERTEX_FLOATS, packedLane));
        putNumber(rows, DRAPE_FACE_VERTEX_ROWS - 1, lane, feature.m_reach);
        return;
    }
    const uint edge = test - DRAPE_TEST_EDGE;
    for (uint k = 0; k < 2; ++k)
    {
        const uint node = triangle->m_vertices[(edge + k) % 3];
        putVec3(rows, 3 * k, lane, nodeStart(cloth, node));
        putVec3(rows, 6 + 3 * k, lane, vec3Load(cloth->m_end, node));
        putVec3(rows, 12 + 3 * k, lane, laneVec3(packed->m_edges, DRAPE_EDGE_FLOATS, packedLane, 3 * k));
    }
    putCone(rows, 18, lane, laneCone(packed->m_edges, DRAPE_EDGE_FLOATS, packedLane));
    putNumber(rows, DRAPE_EDGE_EDGE_ROWS - 1, lane, feature.m_reach);
}

// Asks what a contact of a lane depends on besides, and stores it. rows: where its test was put.
static int takeContact(const LaneContacts* contacts, const float* rows, const uint lane, const FeatureTest feature,
                       const ClothView* cloth, const ObstacleView* obstacle, const PackedFeatures* packed,
                       const int asks, Contact* contact)
{
    const uint test = feature.m_cloth >> DRAPE_TEST_SHIFT, index = feature.m_cloth & ((1u << DRAPE_TEST_SHIFT) - 1u);
    __global const Triangle* triangle = cloth->m_triangles + index;
    const Vec3 normal = vec3Of(&contacts->m_normal, lane), weights = vec3Of(&contacts->m_weights, lane);
    const Vec3 point = vec3Of(&contacts->m_point, lane);
    const float gap0 = laneOf(&contacts->m_gap0, lane), gap1 = laneOf(&contacts->m_gap1, lane);
    const uint row = test < DRAPE_TEST_FACE ? 6 : test == DRAPE_TEST_FACE ? 18 : 12;
    const Vec3 origin = rowOf(rows, row, lane);
    if (test < DRAPE_TEST_FACE)
    {
        const uint face = packed->m_faceIds[feature.m_lane];
        if (asks && !coneAdmits(closestFeatureCone(weights, obstacle->m_triangles + face, obstacle->m_vertexCones,
                                                   obstacle->m_edgeCones),
                                normal))
            return DRAPE_NO_CONTACT;
        nameFeatures(contact, cloth, DRAPE_NODE_FACE, triangle->m_vertices[test], face);
        storeContact(contact, normal, point, vec3(1.0f, 0.0f, 0.0f), gap0, gap1, 1.0f);
    }
    else if (test == DRAPE_TEST_FACE)
    {
        if (asks)
        {
            uint beyond[3];
            for (int edge = 0; edge < 3; ++edge) beyond[edge] = vertexBeyond(cloth, triangle, edge);
            if (neighbourIsNearer(weights, beyond, cloth->m_start, cloth->m_end, origin, point,
                                  vec3Of(&contacts->m_offset, lane), DRAPE_SEAM * laneOf(&contacts->m_distance, lane)))
                return DRAPE_NO_CONTACT;
        }
        nameFeatures(contact, cloth, DRAPE_FACE_VERTEX, index, packed->m_vertexIds[feature.m_lane]);
        storeContact(contact, normal, vec3(0.0f, 0.0f, 0.0f), weights, gap0, gap1, 1.0f);
    }
    else
    {
        nameFeatures(contact, cloth, DRAPE_EDGE_EDGE, triangle->m_edges[test - DRAPE_TEST_EDGE],
                     packed->m_edgeIds[feature.m_lane]);
        storeContact(contact, normal, point, weights, gap0, gap1, 1.0f);
    }
    return finishContact(DRAPE_IS_CONTACT, origin, contact);
}

// What a work-item's tests need.
typedef struct FeatureWork
{
    __global const FeatureTest* m_tests;
    ClothView m_cloth;
    ObstacleView m_obstacle;
    PackedFeatures m_packed;
    __global const ObstacleMotion* m_motions;
    HitList m_list;
    __global uint* m_swept;
    __global StepCounters* m_counters;
} FeatureWork;

static void testOne(FeatureWork* work, const uint item)
{
    testFeature(work->m_tests, item, &work->m_cloth, &work->m_obstacle, &work->m_packed, work->m_motions, &work->m_list,
                work->m_swept, work->m_counters);
}

// Tests items[0] … items[count - 1], all of one kind, at most one a lane.
static void testLanes(FeatureWork* work, const uint kind, const uint* items, const uint count)
{
    float rows[DRAPE_MOST_ROWS * DRAPE_LANES];
    LaneContacts contacts;
    for (uint lane = 0; lane < DRAPE_LANES; ++lane)
    {
        const FeatureTest test = work->m_tests[items[min(lane, count - 1)]];
        work->m_cloth.m_motion = motionOfTest(work->m_motions, test);
        putTest(rows, lane, test, &work->m_cloth, &work->m_packed);
    }
    if (kind == 0) laneNodeFace(&contacts, rows, work->m_cloth.m_mode);
    if (kind == 1) laneFaceVertex(&contacts, rows, work->m_cloth.m_mode);
    if (kind == 2) laneEdgeEdge(&contacts, rows, work->m_cloth.m_mode);
    const uint used = (1u << count) - 1u, asking = laneBits(contacts.m_asks), found = laneBits(contacts.m_found) & used;
    Contact hits[DRAPE_LANES];
    uint hitCount = 0;
    for (uint left = found; left; left &= left - 1)
    {
        const uint lane = 31 - clz(left & -left);
        hitCount += takeContact(&contacts, rows, lane, work->m_tests[items[lane]], &work->m_cloth, &work->m_obstacle,
                                &work->m_packed, asking >> lane & 1u, hits + hitCount) == DRAPE_IS_CONTACT;
    }
    listHits(&work->m_list, hits, hitCount);
    for (uint left = laneBits(contacts.m_open) & used; left; left &= left - 1) testOne(work, items[31 - clz(left & -left)]);
}

// Tests a run of items, at most DRAPE_MOST_RUN.
static void testRun(FeatureWork* work, const uint first, const uint end)
{
    uint items[DRAPE_TEST_KINDS][DRAPE_MOST_RUN], counts[DRAPE_TEST_KINDS] = {0, 0, 0};
    for (uint item = first; item < end; ++item)
    {
        const uint kind = kindOfTest(work->m_tests[item]);
        items[kind][counts[kind]++] = item;
    }
    const int bySearch = work->m_cloth.m_mode == DRAPE_CONTINUOUS;
    for (uint kind = 0; kind < DRAPE_TEST_KINDS; ++kind)
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

// A work-item goes through its part of the feature tests that patchCull lists and lists the hits; the tests that need the
// continuous test it lists in swept, in no particular order. counters->m_swept must be zero before.
__kernel void narrowPhaseFeature(DRAPE_FEATURE_ARGUMENTS, __global uint* restrict swept)
{
    DRAPE_FEATURE_VIEWS;
    FeatureWork work = {tests, DRAPE_CLOTH_VIEW(0), obstacle, packed, motions, list, swept, counters};
    const uint count = min(counters->m_candidates, testCapacity);
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextRun(&runs))
        testRun(&work, runs.m_item, runs.m_end);
}
