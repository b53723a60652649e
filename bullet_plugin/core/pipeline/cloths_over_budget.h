// Selects the cloths that a step leaves out when it exceeds the settings' limits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace drape
{
// Returns the cloth slots to leave out so that the other active ones have at most `budget` candidates together: the
// slots with the most candidates, the last ones among equals. Returns at least one if any is active: a step is too
// large by its feature pairs, while candidates are triangle pairs. candidates: by slot.
inline std::vector<std::size_t> clothsOverBudget(std::vector<std::size_t> slots,
                                                 const std::vector<std::uint64_t>& candidates, std::uint64_t budget)
{
    std::stable_sort(slots.begin(), slots.end(),
                     [&](std::size_t a, std::size_t b) { return candidates[a] < candidates[b]; });
    std::uint64_t sum = 0;
    std::size_t kept = 0;
    while (kept + 1 < slots.size() && sum + candidates[slots[kept]] <= budget)
        sum += candidates[slots[kept++]];
    slots.erase(slots.begin(), slots.begin() + std::ptrdiff_t(kept));
    return slots;
}
}  // namespace drape
