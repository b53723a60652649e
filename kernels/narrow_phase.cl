// Narrow phase over pairs of features. Launches have a fixed width: the list's length is only on the device.
#include "lib/hit_list.h"
#include "lib/item_runs.h"
#include "lib/pair_contact.h"
#include "shared/patch.h"

// Position and cone of a lane of a vertex or edge block.
static Vec3 laneVec3(__global const float* restrict blocks, const uint floats, const uint lane, const uint first)
{
    __global const float* p =
        blocks + ((lane / DRAPE_PATCH_WIDTH) * floats + first) * DRAPE_PATCH_WIDTH + lane % DRAPE_PATCH_WIDTH;
    return vec3(p[0], p[DRAPE_PATCH_WIDTH], p[2 * DRAPE_PATCH_WIDTH]);
}

static NormalCone laneCone(__global const float* restrict blocks, const uint floats, const uint lane)
{
    NormalCone cone;
    cone.m_axis = laneVec3(blocks, floats, lane, floats - 4);
    cone.m_cosine = blocks[((lane / DRAPE_PATCH_WIDTH) * floats + floats - 1) * DRAPE_PATCH_WIDTH + lane % DRAPE_PATCH_WIDTH];
    return cone;
}

// The packed features of the obstacles (see shared/patch.h); ids: the triangle, vertex or edge of each lane.
typedef struct PackedFeatures
{
    __global const float* m_faces;
    __global const float* m_vertices;
    __global const float* m_edges;
    __global const uint* m_faceIds;
    __global const uint* m_vertexIds;
    __global const uint* m_edgeIds;
} PackedFeatures;

// The motion of a test's obstacle; null where it rests.
static __global const ObstacleMotion* motionOfTest(__global const ObstacleMotion* motions, const FeatureTest test)
{
    return test.m_motion == 0 ? 0 : motions + (test.m_motion - 1);
}

static int featureContact(const FeatureTest feature, const ClothView* cloth, const ObstacleView* obstacle,
                          const PackedFeatures* packed, Contact* contact)
{
    const uint test = feature.m_cloth >> DRAPE_TEST_SHIFT, lane = feature.m_lane;
    const uint triangle = feature.m_cloth & ((1u << DRAPE_TEST_SHIFT) - 1u);
    if (test < DRAPE_TEST_FACE)
    {
        __global const float* faces = packed->m_faces;
        return pairNodeFace(test, cloth, triangle, laneVec3(faces, DRAPE_FACE_FLOATS, lane, 0),
                            laneVec3(faces, DRAPE_FACE_FLOATS, lane, 3), laneVec3(faces, DRAPE_FACE_FLOATS, lane, 6),
                            obstacle, packed->m_faceIds[lane], feature.m_reach, contact);
    }
    if (test == DRAPE_TEST_FACE)
    {
        __global const float* vertices = packed->m_vertices;
        return pairFaceVertex(cloth, triangle, laneVec3(vertices, DRAPE_VERTEX_FLOATS, lane, 0),
                              laneCone(vertices, DRAPE_VERTEX_FLOATS, lane), packed->m_vertexIds[lane], feature.m_reach,
                              contact);
    }
    __global const float* edges = packed->m_edges;
    return pairEdgeEdge(test - DRAPE_TEST_EDGE, cloth, triangle, laneVec3(edges, DRAPE_EDGE_FLOATS, lane, 0),
                        laneVec3(edges, DRAPE_EDGE_FLOATS, lane, 3), laneCone(edges, DRAPE_EDGE_FLOATS, lane),
                        packed->m_edgeIds[lane], feature.m_reach, contact);
}

// The step's cloths and obstacles as the kernels below read them, and the hits that they list.
#define DRAPE_FEATURE_ARGUMENTS                                                                                            \
    __global const FeatureTest *restrict tests, const uint testCapacity, __global const float *restrict clothStart,        \
        __global const float *restrict clothEnd, __global const Triangle *restrict clothTriangles,                         \
        __global const Edge *restrict clothEdges, const uint nodeCount, const uint triangleCount, const uint mode,         \
        __global const Triangle *restrict obstacleTriangles, __global const NormalCone *restrict vertexCones,              \
        __global const NormalCone *restrict edgeCones, __global const float *restrict faces,                               \
        __global const float *restrict vertices, __global const float *restrict edges, __global const uint *restrict faceIds, \
        __global const uint *restrict vertexIds, __global const uint *restrict edgeIds,                                    \
        __global const ObstacleMotion *restrict motions, DRAPE_HIT_ARGUMENTS
#define DRAPE_CLOTH_VIEW(searches) \
    clothView(clothStart, clothEnd, clothTriangles, clothEdges, nodeCount, triangleCount, mode, searches)
#define DRAPE_FEATURE_VIEWS                                                                     \
    const HitList list = DRAPE_HIT_LIST;                                                        \
    const ObstacleView obstacle = obstacleView(0, obstacleTriangles, vertexCones, edgeCones);   \
    const PackedFeatures packed = {faces, vertices, edges, faceIds, vertexIds, edgeIds}

#define DRAPE_TEST_KINDS 3
static uint kindOfTest(const FeatureTest feature)
{
    const uint test = feature.m_cloth >> DRAPE_TEST_SHIFT;
    return test < DRAPE_TEST_FACE ? 0 : test == DRAPE_TEST_FACE ? 1 : 2;
}

// Tests the item-th feature pair; lists its hit, or in swept that the continuous test must tell.
static void testFeature(__global const FeatureTest* tests, const uint item, ClothView* cloth,
                        const ObstacleView* obstacle, const PackedFeatures* packed,
                        __global const ObstacleMotion* motions, const HitList* list, __global uint* swept,
                        __global StepCounters* counters)
{
    const FeatureTest test = tests[item];
    cloth->m_motion = motionOfTest(motions, test);
    Contact contact;
    const int found = featureContact(test, cloth, obstacle, packed, &contact);
    if (found == DRAPE_IS_CONTACT)
        listHit(list, &contact);
    else if (found == DRAPE_UNDECIDED)
        swept[atomic_inc(&counters->m_swept)] = item;
}

#ifndef DRAPE_CPU
// Work-items of a group (kFeatureGroupGpu in narrow_phase.cpp).
#define DRAPE_FEATURE_GROUP 256

// Shares out to a group's work-items as many tests as they are, from `first` on, so that those of one kind are next to
// each other: lanes of one kind wait for those of another. Returns this work-item's test, `count` where it has none. By
// all of the group together. The next turn's writes need no barrier: it clears `kinds` after everyone has passed the
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
#define DRAPE_FEATURE_KERNEL __kernel __attribute__((reqd_work_group_size(DRAPE_FEATURE_GROUP, 1, 1)))
#else
#define DRAPE_FEATURE_KERNEL __kernel
#endif

// A CPU's work-item goes through its part of the feature tests that patchCull lists, a GPU's group through as many at a
// time as it has work-items, and lists the hits; the tests that need the continuous test it lists in swept, in no
// particular order. counters->m_swept must be zero before.
DRAPE_FEATURE_KERNEL void narrowPhaseFeature(DRAPE_FEATURE_ARGUMENTS, __global uint* restrict swept)
{
    DRAPE_FEATURE_VIEWS;
    ClothView cloth = DRAPE_CLOTH_VIEW(0);
    const uint count = min(counters->m_candidates, testCapacity);
#ifdef DRAPE_CPU
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
        testFeature(tests, runs.m_item, &cloth, &obstacle, &packed, motions, &list, swept, counters);
#else
    __local uint kinds[DRAPE_TEST_KINDS];
    __local ushort order[DRAPE_FEATURE_GROUP];
    for (uint first = get_group_id(0) * get_local_size(0); first < count; first += get_global_size(0))
    {
        const uint item = testByKind(tests, first, count, kinds, order);
        if (item < count) testFeature(tests, item, &cloth, &obstacle, &packed, motions, &list, swept, counters);
    }
#endif
}

// Groups take turns at the kinds of tests, and each its tests one by one, its first lane's after every other group's: lanes
// of one kind wait for those of another, and few tests, which take long, are then not in each other's way. On a CPU, too:
// next to the tests themselves it costs little that what neighbours read is not in the cache.
typedef struct KindShare
{
    uint m_kind, m_first, m_stride;
} KindShare;

// Of the kinds from `kind` on. There must be a group for each.
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

// A work-item takes every stride-th of the tests that narrowPhaseFeature left to the continuous test and lists their hits.
// None of these is a node's: its way crosses a face that rests in closed form.
__kernel void narrowPhaseSwept(DRAPE_FEATURE_ARGUMENTS, __global const uint* restrict swept)
{
    DRAPE_FEATURE_VIEWS;
    uint searches = 0;
    ClothView cloth = DRAPE_CLOTH_VIEW(&searches);
    const KindShare share = kindShare(1);
    const uint count = counters->m_swept;
    for (uint i = share.m_first; i < count; i += share.m_stride)
    {
        const FeatureTest test = tests[swept[i]];
        Contact contact;
        if (kindOfTest(test) != share.m_kind) continue;
        cloth.m_motion = motionOfTest(motions, test);
        if (featureContact(test, &cloth, &obstacle, &packed, &contact) == DRAPE_IS_CONTACT) listHit(&list, &contact);
    }
}

// Both in one launch, for tests that are few: each runs the continuous test where it needs it.
__kernel void narrowPhaseFew(DRAPE_FEATURE_ARGUMENTS)
{
    DRAPE_FEATURE_VIEWS;
    uint searches = 0;
    ClothView cloth = DRAPE_CLOTH_VIEW(&searches);
    const KindShare share = kindShare(0);
    const uint count = min(counters->m_candidates, testCapacity);
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
