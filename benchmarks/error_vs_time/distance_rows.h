// Compares the narrow phase's tests of resting pairs with tests in plain float and in double.
#pragma once

#include <cstddef>

#include "benchmarks/support/table.h"

namespace drape::bench
{
// Rows of the sets of distance_sets.h, on the host: the functions are those that a device runs, to the same bits.
// Variants: the contact tests in their three modes; the closest points in float without a frame of the pair's own, as
// they would be written first; the same in double.
void addDistanceRows(std::size_t pairs, Table& table);
}  // namespace drape::bench
