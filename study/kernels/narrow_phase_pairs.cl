// Narrow phase over pairs of triangles: contacts of the candidates' features. Launches have a fixed width: the list's
// length is only on the device.
#include "../../kernels/lib/narrow_phase/list_contacts.h"
#include "../../kernels/lib/step_data/arena_views.h"
#include "../../kernels/lib/work_items/item_runs.h"
#include "../../reference/pair_tests.h"
#include "narrow_phase_pairs_bindings.h"

// A work-item goes through its part of the candidates, runs their feature tests and lists the contacts.
// counters->m_swept must be zero before.
__kernel void narrowPhaseTest(DRAPE_NARROW_PHASE_TEST)
{
    const ContactSink sink =
        contactSink(contacts, values.m_contactCapacity, places, featureCounts, values.m_sums, counters);
    uint searches = 0;
    ClothView cloth = clothAt(start, cloths, &values.m_cloth, values.m_mode, &searches);
    cloth.m_end = end;
    const ObstacleView obstacle = obstacleAt(obstacles, &values.m_obstacle);
    const uint count = min(found->m_candidates, values.m_candidateCapacity);
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        const Candidate candidate = candidates[runs.m_item];
        __global const Triangle* clothTriangle = cloth.m_triangles + candidate.m_cloth;
        __global const Triangle* obstacleTriangle = obstacle.m_triangles + candidate.m_obstacle;
        const float reach =
            thickness[clothTriangle->m_mesh * values.m_obstacleMeshes + obstacleTriangle->m_mesh] * values.m_reachScale;
        const uint tests = testsOfPair(&cloth, &obstacle, candidate, reach);
        for (int test = 0; test < DRAPE_FEATURE_TESTS; ++test)
        {
            Contact contact;
            if (!(tests & (1u << test))) continue;
            if (pairContact(test, &cloth, &obstacle, candidate, reach, &contact) == DRAPE_IS_CONTACT)
                listContact(&sink, &contact);
        }
    }
    if (searches > 0) atomic_add(&counters->m_swept, searches);
}
