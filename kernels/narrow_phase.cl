// Narrow phase: contacts of the candidates' features. Launches have a fixed width and walk the list in strides: its length
// is only on the device.
#include "lib/pair_contact.h"
#include "lib/triangle_triangle.h"

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

// A work-item takes every stride-th candidate, runs its feature tests and writes the hits in no particular order. slotCount
// counts those written per cloth feature; it and counters->m_hits must be zero before. m_hits counts on when the list is
// full.
__kernel void narrowPhaseTest(__global const Candidate* restrict candidates, const uint candidateCapacity,
                              __global const float* restrict clothStart, __global const float* restrict clothEnd,
                              __global const Triangle* restrict clothTriangles, __global const Edge* restrict clothEdges,
                              const uint nodeCount, const uint triangleCount,
                              __global const float* restrict obstaclePositions,
                              __global const Triangle* restrict obstacleTriangles,
                              __global const NormalCone* restrict vertexCones,
                              __global const NormalCone* restrict edgeCones, __global const float* restrict thickness,
                              const uint obstacleMeshes, const float reachScale, __global Contact* restrict hits,
                              const uint hitCapacity, __global volatile uint* slotCount,
                              __global StepCounters* restrict counters)
{
    const ClothView cloth =
        clothView(clothStart, clothEnd, clothTriangles, clothEdges, nodeCount, triangleCount);
    const ObstacleView obstacle = obstacleView(obstaclePositions, obstacleTriangles, vertexCones, edgeCones);
    const uint count = min(counters->m_candidates, candidateCapacity);
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        const Candidate candidate = candidates[i];
        __global const Triangle* clothTriangle = clothTriangles + candidate.m_cloth;
        __global const Triangle* obstacleTriangle = obstacleTriangles + candidate.m_obstacle;
        const float reach =
            thickness[clothTriangle->m_mesh * obstacleMeshes + obstacleTriangle->m_mesh] * reachScale;
        const uint tests = ownedTests(clothTriangle->m_owned, obstacleTriangle->m_owned);
        PairGeometry pair;
        loadPair(&pair, &cloth, clothTriangle, &obstacle, obstacleTriangle);
        if (!preparePair(&pair, reach)) continue;
        for (int test = 0; test < DRAPE_FEATURE_TESTS; ++test)
        {
            Contact contact;
            if (!(tests & (1u << test))) continue;
            if (!pairContact(test, &pair, &cloth, &obstacle, candidate, &contact)) continue;
            const uint place = atomic_inc(&counters->m_hits);
            if (place >= hitCapacity) continue;
            hits[place] = contact;
            atomic_inc(slotCount + contact.m_slot);
        }
    }
}

// A work-item takes every stride-th candidate and lists the pairs that intersect at the step's start.
// counters->m_intersections must be zero before; it counts on when the list is full.
__kernel void narrowPhaseIntersect(__global const Candidate* restrict candidates, const uint candidateCapacity,
                                   __global const float* restrict clothStart,
                                   __global const Triangle* restrict clothTriangles,
                                   __global const float* restrict obstaclePositions,
                                   __global const Triangle* restrict obstacleTriangles,
                                   __global Candidate* restrict pairs, const uint pairCapacity,
                                   __global StepCounters* restrict counters)
{
    const ClothView cloth = clothView(clothStart, clothStart, clothTriangles, 0, 0, 0);
    const ObstacleView obstacle = obstacleView(obstaclePositions, obstacleTriangles, 0, 0);
    const uint count = min(counters->m_candidates, candidateCapacity);
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        PairGeometry pair;
        loadPair(&pair, &cloth, clothTriangles + candidates[i].m_cloth, &obstacle,
                 obstacleTriangles + candidates[i].m_obstacle);
        if (!trianglesIntersect(pair.m_face.m_start, pair.m_resting.m_corners)) continue;
        const uint place = atomic_inc(&counters->m_intersections);
        if (place < pairCapacity) pairs[place] = candidates[i];
    }
}
