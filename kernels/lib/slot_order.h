// The members of a slot in order of their obstacle features, by a work-group. For devices only: it needs barriers.
#ifndef DRAPE_LIB_SLOT_ORDER_H
#define DRAPE_LIB_SLOT_ORDER_H

#include "../shared/contact.h"

// Members of a slot that a work-group puts in order by counting, in local memory; more are sorted where they are.
#define DRAPE_COUNTED 512

// Puts one pair of members in order.
static void orderPair(__global const Contact* hits, __global uint* low, __global uint* high)
{
    const uint a = *low, b = *high;
    if (hits[a].m_obstacleFeature <= hits[b].m_obstacleFeature) return;
    *low = b;
    *high = a;
}

// A work-group sorts count members by obstacle feature, in place: Batcher's bitonic network, its merges begun with a
// mirrored step so that the lesser always goes to the lower place. So places from count on count as greater than all and
// need not exist. In a step every place is in one pair; the barrier orders the steps.
static void sortMembers(__global const Contact* hits, __global uint* members, const uint count)
{
    for (uint size = 2; size / 2 < count; size *= 2)
    {
        const uint pairs = (count + size - 1) / size * (size / 2);
        for (uint stride = size / 2; stride > 0; stride /= 2)
        {
            for (uint i = get_local_id(0); i < pairs; i += get_local_size(0))
            {
                const uint begin = i / stride * stride * 2, offset = i % stride;
                const uint high = begin + (stride == size / 2 ? size - 1 - offset : stride + offset);
                if (high < count) orderPair(hits, members + begin + offset, members + high);
            }
            barrier(CLK_GLOBAL_MEM_FENCE);
        }
    }
}

// The same for DRAPE_COUNTED members at most: each goes behind as many as have a lesser feature. keys, own: that many.
static void countMembers(__global const Contact* hits, __global uint* members, const uint count, __local uint* keys,
                         __local uint* own)
{
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        own[i] = members[i];
        keys[i] = hits[own[i]].m_obstacleFeature;
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        const uint key = keys[i];
        uint before = 0;
        for (uint j = 0; j < count; ++j) before += keys[j] < key;
        members[before] = own[i];
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
}

// Either, by how many they are.
static void orderMembers(__global const Contact* hits, __global uint* members, const uint count, __local uint* keys,
                         __local uint* own)
{
    if (count <= DRAPE_COUNTED)
        countMembers(hits, members, count, keys, own);
    else
        sortMembers(hits, members, count);
}

#endif
