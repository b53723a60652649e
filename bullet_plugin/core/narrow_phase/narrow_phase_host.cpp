#include <algorithm>
#include <numeric>
#include <tuple>

#include "kernels/lib/triangle_triangle.h"
#include "narrow_phase.h"

namespace drape
{
void sortContacts(std::vector<Contact>& contacts)
{
    std::sort(contacts.begin(), contacts.end(),
              [](const Contact& a, const Contact& b)
              { return std::tie(a.m_slot, a.m_obstacleFeature) < std::tie(b.m_slot, b.m_obstacleFeature); });
}

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

void reduceOnHost(std::vector<Contact>& contacts, const ReductionView& view, std::size_t slotCount)
{
    const std::uint32_t count = std::uint32_t(contacts.size());
    std::vector<std::uint32_t> members(count), kept, first(slotCount, 0);
    std::iota(members.begin(), members.end(), 0u);
    for (std::uint32_t slot = 0, i = 0; slot < slotCount; ++slot)
    {
        first[slot] = i;
        while (i < count && contacts[i].m_slot == slot)
            ++i;
    }
    const SlotLists lists = {contacts.data(), members.data(), first.data(), std::uint32_t(slotCount), count};
    std::vector<Contact> all;
    for (std::uint32_t i = 0; i < count;)
    {
        const std::uint32_t end = slotEnd(&lists, contacts[i].m_slot);
        kept.assign(members.begin() + i, members.begin() + end);
        std::sort(kept.begin(), kept.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return isDeeper(&contacts[a], &contacts[b]) != 0; });
        kept.resize(reduceSlot(&view, &lists, kept.data(), end - i));
        std::sort(kept.begin(), kept.end());
        for (std::uint32_t member : kept)
            all.push_back(contacts[member]);
        i = end;
    }
    contacts.swap(all);
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
