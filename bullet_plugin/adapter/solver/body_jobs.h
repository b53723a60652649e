// Shares work on soft bodies among threads: small bodies side by side, large ones in ranges of their nodes or links.
//
// Results must not depend on the order or the thread. Cost: none but the work's own while it is not worth a thread.
#pragma once

#include <cstddef>

#include "bullet_plugin/core/threads/ranges.h"

namespace drape
{
// Minimum nodes or links of a body for sharing a pass over them, and those of a range.
constexpr std::size_t kLeastShared = 8192, kRange = 2048;

// Minimum nodes of all small bodies for waking threads: a pass over them takes some 100 µs.
constexpr std::size_t kLeastTogether = 4096;

// Calls work(first, last) for ranges of `count` elements. threads: null for the caller alone.
template <class Work>
void forRanges(std::size_t count, ThreadTeam* threads, const Work& work)
{
    forRanges(count, kLeastShared, kRange, threads, work);
}

// Calls work(i, threads) for every i below `count`, with no threads for small bodies. sizeOf(i): the body's nodes; 0
// for one without work.
template <class SizeOf, class Work>
void forBodies(std::size_t count, ThreadTeam& threads, const SizeOf& sizeOf, const Work& work)
{
    std::size_t small = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (sizeOf(i) < kLeastShared) small += sizeOf(i);
    const auto workAlone = [&](std::size_t i)
    {
        if (sizeOf(i) > 0 && sizeOf(i) < kLeastShared) work(i, static_cast<ThreadTeam*>(nullptr));
    };
    if (small > 0) runShared(threads, small >= kLeastTogether, count, workAlone);
    for (std::size_t i = 0; i < count; ++i)
        if (sizeOf(i) >= kLeastShared) work(i, &threads);
}
}  // namespace drape
