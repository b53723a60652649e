// Which cloths a step leaves out where it is over the settings' limits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace drape
{
// Of the cloth slots that take part those to take out so that the others have at most `budget` candidates together:
// those with the most, of equals the last ones. At least one where any takes part, whatever the candidates are: a GPU's
// step may also list too many pairs of triangles and patches. candidates: by slot, of features.
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
