// Volumes of a hierarchy from its leaves up, run through from left to right by one work-item.
//
// A node is complete when its right child is: whoever finishes a right child merges the pair into the parent and goes
// on from there. A left child's parent waits for the sibling, whose leaves come later.
#ifndef DRAPE_LIB_TREE_REFIT_H
#define DRAPE_LIB_TREE_REFIT_H

#include "../../../kernels/lib/geometry/dop.h"
#include "tree_layout.h"

DRAPE_NAMESPACE_BEGIN

DRAPE_FUNCTION void mergePair(DRAPE_GLOBAL BvhNode* nodes, DRAPE_UINT split, DRAPE_UINT place)
{
    const DRAPE_GLOBAL BvhNode* left = nodes + 2u * split + 1u;
    const DRAPE_GLOBAL BvhNode* right = left + 1;
    DRAPE_GLOBAL BvhNode* node = nodes + place;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        node->m_low[i] = drapeMin(left->m_low[i], right->m_low[i]);
        node->m_high[i] = drapeMax(left->m_high[i], right->m_high[i]);
    }
}

// From a complete node up, through parents of the given tier.
DRAPE_FUNCTION void climbTier(DRAPE_GLOBAL BvhNode* nodes, const DRAPE_GLOBAL DRAPE_UINT* splits, DRAPE_UINT place,
                              DRAPE_UINT tier)
{
    while (place != 0u && (place & 1u) == 0u)
    {
        const DRAPE_UINT split = (place >> 1) - 1u;
        if (splitTier(splits[split]) != tier) return;
        place = splitPlace(splits[split]);
        mergePair(nodes, split, place);
    }
}

// Returns whether a stretch that one work-item or group refits may begin with this leaf: no node of the tier or below
// spans it and the leaf before.
DRAPE_FUNCTION int beginsTier(const DRAPE_GLOBAL DRAPE_UINT* splits, DRAPE_UINT leaf, DRAPE_UINT tier)
{
    return leaf == 0u || splitTier(splits[leaf - 1u]) > tier;
}

// The first such leaf at or after `leaf`; leafCount when there is none.
DRAPE_FUNCTION DRAPE_UINT nextBegin(const DRAPE_GLOBAL DRAPE_UINT* splits, DRAPE_UINT leaf, DRAPE_UINT leafCount,
                                    DRAPE_UINT tier)
{
    while (leaf < leafCount && !beginsTier(splits, leaf, tier))
        ++leaf;
    return leaf < leafCount ? leaf : leafCount;
}

// The largest node of a tier below `tier` whose last leaf is `last`, given the first leaf behind the split before it
// that is of the tier or above.
DRAPE_FUNCTION DRAPE_UINT elementPlace(const DRAPE_GLOBAL BvhNode* nodes, const DRAPE_GLOBAL DRAPE_UINT* splits,
                                       DRAPE_UINT first, DRAPE_UINT last, DRAPE_UINT leafCount, DRAPE_UINT tier)
{
    const DRAPE_UINT left = 2u * last + 1u;
    if (last + 1u < leafCount &&
        (nodes[left].m_count == 0u || splitTier(splits[splitOfPair(nodes[left].m_first)]) < tier))
    {
        return left;
    }
    return 2u * first;
}

// One tier's nodes over leaves first … end - 1, a stretch between two begins.
DRAPE_FUNCTION void refitStretch(DRAPE_GLOBAL BvhNode* nodes, const DRAPE_GLOBAL DRAPE_UINT* splits, DRAPE_UINT first,
                                 DRAPE_UINT end, DRAPE_UINT leafCount, DRAPE_UINT tier)
{
    DRAPE_UINT begin = first;
    for (DRAPE_UINT leaf = first; leaf < end; ++leaf)
    {
        if (leaf + 1u < leafCount && splitTier(splits[leaf]) < tier) continue;
        climbTier(nodes, splits, elementPlace(nodes, splits, begin, leaf, leafCount, tier), tier);
        begin = leaf + 1u;
    }
}

DRAPE_NAMESPACE_END

#endif
