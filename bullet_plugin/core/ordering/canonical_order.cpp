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
// Contacts, or features, per thread and turn, and the minimum number of contacts for waking other threads.
constexpr std::size_t kPiece = 512;
constexpr std::size_t kLeastShared = 1 << 12;

bool comesBefore(const Contact& a, const Contact& b)
{
    return std::tie(a.m_featureIndex, a.m_obstacleFeature) < std::tie(b.m_featureIndex, b.m_obstacleFeature);
}
}  // namespace

void sortContacts(std::vector<Contact>& contacts)
{
    std::sort(contacts.begin(), contacts.end(), comesBefore);
}

void orderContacts(const Contact* unsorted, std::size_t count, std::vector<std::uint32_t>& featureCounts,
                   std::vector<Contact>& contacts, ThreadTeam& threads)
{
    std::uint32_t first = std::uint32_t(contacts.size());
    for (std::uint32_t& number : featureCounts)
        first += std::exchange(number, first);
    contacts.resize(contacts.size() + count);
    // Fills each feature's positions in any order; the sort of the feature follows.
    std::vector<std::uint32_t> last = featureCounts;
    const auto place = [&](std::size_t i)
    { contacts[__atomic_fetch_add(&last[unsorted[i].m_featureIndex], 1u, __ATOMIC_RELAXED)] = unsorted[i]; };
    const auto sort = [&](std::size_t feature)
    {
        if (last[feature] - featureCounts[feature] > 1)
            std::sort(contacts.begin() + featureCounts[feature], contacts.begin() + last[feature], comesBefore);
    };
    const auto forPieces = [&](std::size_t items, const auto& one)
    {
        runShared(threads, count >= kLeastShared, (items + kPiece - 1) / kPiece,
                  [&](std::size_t piece)
                  {
                      for (std::size_t i = piece * kPiece; i < std::min((piece + 1) * kPiece, items); ++i)
                          one(i);
                  });
    };
    forPieces(count, place);
    forPieces(featureCounts.size(), sort);
}
}  // namespace drape
