// The layout of the nodes of a binary hierarchy over ordered leaves.
//
// Every inner node splits its leaves behind one leaf s, and no two nodes behind the same; its children are the pair of
// nodes 2s + 1 and 2s + 2. The root is node 0. So n leaves have 2n - 1 nodes, a builder knows where a node goes without
// counting, and the nodes below one over leaves b … e are the stretch 2b + 1 … 2e, whatever the shape.
#ifndef DRAPE_LIB_TREE_LAYOUT_H
#define DRAPE_LIB_TREE_LAYOUT_H

#include "../../../kernels/shared/mesh.h"

DRAPE_NAMESPACE_BEGIN

// No builder makes a higher tree: near this height each halves what is left. Far above ⌈log2 n⌉ of any mesh, so that it
// seldom matters, and low enough for a traversal's stack.
#define DRAPE_TREE_HEIGHT 48

// A node over at most so many leaves is refitted in its subtree's work-group, and one over more in its grove's; what is
// above is left to the last launch, one group. The fewer leaves a subtree has, the more of a group's work-items are
// busy with the subtrees that begin in its window; groves and what is above them have the more nodes for it. A GPU's
// last launch merges up to 1,024 splits in order, those of some 2 million leaves, and more of them more slowly.
#define DRAPE_SUBTREE_LEAVES 32u
#define DRAPE_GROVE_LEAVES 2048u

// One word per split: the place of the node that splits there, and its tier.
#define DRAPE_SPLIT_PLACE 0x3fffffffu
#define DRAPE_SPLIT_TIER_SHIFT 30

DRAPE_FUNCTION DRAPE_UINT splitPlace(DRAPE_UINT word)
{
    return word & DRAPE_SPLIT_PLACE;
}
DRAPE_FUNCTION DRAPE_UINT splitTier(DRAPE_UINT word)
{
    return word >> DRAPE_SPLIT_TIER_SHIFT;
}

DRAPE_FUNCTION DRAPE_UINT tierOfSize(DRAPE_UINT leaves)
{
    return leaves <= DRAPE_SUBTREE_LEAVES ? 0u : leaves <= DRAPE_GROVE_LEAVES ? 1u : 2u;
}

// The split whose pair of children begins at an inner node's m_first.
DRAPE_FUNCTION DRAPE_UINT splitOfPair(DRAPE_UINT first)
{
    return first >> 1;
}

DRAPE_FUNCTION void treeSetLeaf(DRAPE_GLOBAL BvhNode* nodes, DRAPE_UINT place, DRAPE_UINT leaf)
{
    nodes[place].m_first = leaf;
    nodes[place].m_count = 0u;
}

// Makes the node at `place` an inner one over `leaves` leaves, split behind leaf `split`.
DRAPE_FUNCTION void treeSetSplit(DRAPE_GLOBAL BvhNode* nodes, DRAPE_GLOBAL DRAPE_UINT* splits, DRAPE_UINT place,
                                 DRAPE_UINT leaves, DRAPE_UINT split)
{
    nodes[place].m_first = 2u * split + 1u;
    nodes[place].m_count = 2u;
    splits[split] = place | (tierOfSize(leaves) << DRAPE_SPLIT_TIER_SHIFT);
}

// Returns a leaf's position: it is the left child of the split behind it or the right child of the one before.
DRAPE_FUNCTION DRAPE_UINT leafPlace(const DRAPE_GLOBAL BvhNode* nodes, DRAPE_UINT leaf, DRAPE_UINT leafCount)
{
    const DRAPE_UINT left = 2u * leaf + 1u;
    return leaf + 1u < leafCount && nodes[left].m_count == 0u ? left : 2u * leaf;
}

// ⌈log2 n⌉ for n ≥ 1.
DRAPE_FUNCTION DRAPE_UINT ceilLog2(DRAPE_UINT n)
{
    DRAPE_UINT bits = 0;
    while (bits < 32u && ((n - 1u) >> bits) != 0u)
        ++bits;
    return bits;
}

DRAPE_NAMESPACE_END

#endif
