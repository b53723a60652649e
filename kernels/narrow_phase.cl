// Narrow phase: contacts of the candidates' features, and for each slot (cloth feature × direction) the deepest one.
// A slot's winner has the least gap at the step's end and, among equals, the least obstacle feature, so it does not depend
// on the order of execution. Launches have a fixed width and walk the list in strides: its length is only on the device.
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

// A work-item takes every stride-th candidate and runs its feature tests. Writes hits and the least rank per slot
// (slotRank, DRAPE_NO_CONTACT before). With keepAll zero a hit that is behind its slot's rank already is not written: ranks
// only fall, so it cannot win. counters->m_hits must be zero before; it counts on when the list is full.
__kernel void narrowPhaseTest(__global const Candidate* restrict candidates, const uint candidateCapacity,
                              __global const float* restrict clothStart, __global const float* restrict clothEnd,
                              __global const Triangle* restrict clothTriangles, __global const Edge* restrict clothEdges,
                              const uint nodeCount, const uint triangleCount,
                              __global const float* restrict obstaclePositions,
                              __global const Triangle* restrict obstacleTriangles,
                              __global const NormalCone* restrict vertexCones,
                              __global const NormalCone* restrict edgeCones, __global const float* restrict thickness,
                              const uint obstacleMeshes, const float reachScale, __global Contact* restrict hits,
                              const uint hitCapacity, __global volatile uint* slotRank,
                              __global StepCounters* restrict counters, const uint keepAll)
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
            const uint rank = contactRank(contact.m_gap1);
            if (!keepAll && rank > slotRank[contact.m_slot]) continue;
            atomic_min(slotRank + contact.m_slot, rank);
            const uint place = atomic_inc(&counters->m_hits);
            if (place < hitCapacity) hits[place] = contact;
        }
    }
}

// A work-item takes every stride-th hit. Among those of a slot's least rank, keeps the least obstacle feature (slotFeature,
// DRAPE_NO_CONTACT before).
__kernel void narrowPhaseTie(__global const Contact* restrict hits, const uint hitCapacity,
                             __global const uint* restrict slotRank, __global volatile uint* slotFeature,
                             __global const StepCounters* restrict counters)
{
    const uint count = min(counters->m_hits, hitCapacity);
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        const uint slot = hits[i].m_slot;
        if (contactRank(hits[i].m_gap1) == slotRank[slot]) atomic_min(slotFeature + slot, hits[i].m_obstacleFeature);
    }
}

// A work-item takes every stride-th hit and, when it won its slot, leaves its place there. One hit wins a slot, since a
// feature pair is tested once, so no two items write one place.
__kernel void narrowPhaseWin(__global const Contact* restrict hits, const uint hitCapacity,
                             __global const uint* restrict slotRank, __global const uint* restrict slotFeature,
                             __global uint* restrict slotHit, __global const StepCounters* restrict counters)
{
    const uint count = min(counters->m_hits, hitCapacity);
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        const uint slot = hits[i].m_slot;
        if (contactRank(hits[i].m_gap1) == slotRank[slot] && hits[i].m_obstacleFeature == slotFeature[slot])
        {
            slotHit[slot] = i;
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
