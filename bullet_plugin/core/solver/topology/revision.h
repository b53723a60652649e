// Numbers that tell states apart: no two calls return the same.
#pragma once

#include <atomic>
#include <cstdint>

namespace drape
{
inline std::uint64_t newRevision()
{
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}
}  // namespace drape
