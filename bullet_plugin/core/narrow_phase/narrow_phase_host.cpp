#include <algorithm>
#include <tuple>

#include "kernels/lib/triangle_triangle.h"
#include "narrow_phase.h"

namespace drape
{
namespace
{
void sortContacts(std::vector<Contact>& contacts)
{
    std::sort(contacts.begin(), contacts.end(),
              [](const Contact& a, const Contact& b)
              { return std::tie(a.m_slot, a.m_obstacleFeature) < std::tie(b.m_slot, b.m_obstacleFeature); });
}
}  // namespace

NarrowPhaseCounts narrowPhaseOnHost(const std::vector<Candidate>& candidates, const ClothView& cloth,
                                    const ObstacleView& obstacle, const NarrowPhaseSettings& settings,
                                    std::vector<Contact>& contacts, std::size_t limit)
{
    contacts.clear();
    NarrowPhaseCounts counts;
    ClothView seen = cloth;
    seen.m_mode = settings.m_mode;
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
            int swept = 0;
            if (!(tests & (1u << test))) continue;
            const bool found = decidePairContact(test, &seen, &obstacle, candidate, reach, &contact, &swept);
            counts.m_swept += std::uint64_t(swept);
            if (found && ++counts.m_contacts <= limit) contacts.push_back(contact);
        }
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

void sortCandidates(std::vector<Candidate>& candidates)
{
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b)
              { return std::tie(a.m_cloth, a.m_obstacle) < std::tie(b.m_cloth, b.m_obstacle); });
}
}  // namespace drape
