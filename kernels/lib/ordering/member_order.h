// Sorts the members of a feature by their keys, the obstacle features, in a work-group. For devices only: needs
// barriers.
#ifndef DRAPE_LIB_MEMBER_ORDER_H
#define DRAPE_LIB_MEMBER_ORDER_H

#include "../../shared/contact.h"

// Maximum members of a feature that a work-group sorts by counting, in local memory; more are sorted in place.
#define DRAPE_COUNTED 512

// Sorts one pair of positions.
static void orderPair(__global uint* members, __global uint* keys, const uint low, const uint high)
{
    const uint a = keys[low], b = keys[high];
    if (a <= b) return;
    keys[low] = b;
    keys[high] = a;
    const uint member = members[low];
    members[low] = members[high];
    members[high] = member;
}

// Sorts `count` members by their keys, in place, with both lists alike; one work-group. Batcher's bitonic network,
// whose merges begin with a mirrored step so that the lesser key always goes to the lower position. Positions from
// `count` on therefore count as greater than all and need not exist. Every position is in one pair per step; the
// barrier orders the steps. The two lists are separate from the contacts, which are more than a CPU's cache holds.
static void sortMembers(__global uint* members, __global uint* keys, const uint count)
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
                if (high < count) orderPair(members, keys, begin + offset, high);
            }
            barrier(CLK_GLOBAL_MEM_FENCE);
        }
    }
}

// Sorts at most DRAPE_COUNTED members by counting and leaves the keys unchanged: a member's position is the number of
// members with a lesser key. own, ownKeys: hold that many.
static void countMembers(__global uint* members, __global const uint* keys, const uint count, __local uint* own,
                         __local uint* ownKeys)
{
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        own[i] = members[i];
        ownKeys[i] = keys[i];
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        const uint key = ownKeys[i];
        uint before = 0;
        for (uint j = 0; j < count; ++j)
            before += ownKeys[j] < key;
        members[before] = own[i];
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
}

// Sorts in either way, depending on the number of members. The keys are invalid afterwards.
static void orderMembers(__global uint* members, __global uint* keys, const uint count, __local uint* own,
                         __local uint* ownKeys)
{
    if (count <= DRAPE_COUNTED)
        countMembers(members, keys, count, own, ownKeys);
    else
        sortMembers(members, keys, count);
}

#endif
