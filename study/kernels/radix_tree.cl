// Links of the radix tree over sorted Morton codes.
#include "lib/radix_tree.h"

// A work-item is a split: it writes the links of the two nodes it parts, whose places no other work-item writes.
__kernel void radixTreeLinks(__global const uint* restrict high, __global const uint* restrict low, const uint bits,
                             const uint leafCount, __global BvhNode* restrict nodes, __global uint* restrict splits)
{
    const uint split = get_global_id(0);
    if (leafCount == 1 && split == 0) treeSetLeaf(nodes, 0, 0);
    if (split + 1 >= leafCount) return;
    SortedCodes codes;
    codes.m_high = high;
    codes.m_low = low;
    codes.m_bits = bits;
    codes.m_count = leafCount;
    radixSetPair(&codes, nodes, splits, split);
}
