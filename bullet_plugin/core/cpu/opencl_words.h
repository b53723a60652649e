// OpenCL C's words in C++, for CPU kernels that threads run an item at a time: kernels with independent work-items,
// in groups of one. Their text is included after this in a namespace of its own.
#pragma once

#include <climits>
#include <cmath>
#include <cstdint>

#define __kernel static
#define __global
#define __local
#define restrict __restrict

namespace drape
{
namespace
{
using uint = std::uint32_t;
using ulong = std::uint64_t;
using ushort = std::uint16_t;

// The thread's current work-item, and the number of work-items.
thread_local uint t_item, t_items;

inline uint get_global_id(int)
{
    return t_item;
}
inline uint get_global_size(int)
{
    return t_items;
}
inline uint get_group_id(int)
{
    return t_item;
}
inline uint get_num_groups(int)
{
    return t_items;
}
inline uint get_local_id(int)
{
    return 0;
}
inline uint get_local_size(int)
{
    return 1;
}

// Runs work-item `item` of so many.
template <class Kernel>
inline void runItem(uint item, uint items, const Kernel& kernel)
{
    t_item = item;
    t_items = items;
    kernel();
}

inline uint min(uint a, uint b)
{
    return b < a ? b : a;
}
inline uint max(uint a, uint b)
{
    return a < b ? b : a;
}
inline int popcount(uint a)
{
    return __builtin_popcount(a);
}
inline uint clz(uint a)
{
    return a == 0 ? 32 : uint(__builtin_clz(a));
}
inline uint atomic_add(volatile uint* number, uint more)
{
    return __atomic_fetch_add(number, more, __ATOMIC_RELAXED);
}
inline uint atomic_inc(volatile uint* number)
{
    return atomic_add(number, 1);
}
}  // namespace
}  // namespace drape
