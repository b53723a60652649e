#include "bullet_plugin/core/compaction/canonical_order.h"
#include "kernels/lib/triangle_triangle.h"
#include "narrow_phase.h"

namespace drape
{
NarrowPhaseCounts narrowPhaseOnHost(const std::vector<Candidate>& candidates, const ClothView& cloth,
                                    const ObstacleView& obstacle, const NarrowPhaseSettings& settings,
                                    std::vector<Contact>& contacts, std::size_t limit)
{
    contacts.clear();
    NarrowPhaseCounts counts;
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
            if (++counts.m_contacts <= limit) contacts.push_back(contact);
        }
        counts.m_swept += searches;
        searches = 0;
    }
    if (counts.m_contacts > limit) std::vector<Contact>().swap(contacts);
    sortContacts(contacts);
    return counts;
}

void intersectOnHost(const std::vector<Candidate>& candidates, const ClothView& cloth, const ObstacleView& obstacle,
                     const MotionList& motions, std::vector<Candidate>& pairs)
{
    pairs.clear();
    ClothView seen = cloth;
    for (const Candidate& candidate : candidates)
    {
        PairTriangles pair;
        seen.m_motion = motions.find(obstacle.m_triangles[candidate.m_obstacle].m_mesh);
        loadPair(&pair, &seen, &obstacle, candidate);
        if (trianglesIntersect(pair.m_start, pair.m_resting)) pairs.push_back(candidate);
    }
    sortCandidates(pairs);
}
}  // namespace drape
