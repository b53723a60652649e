// Narrow phase: contacts of the candidates' features. Launches have a fixed width and walk the list in strides: its length
// is only on the device.
#include "lib/pair_contact.h"
#include "lib/triangle_triangle.h"
#include "shared/patch.h"

static ClothView clothView(__global const float* start, __global const float* end, __global const Triangle* triangles,
                           __global const Edge* edges, const uint nodeCount, const uint triangleCount, const uint mode,
                           const int complete)
{
    ClothView view;
    view.m_start = start;
    view.m_end = end;
    view.m_triangles = triangles;
    view.m_edges = edges;
    view.m_nodeCount = nodeCount;
    view.m_triangleCount = triangleCount;
    view.m_mode = mode;
    view.m_complete = complete;
    view.m_motion = 0;
    return view;
}

static ObstacleView obstacleView(__global const float* positions, __global const Triangle* triangles,
                                 __global const NormalCone* vertexCones, __global const NormalCone* edgeCones)
{
    ObstacleView view;
    view.m_positions = positions;
    view.m_triangles = triangles;
    view.m_vertexCones = vertexCones;
    view.m_edgeCones = edgeCones;
    return view;
}

// A work-item takes every stride-th candidate, runs its feature tests and writes the hits in no particular order. motions: of
// the obstacles that move in the step. slotCount counts the hits written per cloth feature; it and counters' listed and swept
// must be zero before. m_listed counts on when the list is full.
__kernel void narrowPhaseTest(__global const Candidate* restrict candidates, const uint candidateCapacity,
                              __global const float* restrict clothStart, __global const float* restrict clothEnd,
                              __global const Triangle* restrict clothTriangles, __global const Edge* restrict clothEdges,
                              const uint nodeCount, const uint triangleCount,
                              __global const float* restrict obstaclePositions,
                              __global const Triangle* restrict obstacleTriangles,
                              __global const NormalCone* restrict vertexCones,
                              __global const NormalCone* restrict edgeCones, __global const float* restrict thickness,
                              const uint obstacleMeshes, const float reachScale, const uint mode,
                              __global const ObstacleMotion* restrict motions, const uint motionCount,
                              __global Contact* restrict hits, const uint hitCapacity,
                              __global volatile uint* slotCount, __global StepCounters* restrict counters)
{
    ClothView cloth =
        clothView(clothStart, clothEnd, clothTriangles, clothEdges, nodeCount, triangleCount, mode, 0);
    const ObstacleView obstacle = obstacleView(obstaclePositions, obstacleTriangles, vertexCones, edgeCones);
    const uint count = min(counters->m_candidates, candidateCapacity);
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        const Candidate candidate = candidates[i];
        __global const Triangle* clothTriangle = clothTriangles + candidate.m_cloth;
        __global const Triangle* obstacleTriangle = obstacleTriangles + candidate.m_obstacle;
        const float reach =
            thickness[clothTriangle->m_mesh * obstacleMeshes + obstacleTriangle->m_mesh] * reachScale;
        cloth.m_motion = findMotion(motions, motionCount, obstacleTriangle->m_mesh);
        uint tests = ownedTests(clothTriangle->m_owned, obstacleTriangle->m_owned);
        PairTriangles pair;
        loadPair(&pair, &cloth, &obstacle, candidate);
        if (pairApart(&pair, reach)) continue;
        tests &= pair.m_tests;
        for (int test = 0; test < DRAPE_FEATURE_TESTS; ++test)
        {
            Contact contact;
            if (!(tests & (1u << test))) continue;
            int found = DRAPE_UNDECIDED;
            for (cloth.m_complete = 0; found == DRAPE_UNDECIDED; cloth.m_complete = 1)
            {
                if (cloth.m_complete) atomic_inc(&counters->m_swept);
                found = pairContact(test, &cloth, &obstacle, candidate, reach, &contact);
            }
            if (found != DRAPE_IS_CONTACT) continue;
            const uint place = atomic_inc(&counters->m_listed);
            if (place >= hitCapacity) continue;
            hits[place] = contact;
            atomic_inc(slotCount + contact.m_slot);
        }
    }
}

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

// A work-item takes every stride-th of the feature tests that patchCull lists and writes each hit at its test's place; a test
// without a hit leaves DRAPE_NO_FEATURE as slot, also one that needs the continuous test: those are listed in swept, in no
// particular order. slotCount counts the hits of each cloth feature; it and counters->m_swept must be zero before.
__kernel void narrowPhaseFeature(__global const FeatureTest* restrict tests, const uint testCapacity,
                                 __global const float* restrict clothStart, __global const float* restrict clothEnd,
                                 __global const Triangle* restrict clothTriangles,
                                 __global const Edge* restrict clothEdges, const uint nodeCount,
                                 const uint triangleCount, const uint mode,
                                 __global const Triangle* restrict obstacleTriangles,
                                 __global const NormalCone* restrict vertexCones,
                                 __global const NormalCone* restrict edgeCones, __global const float* restrict faces,
                                 __global const float* restrict vertices, __global const float* restrict edges,
                                 __global const uint* restrict faceIds, __global const uint* restrict vertexIds,
                                 __global const uint* restrict edgeIds,
                                 __global const ObstacleMotion* restrict motions, __global Contact* restrict hits,
                                 __global uint* restrict swept, __global volatile uint* slotCount,
                                 __global StepCounters* restrict counters)
{
    ClothView cloth =
        clothView(clothStart, clothEnd, clothTriangles, clothEdges, nodeCount, triangleCount, mode, 0);
    const ObstacleView obstacle = obstacleView(0, obstacleTriangles, vertexCones, edgeCones);
    const PackedFeatures packed = {faces, vertices, edges, faceIds, vertexIds, edgeIds};
    const uint count = min(counters->m_candidates, testCapacity);
    if (get_global_id(0) == 0) counters->m_listed = count;
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        cloth.m_motion = motionOfTest(motions, tests[i]);
        Contact contact;
        const int found = featureContact(tests[i], &cloth, &obstacle, &packed, &contact);
        if (found != DRAPE_IS_CONTACT)
        {
            if (found == DRAPE_UNDECIDED) swept[atomic_inc(&counters->m_swept)] = i;
            hits[i].m_slot = DRAPE_NO_FEATURE;
            continue;
        }
        atomic_inc(slotCount + contact.m_slot);  // before the stores: on a CPU it would wait for them
        hits[i] = contact;
    }
}

// A work-item takes every stride-th of the tests that narrowPhaseFeature left to the continuous test and writes their hits.
__kernel void narrowPhaseSwept(__global const FeatureTest* restrict tests,
                               __global const float* restrict clothStart, __global const float* restrict clothEnd,
                               __global const Triangle* restrict clothTriangles, __global const Edge* restrict clothEdges,
                               const uint nodeCount, const uint triangleCount, const uint mode,
                               __global const Triangle* restrict obstacleTriangles,
                               __global const NormalCone* restrict vertexCones,
                               __global const NormalCone* restrict edgeCones, __global const float* restrict faces,
                               __global const float* restrict vertices, __global const float* restrict edges,
                               __global const uint* restrict faceIds, __global const uint* restrict vertexIds,
                               __global const uint* restrict edgeIds,
                               __global const ObstacleMotion* restrict motions, __global Contact* restrict hits,
                               __global const uint* restrict swept, __global volatile uint* slotCount,
                               __global const StepCounters* restrict counters)
{
    ClothView cloth =
        clothView(clothStart, clothEnd, clothTriangles, clothEdges, nodeCount, triangleCount, mode, 1);
    const ObstacleView obstacle = obstacleView(0, obstacleTriangles, vertexCones, edgeCones);
    const PackedFeatures packed = {faces, vertices, edges, faceIds, vertexIds, edgeIds};
    for (uint i = get_global_id(0); i < counters->m_swept; i += get_global_size(0))
    {
        const uint place = swept[i];
        Contact contact;
        cloth.m_motion = motionOfTest(motions, tests[place]);
        if (featureContact(tests[place], &cloth, &obstacle, &packed, &contact) != DRAPE_IS_CONTACT) continue;
        atomic_inc(slotCount + contact.m_slot);
        hits[place] = contact;
    }
}

// A work-item takes every stride-th candidate and lists the pairs that intersect at the step's start.
// counters->m_intersections must be zero before; it counts on when the list is full.
__kernel void narrowPhaseIntersect(__global const Candidate* restrict candidates, const uint candidateCapacity,
                                   __global const float* restrict clothStart,
                                   __global const Triangle* restrict clothTriangles,
                                   __global const float* restrict obstaclePositions,
                                   __global const Triangle* restrict obstacleTriangles,
                                   __global const ObstacleMotion* restrict motions, const uint motionCount,
                                   __global Candidate* restrict pairs, const uint pairCapacity,
                                   __global StepCounters* restrict counters)
{
    ClothView cloth = clothView(clothStart, clothStart, clothTriangles, 0, 0, 0, DRAPE_DISCRETE, 0);
    const ObstacleView obstacle = obstacleView(obstaclePositions, obstacleTriangles, 0, 0);
    const uint count = min(counters->m_candidates, candidateCapacity);
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        cloth.m_motion = findMotion(motions, motionCount, obstacleTriangles[candidates[i].m_obstacle].m_mesh);
        PairTriangles pair;
        loadPair(&pair, &cloth, &obstacle, candidates[i]);
        if (!trianglesIntersect(pair.m_start, pair.m_resting)) continue;
        const uint place = atomic_inc(&counters->m_intersections);
        if (place < pairCapacity) pairs[place] = candidates[i];
    }
}
