// Narrow phase over pairs of features on a CPU. A work-item sorts a run of tests by kind, and runs as many of one kind
// side by side as a vector has lanes.
#include "../lib/work_items/prefetch.h"
#include "../lib/narrow_phase/feature_tests.h"
#include "../lib/narrow_phase/lane_runs.h"

struct LaneWork
{
    __global const FeatureTest* m_tests;
    ClothView m_cloth;
    ObstacleView m_obstacle;
    PackedPatches m_packed;
    __global const ObstacleMotion* m_motions;
    ContactSink m_sink;
    __global uint* m_swept;
    __global StepCounters* m_counters;
};

static uint kindOf(const LaneWork* work, const uint item)
{
    return kindOfTest(work->m_tests[item]);
}

static void testOne(LaneWork* work, const uint item)
{
    testFeature(work->m_tests, item, &work->m_cloth, &work->m_obstacle, &work->m_packed, work->m_motions, &work->m_sink,
                work->m_swept, work->m_counters);
}

// Stores the cone in the rows from `row` on.
static void putCone(float* rows, const uint row, const uint lane, const NormalCone cone)
{
    putVec3(rows, row, lane, cone.m_axis);
    putNumber(rows, row + 3, lane, cone.m_cosine);
}

// See lane_contacts.h for the rows.
static void putTest(float* rows, const uint lane, LaneWork* work, const uint item)
{
    const FeatureTest feature = work->m_tests[item];
    ClothView* cloth = &work->m_cloth;
    const PackedPatches* packed = &work->m_packed;
    cloth->m_motion = motionOfTest(work->m_motions, feature);
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

static void askLanes(LaneContacts* contacts, const float* rows, const LaneWork* work, const uint kind)
{
    if (kind == 0) laneNodeFace(contacts, rows, work->m_cloth.m_mode);
    if (kind == 1) laneFaceVertex(contacts, rows, work->m_cloth.m_mode);
    if (kind == 2) laneEdgeEdge(contacts, rows, work->m_cloth.m_mode);
}

static int takeContact(const NearContact* near, const float* rows, const uint lane, const LaneWork* work,
                       const uint item, Contact* contact)
{
    const FeatureTest feature = work->m_tests[item];
    const ClothView* cloth = &work->m_cloth;
    const PackedPatches* packed = &work->m_packed;
    const uint test = feature.m_cloth >> DRAPE_TEST_SHIFT, index = feature.m_cloth & ((1u << DRAPE_TEST_SHIFT) - 1u);
    const uint row = test < DRAPE_TEST_FACE ? 6 : test == DRAPE_TEST_FACE ? 18 : 12;
    __global const Triangle* triangle = cloth->m_triangles + index;
    const Vec3 origin = rowOf(rows, row, lane);
    int found = DRAPE_IS_CONTACT;
    if (test < DRAPE_TEST_FACE)
    {
        const uint face = packed->m_faceIds[feature.m_lane];
        nameFeatures(contact, cloth, DRAPE_NODE_FACE, triangle->m_vertices[test], face);
        found = acceptNodeFace(near, &work->m_obstacle, face, contact);
    }
    else if (test == DRAPE_TEST_FACE)
    {
        nameFeatures(contact, cloth, DRAPE_FACE_VERTEX, index, packed->m_vertexIds[feature.m_lane]);
        found = acceptFaceVertex(near, cloth, triangle, origin, contact);
    }
    else
    {
        nameFeatures(contact, cloth, DRAPE_EDGE_EDGE, triangle->m_edges[test - DRAPE_TEST_EDGE],
                     packed->m_edgeIds[feature.m_lane]);
        storeNear(near, near->m_point, near->m_weights, contact);
    }
    return finishContact(found, origin, contact);
}

static void prefetchLane(__global const float* blocks, const uint floats, __global const uint* ids, const uint lane)
{
    __global const float* block = blocks + lane / DRAPE_PATCH_WIDTH * floats * DRAPE_PATCH_WIDTH;
    for (uint row = 0; row < floats; ++row)
        prefetchWord(block + row * DRAPE_PATCH_WIDTH);
    prefetchWord(ids + lane);
}

// Prefetches a test's data.
static void prefetchTest(const LaneWork* work, const FeatureTest feature)
{
    const PackedPatches* packed = &work->m_packed;
    const uint test = feature.m_cloth >> DRAPE_TEST_SHIFT, lane = feature.m_lane;
    prefetchWord(work->m_cloth.m_triangles + (feature.m_cloth & ((1u << DRAPE_TEST_SHIFT) - 1u)));
    if (test < DRAPE_TEST_FACE)
        prefetchLane(packed->m_faces, DRAPE_FACE_FLOATS, packed->m_faceIds, lane);
    else if (test == DRAPE_TEST_FACE)
        prefetchLane(packed->m_vertices, DRAPE_VERTEX_FLOATS, packed->m_vertexIds, lane);
    else
        prefetchLane(packed->m_edges, DRAPE_EDGE_FLOATS, packed->m_edgeIds, lane);
}

// Prefetches, once prefetchTest() has loaded the test's data, the data that it refers to.
static void prefetchNodes(const LaneWork* work, const FeatureTest feature)
{
    const ClothView* cloth = &work->m_cloth;
    const uint test = feature.m_cloth >> DRAPE_TEST_SHIFT;
    __global const Triangle* triangle = cloth->m_triangles + (feature.m_cloth & ((1u << DRAPE_TEST_SHIFT) - 1u));
    for (uint k = 0; k < 3; ++k)
    {
        if (test < DRAPE_TEST_FACE && k != test) continue;
        prefetchWord(cloth->m_start + 3 * triangle->m_vertices[k]);
        prefetchWord(cloth->m_end + 3 * triangle->m_vertices[k]);
    }
    if (test < DRAPE_TEST_FACE) prefetchWord(work->m_obstacle.m_triangles + work->m_packed.m_faceIds[feature.m_lane]);
}

static void prefetchRun(const LaneWork* work, const uint first, const uint end)
{
    for (uint item = first; item < end; ++item)
        prefetchTest(work, work->m_tests[item]);
    for (uint item = first; item < end; ++item)
        prefetchNodes(work, work->m_tests[item]);
}

// Number of tests from which their data is seldom in the caches.
#define DRAPE_FAR_TESTS (1u << 17)

// Runs a work-item's part of the feature tests, and lists their contacts. Tests that need the continuous test go to
// `swept`, unsorted. counters->m_swept must be zero before.
static void runFeatureTests(const FeatureInput* input, const ContactSink* sink, __global uint* swept,
                            __global StepCounters* counters)
{
    LaneWork work = {input->m_tests, input->m_cloth, input->m_obstacle, input->m_patches, input->m_motions,
                     *sink,          swept,          counters};
    const uint count = input->m_count;
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextRun(&runs))
    {
        if (count >= DRAPE_FAR_TESTS) prefetchRun(&work, runs.m_item, runs.m_end);
        testRun(&work, runs.m_item, runs.m_end, work.m_cloth.m_mode, sink);
    }
}

#ifdef __OPENCL_VERSION__
#include "../lib/step_data/arena_views.h"
#include "narrow_phase_bindings.h"

// Runs the feature tests that patchCull lists.
__kernel void narrowPhaseFeature(DRAPE_NARROW_PHASE_FEATURE)
{
    const FeatureInput input = {tests,
                                min(counters->m_candidates, values.m_testCapacity),
                                clothAt(nodes, cloths, &values.m_cloth, values.m_mode, 0),
                                obstacleAt(obstacles, &values.m_obstacle),
                                patchesAt(patches, &values.m_patches),
                                motions};
    const ContactSink sink =
        contactSink(contacts, values.m_contactCapacity, ranks, featureCounts, values.m_sums, counters);
    runFeatureTests(&input, &sink, swept, counters);
}
#endif
