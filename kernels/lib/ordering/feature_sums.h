// Sums that give the position of a feature's contacts in a list ordered by feature, for few features. Kernels that
// count a feature's contacts also add them up by rows of features. Every work-item can then sum for itself, and no
// extra launch has to sum before. For kernels only.
#ifndef DRAPE_LIB_FEATURE_SUMS_H
#define DRAPE_LIB_FEATURE_SUMS_H

#include "../../shared/feature_sums.h"

// Adds `count` contacts of a feature. sums: DRAPE_FEATURE_SUMS elements.
static void addToSums(__global volatile uint* sums, const uint feature, const uint count)
{
    atomic_add(sums + feature / DRAPE_SUMMED, count);
}

#ifndef DRAPE_CPU_KERNELS
// Returns the sum of the first `count` of DRAPE_SUMMED numbers. Uses masks: PoCL 3.1 miscompiles choices by component.
static uint sumOfFirst(__global const uint* numbers, const uint count)
{
    uint4 sums = 0;
    DRAPE_UNROLL
    for (uint i = 0; i < DRAPE_SUMMED; i += 4)
        sums += ((__global const uint4*)numbers)[i / 4] & as_uint4((uint4)(i, i + 1, i + 2, i + 3) < (uint4)(count));
    return sums.x + sums.y + sums.z + sums.w;
}

// Sums rows by DRAPE_SUMMED, in a group of at least DRAPE_WIDE_SUMS work-items. wide: gets DRAPE_WIDE_SUMS sums.
static void sumRows(__global const uint* sums, __local uint* wide)
{
    const uint id = get_local_id(0);
    if (id < DRAPE_WIDE_SUMS) wide[id] = sumOfFirst(sums + id * DRAPE_SUMMED, DRAPE_SUMMED);
    barrier(CLK_LOCAL_MEM_FENCE);
}

static uint sumOfWide(__local const uint* wide, const uint count)
{
    uint sum = 0;
    for (uint i = 0; i < count; ++i)
        sum += wide[i];
    return sum;
}

// Returns the number of contacts in the features before this one. counts: of each feature; wide: from sumRows().
static uint contactsBefore(__global const uint* counts, __global const uint* sums, __local const uint* wide,
                           const uint feature)
{
    const uint row = feature / DRAPE_SUMMED, firstRow = row / DRAPE_SUMMED * DRAPE_SUMMED;
    return sumOfWide(wide, row / DRAPE_SUMMED) + sumOfFirst(sums + firstRow, row - firstRow) +
           sumOfFirst(counts + row * DRAPE_SUMMED, feature % DRAPE_SUMMED);
}

// Zeroes counts and sums; all work-items of the launch call it together.
static void clearSums(__global uint* counts, __global uint* sums, const uint features)
{
    for (uint i = get_global_id(0); i < features; i += get_global_size(0))
        counts[i] = 0;
    for (uint i = get_global_id(0); i < DRAPE_FEATURE_SUMS; i += get_global_size(0))
        sums[i] = 0;
}
#endif

#endif
