// The stretch of leaves that a work-group refits. For devices only: it needs barriers.
#ifndef DRAPE_LIB_TREE_STRETCH_H
#define DRAPE_LIB_TREE_STRETCH_H

#ifdef __OPENCL_VERSION__

// Words that a work-item has on their way at a time, so that a long stretch waits for memory once per so many.
#define DRAPE_STRETCH_BATCH 8u

// The first begins of a tier at or after `from` and at or after `from + window`. Every work-item of the group calls it.
static void stretchOfWindow(__global const uint* restrict splits, const uint from, const uint window,
                            const uint leafCount, const uint tier, __local uint* stretch)
{
    const uint size = get_local_size(0);
    if (get_local_id(0) < 2) stretch[get_local_id(0)] = leafCount;
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint limit = min(leafCount, from + 2 * window);
    for (uint leaf = from + get_local_id(0); leaf < limit; leaf += DRAPE_STRETCH_BATCH * size)
    {
        uint begins = 0;
        for (uint k = 0; k < DRAPE_STRETCH_BATCH; ++k)
        {
            if (leaf + k * size < limit) begins |= (uint)beginsTier(splits, leaf + k * size, tier) << k;
        }
        for (; begins != 0; begins &= begins - 1)
        {
            const uint begin = leaf + (31 - clz(begins & -begins)) * size;
            atomic_min(stretch + 0, begin);
            if (begin >= from + window) atomic_min(stretch + 1, begin);
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

#endif

#endif
