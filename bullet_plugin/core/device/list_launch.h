// Width and group of a launch over a list whose length is only on the device; see kernels/lib/item_runs.h.
#pragma once

#include <cstddef>

#include "device.h"

namespace drape
{
// Work-items: on a GPU enough to hide its latency, on a CPU to even out runs of dear and of cheap items.
inline std::size_t listWidth(const Device& device)
{
    return device.computeUnits() * (device.isGpu() ? 1024 : 256);
}

// Of a group. PoCL's threads take half of the groups that are left at a time: small groups make such halves even.
inline std::size_t listGroup(const Device& device)
{
    return device.isGpu() ? 64 : 8;
}
}  // namespace drape
