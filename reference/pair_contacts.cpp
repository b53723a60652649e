#include "reference/pair_contacts.h"

#include "bullet_plugin/core/ordering/canonical_order.h"
#include "kernels/lib/queries/triangle_triangle.h"
#include "reference/pair_tests.h"

namespace drape
{
PairCounts contactsOfPairs(const std::vector<Candidate>& candidates, const ClothView& cloth,
                           const ObstacleView& obstacle, const PairSettings& settings, std::vector<Contact>& contacts)
{
    contacts.clear();
    PairCounts counts;
    ClothView seen = cloth;
    std::uint32_t searches = 0;
    seen.m_mode = settings.m_mode;
    seen.m_searches = &searches;
    for (const Candidate& candidate : candidates)
    {
        const Triangle* clothTriangle = cloth.m_triangles + candidate.m_cloth;
        const Triangle* obstacleTriangle = obstacle.m_triangles + candidate.m_obstacle;
        const float reach =
            settings.m_thickness[clothTriangle->m_mesh * settings.m_obstacleMeshes + obstacleTriangle->m_mesh] *
            settings.m_reachScale;
        seen.m_motion = settings.m_motions.find(obstacleTriangle->m_mesh);
        const std::uint32_t tests = testsOfPair(&seen, &obstacle, candidate, reach);
        for (int test = 0; test < DRAPE_FEATURE_TESTS; ++test)
        {
            Contact contact;
            if (!(tests & (1u << test))) continue;
            if (pairContact(test, &seen, &obstacle, candidate, reach, &contact) != DRAPE_IS_CONTACT) continue;
            contacts.push_back(contact);
        }
        counts.m_swept += searches;
        searches = 0;
    }
    counts.m_contacts = contacts.size();
    sortContacts(contacts);
    return counts;
}

std::vector<Candidate> intersectingPairs(const std::vector<Candidate>& candidates, const ClothView& cloth,
                                         const ObstacleView& obstacle, const MotionList& motions)
{
    std::vector<Candidate> pairs;
    ClothView seen = cloth;
    for (const Candidate& candidate : candidates)
    {
        PairTriangles pair;
        seen.m_motion = motions.find(obstacle.m_triangles[candidate.m_obstacle].m_mesh);
        loadPair(&pair, &seen, &obstacle, candidate);
        if (trianglesIntersect(pair.m_start, pair.m_resting)) pairs.push_back(candidate);
    }
    sortCandidates(pairs);
    return pairs;
}

std::vector<std::uint32_t> joinedOrder(const MeshPool& pool)
{
    std::vector<std::uint32_t> order;
    for (std::size_t slot = 0; slot < pool.meshCount(); ++slot)
        for (const std::uint32_t leaf : pool.mesh(slot).m_order)
            order.push_back(leaf + pool.mesh(slot).m_firstTriangle);
    return order;
}
}  // namespace drape
