// The binary radix tree over sorted Morton codes: a node splits where the highest bit that differs among its leaves
// does.
//
// Karras, "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d Trees", 2012; here a work-item has the
// split instead of the node, so that every link is known where it is written. Codes have two words; equal codes, and
// codes equal in the bits that count, are told apart by their place.
#ifndef DRAPE_LIB_RADIX_TREE_H
#define DRAPE_LIB_RADIX_TREE_H

#include "tree_layout.h"

DRAPE_NAMESPACE_BEGIN

typedef struct SortedCodes
{
    const DRAPE_GLOBAL DRAPE_UINT* m_high;
    const DRAPE_GLOBAL DRAPE_UINT* m_low;  // equals m_high where codes have one word
    DRAPE_UINT m_bits;                     // from the top of m_high, that may decide a split
    DRAPE_UINT m_count;
} SortedCodes;

// Returns as many bits as leave room for ⌈log2 n⌉ heights below DRAPE_TREE_HEIGHT; unused is how many leading bits are
// never set.
DRAPE_FUNCTION DRAPE_UINT decidingBits(DRAPE_UINT leafCount, DRAPE_UINT codeBits, DRAPE_UINT unused)
{
    const DRAPE_UINT room = DRAPE_TREE_HEIGHT - ceilLog2(leafCount);
    return unused + (codeBits < room ? codeBits : room);
}

DRAPE_FUNCTION DRAPE_UINT leadingZeros(DRAPE_UINT x)
{
#ifdef __OPENCL_VERSION__
    return clz(x);
#else
    return x == 0 ? 32u : DRAPE_UINT(__builtin_clz(x));
#endif
}

// Returns the number of leading bits that two leaves have in common, position included.
DRAPE_FUNCTION DRAPE_UINT commonBits(const SortedCodes* codes, DRAPE_UINT i, DRAPE_UINT j)
{
    const DRAPE_UINT high = codes->m_high[i] ^ codes->m_high[j];
    DRAPE_UINT common = leadingZeros(high);
    if (high == 0u) common = 32u + leadingZeros(codes->m_low[i] ^ codes->m_low[j]);
    return common < codes->m_bits ? common : 64u + leadingZeros(i ^ j);
}

// The end farthest from `from` in steps of ±1 (as two's complement) whose common bits with it exceed `common`, at most
// `room` steps away.
DRAPE_FUNCTION DRAPE_UINT reachOf(const SortedCodes* codes, DRAPE_UINT from, DRAPE_UINT step, DRAPE_UINT room,
                                  DRAPE_UINT common)
{
    DRAPE_UINT bound = 1;
    while (bound <= room && commonBits(codes, from, from + bound * step) > common)
        bound *= 2u;
    DRAPE_UINT reach = bound / 2u;  // reached; less than bound is
    for (DRAPE_UINT add = bound / 2u; add > 1u;)
    {
        add /= 2u;
        const DRAPE_UINT next = reach + add;
        if (next <= room && commonBits(codes, from, from + next * step) > common) reach = next;
    }
    return from + reach * step;
}

// Behind which of the leaves first … last (two or more) their node splits.
DRAPE_FUNCTION DRAPE_UINT splitOfRange(const SortedCodes* codes, DRAPE_UINT first, DRAPE_UINT last)
{
    return reachOf(codes, first, 1u, last - 1u - first, commonBits(codes, first, last));
}

DRAPE_FUNCTION void radixSetNode(const SortedCodes* codes, DRAPE_GLOBAL BvhNode* nodes, DRAPE_GLOBAL DRAPE_UINT* splits,
                                 DRAPE_UINT place, DRAPE_UINT first, DRAPE_UINT last)
{
    if (first == last)
    {
        treeSetLeaf(nodes, place, first);
    }
    else
    {
        treeSetSplit(nodes, splits, place, last - first + 1u, splitOfRange(codes, first, last));
    }
}

// Links of the two nodes that split `split` parts, and of the root where it is the root's.
DRAPE_FUNCTION void radixSetPair(const SortedCodes* codes, DRAPE_GLOBAL BvhNode* nodes, DRAPE_GLOBAL DRAPE_UINT* splits,
                                 DRAPE_UINT split)
{
    const DRAPE_UINT common = commonBits(codes, split, split + 1u);
    const DRAPE_UINT first = reachOf(codes, split, ~0u, split, common);
    const DRAPE_UINT last = reachOf(codes, split + 1u, 1u, codes->m_count - 2u - split, common);
    radixSetNode(codes, nodes, splits, 2u * split + 1u, first, split);
    radixSetNode(codes, nodes, splits, 2u * split + 2u, split + 1u, last);
    if (first == 0u && last + 1u == codes->m_count) treeSetSplit(nodes, splits, 0u, codes->m_count, split);
}

DRAPE_NAMESPACE_END

#endif
