// Sorts a long list with several threads: ranges first, then pairs of sorted ranges.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "ranges.h"

namespace drape
{
// Sorts like std::sort(). The order of equal elements is the same with any number of threads.
template <class T, class Less>
void sharedSort(std::vector<T>& list, ThreadTeam& threads, const Less& isLess)
{
    constexpr std::size_t kRange = 1 << 13;
    const auto at = [](std::vector<T>& from, std::size_t index)
    { return from.begin() + std::ptrdiff_t(std::min(index, from.size())); };
    forRanges(list.size(), 2 * kRange, kRange, &threads,
              [&](std::size_t first, std::size_t last) { std::sort(at(list, first), at(list, last), isLess); });
    if (list.size() < 2 * kRange) return;
    std::vector<T> merged(list.size());
    for (std::size_t width = kRange; width < list.size(); width *= 2)
    {
        const auto merge = [&](std::size_t i)
        {
            const std::size_t first = 2 * width * i;
            std::merge(at(list, first), at(list, first + width), at(list, first + width), at(list, first + 2 * width),
                       at(merged, first), isLess);
        };
        threads.run((list.size() + 2 * width - 1) / (2 * width), merge);
        list.swap(merged);
    }
}
}  // namespace drape
