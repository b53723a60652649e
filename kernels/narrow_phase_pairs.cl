// Narrow phase over pairs of triangles, for traversals that list such pairs: contacts of the candidates' features, and
// the pairs that intersect. Launches have a fixed width: the list's length is only on the device.
#include "lib/hit_list.h"
#include "lib/item_runs.h"
#include "lib/pair_contact.h"
#include "lib/triangle_triangle.h"

// Runs the feature tests of the candidates, each work-item its part, and lists the contacts. motions: of the
// obstacles that move in the step. counters->m_swept must be zero before.
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
                              DRAPE_HIT_ARGUMENTS)
{
    const HitList list = DRAPE_HIT_LIST;
    uint searches = 0;
    ClothView cloth =
        clothView(clothStart, clothEnd, clothTriangles, clothEdges, nodeCount, triangleCount, mode, &searches);
    const ObstacleView obstacle = obstacleView(obstaclePositions, obstacleTriangles, vertexCones, edgeCones);
    const uint count = min(counters->m_candidates, candidateCapacity);
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        const Candidate candidate = candidates[i];
        __global const Triangle* clothTriangle = clothTriangles + candidate.m_cloth;
        __global const Triangle* obstacleTriangle = obstacleTriangles + candidate.m_obstacle;
        const float reach =
            thickness[clothTriangle->m_mesh * obstacleMeshes + obstacleTriangle->m_mesh] * reachScale;
        cloth.m_motion = findMotion(motions, motionCount, obstacleTriangle->m_mesh);
        const uint tests = testsOfPair(&cloth, &obstacle, candidate, reach);
        for (int test = 0; test < DRAPE_FEATURE_TESTS; ++test)
        {
            Contact contact;
            if (!(tests & (1u << test))) continue;
            if (pairContact(test, &cloth, &obstacle, candidate, reach, &contact) == DRAPE_IS_CONTACT)
                listHit(&list, &contact);
        }
    }
    if (searches > 0) atomic_add(&counters->m_swept, searches);
}

// Lists the pairs that intersect at the step's start; a work-item processes its part of the candidates.
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
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        cloth.m_motion = findMotion(motions, motionCount, obstacleTriangles[candidates[i].m_obstacle].m_mesh);
        PairTriangles pair;
        loadPair(&pair, &cloth, &obstacle, candidates[i]);
        if (!trianglesIntersect(pair.m_start, pair.m_resting)) continue;
        const uint place = atomic_inc(&counters->m_intersections);
        if (place < pairCapacity) pairs[place] = candidates[i];
    }
}
