// How well a hierarchy fits: what a rebuild is decided by.
#include "lib/group_reduce.h"
#include "lib/tree_cost.h"

// A work-item takes every stride-th node; a work-group writes the sum of its nodes' areas, in parts of the root's. Whole
// numbers, so the total does not depend on who adds what.
__kernel void treeCostSums(__global const BvhNode* restrict nodes, const uint nodeCount, const uint root,
                           __global ulong* restrict sums, __local ulong* scratch)
{
    ulong sum = 0;
    for (uint i = get_global_id(0); i < nodeCount; i += get_global_size(0)) sum += areaParts(nodes + i, nodes + root);
    sum = groupSum(scratch, sum);
    if (get_local_id(0) == 0) sums[get_group_id(0)] = sum;
}
