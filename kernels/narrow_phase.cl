// Narrow phase: contacts of the candidates' features. Launches have a fixed width and walk the list in strides: its length
// is only on the device.
#include "lib/pair_contact.h"
#include "lib/triangle_triangle.h"
#include "shared/patch.h"

static ClothView clothView(__global const float* start, __global const float* end, __global const Triangle* triangles,
                           __global const Edge* edges, const uint nodeCount, const uint triangleCount)
{
    ClothView view;
    view.m_start = start;
    view.m_end = end;
    view.m_triangles = triangles;
    view.m_edges = edges;
    view.m_nodeCount = nodeCount;
    view.m_triangleCount = triangleCount;
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
// the obstacles that move in the step. slotCount counts those written per cloth feature; it and counters->m_listed must be zero
// before. m_listed counts on when the list is full.
__kernel void narrowPhaseTest(__global const Candidate* restrict candidates, const uint candidateCapacity,
                              __global const float* restrict clothStart, __global const float* restrict clothEnd,
                              __global const Triangle* restrict clothTriangles, __global const Edge* restrict clothEdges,
                              const uint nodeCount, const uint triangleCount,
                              __global const float* restrict obstaclePositions,
                              __global const Triangle* restrict obstacleTriangles,
                              __global const NormalCone* restrict vertexCones,
                              __global const NormalCone* restrict edgeCones, __global const float* restrict thickness,
                              const uint obstacleMeshes, const float reachScale,
                              __global const ObstacleMotion* restrict motions, const uint motionCount,
                              __global Contact* restrict hits,
                              const uint hitCapacity, __global volatile uint* slotCount,
                              __global StepCounters* restrict counters)
{
    ClothView cloth = clothView(clothStart, clothEnd, clothTriangles, clothEdges, nodeCount, triangleCount);
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
            if (!pairContact(test, &cloth, &obstacle, candidate, reach, &contact)) continue;
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

// A work-item takes every stride-th of the feature tests that patchCull lists (see shared/patch.h) and writes each hit at its
// test's place; a test without a hit leaves DRAPE_NO_FEATURE as slot. Ids: the feature of each lane. slotCount counts the hits
// of each cloth feature and must be zero before.
__kernel void narrowPhaseFeature(__global const FeatureTest* restrict tests, const uint testCapacity,
                                 __global const float* restrict clothStart, __global const float* restrict clothEnd,
                                 __global const Triangle* restrict clothTriangles,
                                 __global const Edge* restrict clothEdges, const uint nodeCount,
                                 const uint triangleCount, __global const Triangle* restrict obstacleTriangles,
                                 __global const NormalCone* restrict vertexCones,
                                 __global const NormalCone* restrict edgeCones, __global const float* restrict faces,
                                 __global const float* restrict vertices, __global const float* restrict edges,
                                 __global const uint* restrict faceIds, __global const uint* restrict vertexIds,
                                 __global const uint* restrict edgeIds,
                                 __global const ObstacleMotion* restrict motions, __global Contact* restrict hits,
                                 __global volatile uint* slotCount, __global StepCounters* restrict counters)
{
    ClothView cloth = clothView(clothStart, clothEnd, clothTriangles, clothEdges, nodeCount, triangleCount);
    const ObstacleView obstacle = obstacleView(0, obstacleTriangles, vertexCones, edgeCones);
    const uint count = min(counters->m_candidates, testCapacity);
    if (get_global_id(0) == 0) counters->m_listed = count;
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        const FeatureTest feature = tests[i];
        const uint test = feature.m_cloth >> DRAPE_TEST_SHIFT, lane = feature.m_lane;
        const uint triangle = feature.m_cloth & ((1u << DRAPE_TEST_SHIFT) - 1u);
        cloth.m_motion = feature.m_motion == 0 ? 0 : motions + (feature.m_motion - 1);
        Contact contact;
        int found;
        if (test < DRAPE_TEST_FACE)
        {
            found = pairNodeFace(test, &cloth, triangle, laneVec3(faces, DRAPE_FACE_FLOATS, lane, 0),
                                 laneVec3(faces, DRAPE_FACE_FLOATS, lane, 3), laneVec3(faces, DRAPE_FACE_FLOATS, lane, 6),
                                 &obstacle, faceIds[lane], feature.m_reach, &contact);
        }
        else if (test == DRAPE_TEST_FACE)
        {
            found = pairFaceVertex(&cloth, triangle, laneVec3(vertices, DRAPE_VERTEX_FLOATS, lane, 0),
                                   laneCone(vertices, DRAPE_VERTEX_FLOATS, lane), vertexIds[lane], feature.m_reach, &contact);
        }
        else
        {
            found = pairEdgeEdge(test - DRAPE_TEST_EDGE, &cloth, triangle, laneVec3(edges, DRAPE_EDGE_FLOATS, lane, 0),
                                 laneVec3(edges, DRAPE_EDGE_FLOATS, lane, 3), laneCone(edges, DRAPE_EDGE_FLOATS, lane),
                                 edgeIds[lane], feature.m_reach, &contact);
        }
        if (!found)
        {
            hits[i].m_slot = DRAPE_NO_FEATURE;
            continue;
        }
        atomic_inc(slotCount + contact.m_slot);  // before the stores: on a CPU it would wait for them
        hits[i] = contact;
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
    ClothView cloth = clothView(clothStart, clothStart, clothTriangles, 0, 0, 0);
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
