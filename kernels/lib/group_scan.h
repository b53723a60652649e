// Prefix sums within a work-group. For devices only: it needs barriers.
#ifndef DRAPE_LIB_GROUP_SCAN_H
#define DRAPE_LIB_GROUP_SCAN_H

#ifdef __OPENCL_VERSION__

// Sums value over the work-items before this one; total gets the group's sum. scratch holds one uint per work-item.
static uint groupPrefix(__local uint* scratch, const uint value, uint* total)
{
    const uint id = get_local_id(0);
    const uint size = get_local_size(0);
    scratch[id] = value;
    barrier(CLK_LOCAL_MEM_FENCE);
    // Loops with barriers run at least once: where they might not, some compilers copy all that follows, once per outcome.
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

#endif

#endif
