#include "canonical_order.h"

#include <algorithm>
#include <tuple>

namespace drape
{
void sortCandidates(std::vector<Candidate>& candidates)
{
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b)
              { return std::tie(a.m_cloth, a.m_obstacle) < std::tie(b.m_cloth, b.m_obstacle); });
}

void sortContacts(std::vector<Contact>& contacts)
{
    std::sort(contacts.begin(), contacts.end(),
              [](const Contact& a, const Contact& b)
              { return std::tie(a.m_slot, a.m_obstacleFeature) < std::tie(b.m_slot, b.m_obstacleFeature); });
}
}  // namespace drape
