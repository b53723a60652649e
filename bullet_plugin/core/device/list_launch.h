// Width and group of a launch over a list whose length is only on the device; see kernels/lib/work_items/item_runs.h.
#pragma once

#include <algorithm>
#include <cstddef>

#include "device.h"

namespace drape
{
// Work-items per compute unit: on a GPU enough to hide its latency, on a CPU enough to balance runs of expensive and
// cheap items.
constexpr std::size_t kListItemsGpu = 1024, kListItemsCpu = 256;

// Work-items per group. PoCL's threads take a share of the remaining groups at a time: small groups balance the shares.
constexpr std::size_t kListGroupGpu = 64, kListGroupCpu = 8;

inline std::size_t listWidth(const Device& device)
{
    return device.computeUnits() * (device.isGpu() ? kListItemsGpu : kListItemsCpu);
}

inline std::size_t listGroup(const Device& device)
{
    return device.isGpu() ? kListGroupGpu : kListGroupCpu;
}

// Returns the width for a list of about `items` items. A GPU starts little more than one work-item per item, but
// enough of them that a much longer list does not take long.
inline std::size_t listWidth(const Device& device, std::size_t items)
{
    const std::size_t most = listWidth(device), group = listGroup(device);
    if (!device.isGpu() || items > most) return most;
    return std::clamp((items + items / 8 + group) / group * group, most / 8, most);
}

// Returns the width for a list whose items a CPU's work-item processes a vector of lanes at a time. Few work-items,
// each in a group of its own, then have many items each.
constexpr std::size_t kLaneItemsCpu = 16;

inline std::size_t laneListWidth(const Device& device)
{
    return device.isGpu() ? listWidth(device) : device.computeUnits() * kLaneItemsCpu;
}

// Work-items that copy a contact together: one per vector of it on a GPU, which joins neighbours' stores.
inline cl_uint copyParts(const Device& device)
{
    return device.isGpu() ? 4 : 1;
}
}  // namespace drape
