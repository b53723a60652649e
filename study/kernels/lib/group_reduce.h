// Sums and hulls over a work-group. For devices only: they need barriers. Groups are powers of two.
#ifndef DRAPE_LIB_GROUP_REDUCE_H
#define DRAPE_LIB_GROUP_REDUCE_H

#ifdef __OPENCL_VERSION__
#include "../../../kernels/lib/geometry/dop.h"

// Returns the sum of every work-item's value to all of them. scratch holds one ulong per work-item.
static ulong groupSum(__local ulong* scratch, const ulong value)
{
    const uint id = get_local_id(0);
    scratch[id] = value;
    barrier(CLK_LOCAL_MEM_FENCE);
    uint reach = get_local_size(0);
    do  // at least once, see groupPrefix()
    {
        reach /= 2;
        if (id < reach) scratch[id] += scratch[id + reach];
        barrier(CLK_LOCAL_MEM_FENCE);
    } while (reach > 1);
    const ulong sum = scratch[0];
    barrier(CLK_LOCAL_MEM_FENCE);
    return sum;
}

// Computes the hull of every work-item's volume in the first one's. scratch: two floats per direction and work-item.
static void groupHull(__local float* scratch, Dop* dop)
{
    const uint id = get_local_id(0);
    const uint size = get_local_size(0);
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        scratch[2 * i * size + id] = dop->m_low[i];
        scratch[(2 * i + 1) * size + id] = dop->m_high[i];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    uint reach = size;
    do
    {
        reach /= 2;
        if (id < reach)
        {
            for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
            {
                __local float* low = scratch + 2 * i * size;
                __local float* high = low + size;
                low[id] = drapeMin(low[id], low[id + reach]);
                high[id] = drapeMax(high[id], high[id + reach]);
            }
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    } while (reach > 1);
    if (id == 0)
    {
        for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
        {
            dop->m_low[i] = scratch[2 * i * size];
            dop->m_high[i] = scratch[(2 * i + 1) * size];
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

#endif

#endif
