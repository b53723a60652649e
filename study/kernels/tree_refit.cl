// Refit of a hierarchy in two or three launches: whole subtrees first, then groves of subtrees, then what spans groves.
// Each launch reads what the one before wrote; nothing is passed between work-groups inside a launch.
#include "lib/tree_refit.h"

// Leaves in a window: of a work-item, and of a group. A group has an item for each leaf of the whole subtrees that
// begin in its window, the last of which ends less than DRAPE_SUBTREE_LEAVES behind it.
#define DRAPE_SERIAL_WINDOW 64
#define DRAPE_SUBTREE_GROUP 128
#define DRAPE_SUBTREE_WINDOW (DRAPE_SUBTREE_GROUP - DRAPE_SUBTREE_LEAVES)
#define DRAPE_GROVE_GROUP 256

// A work-item is a window of leaves; it refits, one after the other, the subtrees that begin in it.
__kernel void refitSubtreesSerial(__global BvhNode* restrict nodes, __global const uint* restrict splits,
                                  __global const uint* restrict order, __global const Triangle* restrict triangles,
                                  __global const float* restrict start, __global const float* restrict end,
                                  __global const float* restrict meshRadius, __global StepCounters* restrict counters,
                                  const uint leafCount)
{
    const uint window = get_global_id(0) * DRAPE_SERIAL_WINDOW;
    if (window >= leafCount) return;
    const uint first = nextBegin(splits, window, leafCount, 0u);
    if (first >= window + DRAPE_SERIAL_WINDOW) return;
    const uint last = nextBegin(splits, window + DRAPE_SERIAL_WINDOW, leafCount, 0u);
    uint invalid = 0;
    for (uint leaf = first; leaf < last; ++leaf)
    {
        __global const Triangle* triangle = triangles + order[leaf];
        Dop dop;
        invalid += leafVolume(&dop, triangle, start, end, meshRadius[triangle->m_mesh]);
        const uint place = leafPlace(nodes, leaf, leafCount);
        dopStore(nodes + place, &dop);
        climbTier(nodes, splits, place, 0u);
    }
    if (invalid > 0) atomic_add(&counters->m_invalidNodes, invalid);
}

// A work-item is a window of a grove's leaves; it refits the groves that begin in it, from their subtrees up.
__kernel void refitGrovesSerial(__global BvhNode* restrict nodes, __global const uint* restrict splits,
                                const uint leafCount)
{
    const uint window = get_global_id(0) * DRAPE_GROVE_LEAVES;
    if (window >= leafCount) return;
    const uint first = nextBegin(splits, window, leafCount, 1u);
    if (first >= window + DRAPE_GROVE_LEAVES) return;
    refitStretch(nodes, splits, first, nextBegin(splits, window + DRAPE_GROVE_LEAVES, leafCount, 1u), leafCount, 1u);
}

// One work-item refits what spans groves. tops: how many splits there are, and then the splits, in order.
__kernel void refitTopsSerial(__global BvhNode* restrict nodes, __global const uint* restrict splits,
                              __global const uint* restrict tops, const uint leafCount)
{
    if (get_global_id(0) > 0) return;
    uint begin = 0;
    for (uint i = 0; i <= tops[0]; ++i)
    {
        const uint last = i < tops[0] ? tops[1 + i] : leafCount - 1;
        climbTier(nodes, splits, elementPlace(nodes, splits, begin, last, leafCount, 2u), 2u);
        begin = last + 1;
    }
}

// The first begins of a tier, whose nodes have no more than `most` leaves, at or after `from` and at or after
// `from + window`. Every work-item of the group calls it.
static void stretchOfWindow(__global const uint* restrict splits, const uint from, const uint window, const uint most,
                            const uint leafCount, const uint tier, __local uint* stretch)
{
    if (get_local_id(0) < 2) stretch[get_local_id(0)] = leafCount;
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint limit = min(leafCount, from + window + most);
    for (uint leaf = from + get_local_id(0); leaf < limit; leaf += get_local_size(0))
    {
        if (!beginsTier(splits, leaf, tier)) continue;
        atomic_min(stretch + 0, leaf);
        if (leaf >= from + window) atomic_min(stretch + 1, leaf);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// A group's volumes while they are made: leaves first, then the nodes by their split. A volume's words lie side by
// side; their number is made odd, so that work-items that each write a volume of their own do not fall on one bank.
#define DRAPE_SUBTREE_PLACES (2 * DRAPE_SUBTREE_GROUP)
#define DRAPE_DOP_WORDS (2 * DRAPE_DOP_DIRECTIONS)
#define DRAPE_VOLUME_STRIDE (DRAPE_DOP_WORDS + 1)
#define DRAPE_NODE_WORDS (DRAPE_DOP_WORDS + 2)
// Volumes that a group merges, and nodes that it writes, at once: a work-item for each word.
#define DRAPE_MERGES_AT_ONCE (DRAPE_SUBTREE_GROUP / DRAPE_DOP_WORDS)
#define DRAPE_NODES_AT_ONCE (DRAPE_SUBTREE_GROUP / DRAPE_NODE_WORDS)
#define DRAPE_NO_PLACE 0xffffu

// Data that a group shares. Leaves and splits are numbered from its window's first leaf on.
typedef struct Subtrees
{
    float m_volumes[DRAPE_SUBTREE_PLACES * DRAPE_VOLUME_STRIDE];
    ushort m_children[DRAPE_SUBTREE_PLACES];      // volumes of each split's pair
    ushort m_indexOfPlace[DRAPE_SUBTREE_PLACES];  // volume of each node of the stretch
    uchar m_done[DRAPE_SUBTREE_PLACES];           // which volumes are done
    ushort m_merges[DRAPE_SUBTREE_GROUP];         // splits, in the order in which their pairs are merged
    uint m_mergeCount, m_mergesBegun;
    uint m_stretch[2];
} Subtrees;

// Makes this work-item's split's node the child that its place says. Of a parent that is merged elsewhere nobody asks.
static void setChild(__local Subtrees* subtrees, const uint place, const uint window)
{
    const uint behind = (place + 1u) / 2u;  // the first leaf behind the parent's split; 0: the root has none
    if (behind <= window) return;
    subtrees->m_children[2u * (behind - 1u - window) + (place & 1u ? 0u : 1u)] =
        (ushort)(DRAPE_SUBTREE_GROUP + get_local_id(0));
}

static void keepVolume(__local float* volume, const Dop* dop)
{
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        volume[i] = dop->m_low[i];
        volume[DRAPE_DOP_DIRECTIONS + i] = dop->m_high[i];
    }
}

// A word of a split's volume, from its pair's.
static void mergeWord(__local Subtrees* subtrees, const uint split, const uint word)
{
    const float left = subtrees->m_volumes[subtrees->m_children[2u * split] * DRAPE_VOLUME_STRIDE + word];
    const float right = subtrees->m_volumes[subtrees->m_children[2u * split + 1u] * DRAPE_VOLUME_STRIDE + word];
    subtrees->m_volumes[(DRAPE_SUBTREE_GROUP + split) * DRAPE_VOLUME_STRIDE + word] =
        word < DRAPE_DOP_DIRECTIONS ? drapeMin(left, right) : drapeMax(left, right);
}

// Merges pairs whose volumes are both there, until all are. waits: whether the work-item's split has a pair to merge.
// All work-items share the words of the merges of a turn, since the higher ones are few.
static void mergeSubtrees(__local Subtrees* subtrees, int waits)
{
    const uint item = get_local_id(0), turn = item / DRAPE_DOP_WORDS, word = item % DRAPE_DOP_WORDS;
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint count = subtrees->m_mergeCount;
    for (uint merged = 0; merged < count;)
    {
        const int ready = waits && subtrees->m_done[subtrees->m_children[2u * item]] &&
                          subtrees->m_done[subtrees->m_children[2u * item + 1u]];
        if (ready) subtrees->m_merges[atomic_inc(&subtrees->m_mergesBegun)] = (ushort)item;
        barrier(CLK_LOCAL_MEM_FENCE);
        const uint begun = subtrees->m_mergesBegun;
        for (uint i = merged + turn; i < begun && turn < DRAPE_MERGES_AT_ONCE; i += DRAPE_MERGES_AT_ONCE)
            mergeWord(subtrees, subtrees->m_merges[i], word);
        if (ready)
        {
            subtrees->m_done[DRAPE_SUBTREE_GROUP + item] = 1;
            waits = 0;
        }
        merged = begun;
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}

// A word of the node at a place: of its volume, or of what treeSetLeaf() and treeSetSplit() wrote, which a memory that
// is written whole need not be read for.
static uint nodeWord(__local const Subtrees* subtrees, const uint window, const uint index, const uint word)
{
    if (word < DRAPE_DOP_WORDS) return as_uint(subtrees->m_volumes[index * DRAPE_VOLUME_STRIDE + word]);
    const int isLeaf = index < DRAPE_SUBTREE_GROUP;
    const uint number = window + (isLeaf ? index : index - DRAPE_SUBTREE_GROUP);
    if (word == DRAPE_DOP_WORDS) return isLeaf ? number : 2u * number + 1u;
    return isLeaf ? 0u : 2u;
}

// Writes nodes word by word, so that neighbouring work-items write neighbouring words: the nodes of a stretch of leaves
// lie side by side, `places` of them from `base` on.
static void storeStretch(__global BvhNode* nodes, const uint base, const uint places, __local const Subtrees* subtrees,
                         const uint window)
{
    const uint turn = get_local_id(0) / DRAPE_NODE_WORDS, word = get_local_id(0) % DRAPE_NODE_WORDS;
    __global uint* words = (__global uint*)(nodes + base) + word;
    for (uint place = turn; place < places && turn < DRAPE_NODES_AT_ONCE; place += DRAPE_NODES_AT_ONCE)
    {
        const uint index = subtrees->m_indexOfPlace[place];
        if (index != DRAPE_NO_PLACE) words[place * DRAPE_NODE_WORDS] = nodeWord(subtrees, window, index, word);
    }
}

// A work-group is a window of leaves; it refits the subtrees that begin in it. A work-item has one leaf and the split
// behind it. Volumes stay in local memory until all are there; they are minima and maxima, so the order of merging does
// not show.
__kernel __attribute__((reqd_work_group_size(DRAPE_SUBTREE_GROUP, 1, 1))) void refitSubtreesGroups(
    __global BvhNode* restrict nodes, __global const uint* restrict splits, __global const uint* restrict order,
    __global const Triangle* restrict triangles, __global const float* restrict start,
    __global const float* restrict end, __global const float* restrict meshRadius,
    __global StepCounters* restrict counters, const uint leafCount)
{
    __local Subtrees subtrees;
    const uint item = get_local_id(0), window = get_group_id(0) * DRAPE_SUBTREE_WINDOW, leaf = window + item;
    const uint word = leaf + 1u < leafCount ? splits[leaf] : 0xffffffffu;
    const uint owner = leaf < leafCount ? order[leaf] : 0u;
    if (item == 0) subtrees.m_mergeCount = subtrees.m_mergesBegun = 0;
    subtrees.m_children[2u * item] = (ushort)item;  // leaves, where no split's node is
    subtrees.m_children[2u * item + 1u] = (ushort)(item + 1u);
    subtrees.m_indexOfPlace[item] = subtrees.m_indexOfPlace[DRAPE_SUBTREE_GROUP + item] = DRAPE_NO_PLACE;
    subtrees.m_done[item] = 1;
    subtrees.m_done[DRAPE_SUBTREE_GROUP + item] = 0;
    stretchOfWindow(splits, window, DRAPE_SUBTREE_WINDOW, DRAPE_SUBTREE_LEAVES, leafCount, 0u, subtrees.m_stretch);
    const uint first = subtrees.m_stretch[0], last = subtrees.m_stretch[1];
    if (first >= window + DRAPE_SUBTREE_WINDOW || first >= last) return;

    const int present = leaf >= first && leaf < last;
    const int merges = present && leaf + 1u < last && splitTier(word) == 0u;
    // The split behind a subtree's last leaf is merged by a later launch.
    uint place = present && !merges ? leafPlace(nodes, leaf, leafCount) : 0u;
    if (merges)
    {
        setChild(&subtrees, splitPlace(word), window);
        subtrees.m_indexOfPlace[splitPlace(word) - 2u * first] = (ushort)(DRAPE_SUBTREE_GROUP + item);
        atomic_inc(&subtrees.m_mergeCount);
    }
    if (present)
    {
        __global const Triangle* triangle = triangles + owner;
        Dop dop;
        const uint invalid = leafVolume(&dop, triangle, start, end, meshRadius[triangle->m_mesh]);
        if (invalid > 0) atomic_add(&counters->m_invalidNodes, invalid);
        keepVolume(subtrees.m_volumes + item * DRAPE_VOLUME_STRIDE, &dop);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (merges) place = subtrees.m_children[2u * item] == item ? 2u * leaf + 1u : 2u * leaf;
    if (present) subtrees.m_indexOfPlace[place - 2u * first] = (ushort)item;
    mergeSubtrees(&subtrees, merges);
    storeStretch(nodes, 2u * first, 2u * (last - first), &subtrees, window);
}

// Splits of one tier that a group merges, lower ones first: so many at most.
#ifndef DRAPE_MERGED
#define DRAPE_MERGED 1024
#endif
typedef struct Merges
{
    uint m_splits[DRAPE_MERGED];
    uint m_places[DRAPE_MERGED];     // positions of their nodes
    uint m_waits[DRAPE_MERGED];      // children of each that are to be merged before it
    ushort m_parents[DRAPE_MERGED];  // their parents, here, or DRAPE_NO_PLACE
    ushort m_queue[DRAPE_MERGED];    // splits whose children are complete, in the order in which they became so
    uint m_queued;
} Merges;

// Merges that a group has under way, a work-item for each word, and how many of them a work-item loads together.
#define DRAPE_WORDS_AT_ONCE (DRAPE_GROVE_GROUP / DRAPE_DOP_WORDS)
#define DRAPE_WORDS_TOGETHER 4

// Merges the pairs of those from first up to last in the queue.
static void mergeQueued(__global BvhNode* nodes, __local const Merges* merges, const uint first, const uint last)
{
    const uint turn = get_local_id(0) / DRAPE_DOP_WORDS, word = get_local_id(0) % DRAPE_DOP_WORDS;
    __global float* words = (__global float*)nodes + word;
    for (uint next = first + turn; next < last && turn < DRAPE_WORDS_AT_ONCE;
         next += DRAPE_WORDS_TOGETHER * DRAPE_WORDS_AT_ONCE)
    {
        float left[DRAPE_WORDS_TOGETHER], right[DRAPE_WORDS_TOGETHER];
        DRAPE_UNROLL
        for (uint k = 0; k < DRAPE_WORDS_TOGETHER; ++k)
        {
            const uint split = merges->m_splits[merges->m_queue[min(next + k * DRAPE_WORDS_AT_ONCE, last - 1u)]];
            left[k] = words[(2u * split + 1u) * DRAPE_NODE_WORDS];
            right[k] = words[(2u * split + 2u) * DRAPE_NODE_WORDS];
        }
        DRAPE_UNROLL
        for (uint k = 0; k < DRAPE_WORDS_TOGETHER; ++k)
        {
            const uint i = next + k * DRAPE_WORDS_AT_ONCE;
            if (i < last)
                words[merges->m_places[merges->m_queue[i]] * DRAPE_NODE_WORDS] =
                    word < DRAPE_DOP_DIRECTIONS ? drapeMin(left[k], right[k]) : drapeMax(left[k], right[k]);
        }
    }
}

// The whole group merges the pairs of count splits, those of m_splits, each when its children are complete. Splits of
// lower tiers are.
static void mergeInOrder(__global BvhNode* nodes, __global const uint* splits, __local Merges* merges, const uint count)
{
    const uint item = get_local_id(0);
    for (uint i = item; i < count; i += get_local_size(0))
    {
        merges->m_places[i] = splitPlace(splits[merges->m_splits[i]]);
        merges->m_waits[i] = 0;
    }
    if (item == 0) merges->m_queued = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = item; i < count; i += get_local_size(0))
    {
        // The first leaf behind the parent's split; 0: the root has none.
        const uint behind = (merges->m_places[i] + 1u) / 2u;
        uint parent = DRAPE_NO_PLACE;
        for (uint other = 0; other < count; ++other)
            if (merges->m_splits[other] + 1u == behind) parent = other;
        merges->m_parents[i] = (ushort)parent;
        if (parent != DRAPE_NO_PLACE) atomic_inc(merges->m_waits + parent);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = item; i < count; i += get_local_size(0))
        if (merges->m_waits[i] == 0) merges->m_queue[atomic_inc(&merges->m_queued)] = (ushort)i;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint merged = 0; merged < count;)
    {
        const uint queued = merges->m_queued;
        mergeQueued(nodes, merges, merged, queued);
        barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
        for (uint i = merged + item; i < queued; i += get_local_size(0))
        {
            const uint parent = merges->m_parents[merges->m_queue[i]];
            if (parent != DRAPE_NO_PLACE && atomic_dec(merges->m_waits + parent) == 1)
                merges->m_queue[atomic_inc(&merges->m_queued)] = (ushort)parent;
        }
        merged = queued;
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}

// Volumes never hold NaN, so a NaN low end marks a node that is not complete yet.
#define DRAPE_INCOMPLETE 0x7fc00000u
static int isComplete(__global const BvhNode* node)
{
    return as_uint(node->m_low[0]) != DRAPE_INCOMPLETE;
}

// Merges any number of splits, which are far or lie near a base.
static void mergeMarked(__global BvhNode* nodes, __global const uint* splits, const uint count, const uint base,
                        __local const ushort* near, __global const uint* far, __local uint* pending)
{
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        const uint split = far ? far[i] : base + near[i];
        nodes[splitPlace(splits[split])].m_low[0] = as_float(DRAPE_INCOMPLETE);
    }
    if (get_local_id(0) == 0) *pending = count;
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    while (*pending > 0)
    {
        // First all look, then all merge: a node that is being written may look complete before it is.
        for (uint first = 0; first < count; first += 32 * get_local_size(0))
        {
            uint ready = 0;
            for (uint k = 0; k < 32; ++k)
            {
                const uint i = first + k * get_local_size(0) + get_local_id(0);
                if (i >= count) break;
                const uint split = far ? far[i] : base + near[i];
                if (!isComplete(nodes + splitPlace(splits[split])) && isComplete(nodes + 2 * split + 1) &&
                    isComplete(nodes + 2 * split + 2))
                {
                    ready |= 1u << k;
                }
            }
            barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
            if (ready != 0) atomic_sub(pending, popcount(ready));
            for (; ready != 0; ready &= ready - 1)
            {
                const uint i = first + (31 - clz(ready & -ready)) * get_local_size(0) + get_local_id(0);
                const uint split = far ? far[i] : base + near[i];
                mergePair(nodes, split, splitPlace(splits[split]));
            }
            barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
        }
    }
}

// A group's splits: one tree over so many leaves may have more of this tier than it merges in order.
typedef union GroveSplits
{
    Merges m_merges;
    ushort m_found[2 * DRAPE_GROVE_LEAVES];
} GroveSplits;

// A work-group is a window of leaves; it refits the groves that begin in it.
__kernel __attribute__((reqd_work_group_size(DRAPE_GROVE_GROUP, 1, 1))) void refitGrovesGroups(
    __global BvhNode* nodes, __global const uint* splits, const uint leafCount)
{
    __local GroveSplits group;
    __local uint foundCount, pending;
    __local uint stretch[2];
    const uint window = get_group_id(0) * DRAPE_GROVE_LEAVES;
    if (get_local_id(0) == 0) foundCount = 0;
    stretchOfWindow(splits, window, DRAPE_GROVE_LEAVES, DRAPE_GROVE_LEAVES, leafCount, 1u, stretch);
    const uint first = stretch[0];
    const uint end = stretch[1];
    if (first >= window + DRAPE_GROVE_LEAVES) return;
    for (uint leaf = first + get_local_id(0); leaf + 1 < end; leaf += get_local_size(0))
    {
        if (splitTier(splits[leaf]) != 1u) continue;
        const uint i = atomic_inc(&foundCount);
        if (i < DRAPE_MERGED) group.m_merges.m_splits[i] = leaf;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint count = foundCount;
    if (count <= DRAPE_MERGED)
    {
        mergeInOrder(nodes, splits, &group.m_merges, count);
        return;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint leaf = first + get_local_id(0); leaf + 1 < end; leaf += get_local_size(0))
        if (splitTier(splits[leaf]) == 1u) group.m_found[atomic_dec(&foundCount) - 1u] = (ushort)(leaf - first);
    barrier(CLK_LOCAL_MEM_FENCE);
    mergeMarked(nodes, splits, count, first, group.m_found, 0, &pending);
}

// One work-group refits what spans groves.
__kernel __attribute__((reqd_work_group_size(DRAPE_GROVE_GROUP, 1, 1))) void refitTopsGroup(__global BvhNode* nodes,
                                                                                            __global const uint* splits,
                                                                                            __global const uint* tops)
{
    __local Merges merges;
    __local uint pending;
    const uint count = tops[0];
    if (count > DRAPE_MERGED)
    {
        mergeMarked(nodes, splits, count, 0, 0, tops + 1, &pending);
        return;
    }
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
        merges.m_splits[i] = tops[1 + i];
    barrier(CLK_LOCAL_MEM_FENCE);
    mergeInOrder(nodes, splits, &merges, count);
}

// The list of splits that span groves, in order. A work-group is a window of leaves; the first kernel counts.
__kernel __attribute__((reqd_work_group_size(DRAPE_GROVE_GROUP, 1, 1))) void treeCountTops(
    __global const uint* restrict splits, const uint leafCount, __global uint* restrict counts)
{
    __local uint sum;
    const uint window = get_group_id(0) * DRAPE_GROVE_LEAVES;
    if (get_local_id(0) == 0) sum = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint end = min(leafCount - 1, window + DRAPE_GROVE_LEAVES);
    for (uint leaf = window + get_local_id(0); leaf < end; leaf += DRAPE_GROVE_GROUP)
    {
        if (splitTier(splits[leaf]) == 2u) atomic_inc(&sum);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (get_local_id(0) == 0) counts[get_group_id(0)] = sum;
}

// One work-item lists the splits of its window behind those of the windows before.
__kernel void treeListTopsSerial(__global const uint* restrict splits, const uint leafCount,
                                 __global const uint* restrict counts, const uint windows, __global uint* restrict tops)
{
    const uint item = get_global_id(0);
    if (item >= windows) return;
    uint place = 1;
    for (uint i = 0; i < item; ++i)
        place += counts[i];
    if (item + 1 == windows) tops[0] = place - 1 + counts[item];
    if (counts[item] == 0) return;
    const uint end = min(leafCount - 1, (item + 1) * DRAPE_GROVE_LEAVES);
    for (uint leaf = item * DRAPE_GROVE_LEAVES; leaf < end; ++leaf)
    {
        if (splitTier(splits[leaf]) == 2u) tops[place++] = leaf;
    }
}

// Lists the tops in any order, which refitTopsGroup does not mind. A work-item is a split. tops[0] must be zero before.
__kernel void treeListTopsGroups(__global const uint* restrict splits, const uint leafCount,
                                 __global volatile uint* tops)
{
    const uint split = get_global_id(0);
    if (split + 1 < leafCount && splitTier(splits[split]) == 2u) tops[1 + atomic_inc(tops)] = split;
}

// The thesis's refit, a launch per height: a work-item is a leaf …
__kernel void refitTreeLeaves(__global BvhNode* restrict nodes, __global const uint* restrict order,
                              __global const Triangle* restrict triangles, __global const float* restrict start,
                              __global const float* restrict end, __global const float* restrict meshRadius,
                              __global StepCounters* restrict counters, const uint leafCount)
{
    const uint leaf = get_global_id(0);
    if (leaf >= leafCount) return;
    __global const Triangle* triangle = triangles + order[leaf];
    Dop dop;
    const uint invalid = leafVolume(&dop, triangle, start, end, meshRadius[triangle->m_mesh]);
    if (invalid > 0) atomic_add(&counters->m_invalidNodes, invalid);
    dopStore(nodes + leafPlace(nodes, leaf, leafCount), &dop);
}

// … and then one of the count splits of a height, listed from `first`.
__kernel void refitTreeLevel(__global BvhNode* restrict nodes, __global const uint* restrict splits,
                             __global const uint* restrict heights, const uint first, const uint count)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    const uint split = heights[first + i];
    mergePair(nodes, split, splitPlace(splits[split]));
}
