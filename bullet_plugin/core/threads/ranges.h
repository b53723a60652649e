// Shares a pass over many elements among threads, in ranges of adjacent ones.
#pragma once

#include <algorithm>
#include <cstddef>

#include "thread_team.h"

namespace drape
{
// Calls work(first, last) for ranges of at most `range` of `count` elements, in any order and on any thread; once for
// all of them if there are fewer than `least`. threads: null for the caller alone.
template <class Work>
void forRanges(std::size_t count, std::size_t least, std::size_t range, ThreadTeam* threads, const Work& work)
{
    if (!threads || count < least) return work(std::size_t(0), count);
    threads->run((count + range - 1) / range,
                 [&](std::size_t i) { work(i * range, std::min(count, (i + 1) * range)); });
}
}  // namespace drape
