#include "canonical_order.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace drape
{
void sortCandidates(std::vector<Candidate>& candidates)
{
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b)
              { return std::tie(a.m_cloth, a.m_obstacle) < std::tie(b.m_cloth, b.m_obstacle); });
}

namespace
{
bool comesBefore(const Contact& a, const Contact& b)
{
    return std::tie(a.m_slot, a.m_obstacleFeature) < std::tie(b.m_slot, b.m_obstacleFeature);
}
}  // namespace

void sortContacts(std::vector<Contact>& contacts)
{
    std::sort(contacts.begin(), contacts.end(), comesBefore);
}

void orderHits(const Contact* hits, std::size_t count, std::vector<std::uint32_t>& slotCount,
               std::vector<Contact>& contacts)
{
    std::uint32_t first = 0;
    for (std::uint32_t& number : slotCount)
        first += std::exchange(number, first);
    contacts.resize(count);
    std::vector<std::uint32_t> last = slotCount;
    for (const Contact* hit = hits; hit != hits + count; ++hit)
        contacts[last[hit->m_slot]++] = *hit;
    for (std::size_t slot = 0; slot < slotCount.size(); ++slot)
    {
        if (last[slot] - slotCount[slot] > 1)
            std::sort(contacts.begin() + slotCount[slot], contacts.begin() + last[slot], comesBefore);
    }
}
}  // namespace drape
