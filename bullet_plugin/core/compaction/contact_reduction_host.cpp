#include <algorithm>
#include <numeric>

#include "contact_reduction.h"

namespace drape
{
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
}  // namespace drape
