// Prefix sums within a work-group. For devices only: it needs barriers.
#ifndef DRAPE_LIB_GROUP_SCAN_H
#define DRAPE_LIB_GROUP_SCAN_H

#include "../../shared/types.h"

#ifdef __OPENCL_VERSION__

// Sums value over the work-items before this one; total gets the group's sum. scratch holds one uint per work-item.
static uint groupPrefix(__local uint* scratch, const uint value, uint* total)
{
    const uint id = get_local_id(0);
    const uint size = get_local_size(0);
    scratch[id] = value;
    barrier(CLK_LOCAL_MEM_FENCE);
    // Loops with barriers run at least once: otherwise some compilers copy all code that follows, once per outcome.
    uint step = 1;
    do
    {
        const uint left = id >= step ? scratch[id - step] : 0;
        barrier(CLK_LOCAL_MEM_FENCE);
        scratch[id] += left;
        barrier(CLK_LOCAL_MEM_FENCE);
        step <<= 1;
    } while (step < size);
    *total = scratch[size - 1];
    const uint before = scratch[id] - value;
    barrier(CLK_LOCAL_MEM_FENCE);
    return before;
}

// Number of a work-item's loads that do not wait for each other.
#define DRAPE_TOGETHER 8

// Returns the sum of the first `count` numbers; all of the group's work-items call it together.
static uint groupSumOf(__global const uint* restrict numbers, const uint count, __local uint* scratch)
{
    uint sum = 0, total;
    for (uint first = get_local_id(0); first < count; first += DRAPE_TOGETHER * get_local_size(0))
    {
        DRAPE_UNROLL
        for (uint i = 0; i < DRAPE_TOGETHER; ++i)
        {
            const uint other = first + i * get_local_size(0);
            sum += other < count ? numbers[other] : 0;
        }
    }
    groupPrefix(scratch, sum, &total);
    return total;
}

#endif

#endif
