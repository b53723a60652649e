// Narrow phase over pairs of triangles: contacts of the candidates' features. Launches have a fixed width: the list's length is only on the device.
#include "../../kernels/lib/hit_list.h"
#include "../../kernels/lib/item_runs.h"
#include "../../kernels/lib/pair_contact.h"
#include "shared/traversal.h"

// A work-item goes through its part of the candidates, runs their feature tests and lists the hits. found: what
// the traversal counted. counters->m_swept must be zero before.
__kernel void narrowPhaseTest(__global const Candidate* restrict candidates, const uint candidateCapacity,
                              __global const TraversalCounters* restrict found,
                              __global const float* restrict clothStart, __global const float* restrict clothEnd,
                              __global const Triangle* restrict clothTriangles, __global const Edge* restrict clothEdges,
                              const uint nodeCount, const uint triangleCount,
                              __global const float* restrict obstaclePositions,
                              __global const Triangle* restrict obstacleTriangles,
                              __global const NormalCone* restrict vertexCones,
                              __global const NormalCone* restrict edgeCones, __global const float* restrict thickness,
                              const uint obstacleMeshes, const float reachScale, const uint mode,
                              DRAPE_HIT_ARGUMENTS)
{
    const HitList list = DRAPE_HIT_LIST;
    uint searches = 0;
    const ClothView cloth =
        clothView(clothStart, clothEnd, clothTriangles, clothEdges, nodeCount, triangleCount, mode, &searches);
    const ObstacleView obstacle = obstacleView(obstaclePositions, obstacleTriangles, vertexCones, edgeCones);
    const uint count = min(found->m_candidates, candidateCapacity);
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        const Candidate candidate = candidates[i];
        __global const Triangle* clothTriangle = clothTriangles + candidate.m_cloth;
        __global const Triangle* obstacleTriangle = obstacleTriangles + candidate.m_obstacle;
        const float reach =
            thickness[clothTriangle->m_mesh * obstacleMeshes + obstacleTriangle->m_mesh] * reachScale;
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
