// Refit of a hierarchy in two or three launches: whole subtrees first, then groves of subtrees, then what spans groves.
// Each launch reads what the one before wrote; nothing is passed between work-groups inside a launch.
#include "lib/tree_refit.h"

// As DRAPE_SUBTREE_LEAVES: a stretch of whole subtrees that begin in a window has fewer than two windows of leaves.
#define DRAPE_SUBTREE_GROUP 128
#define DRAPE_GROVE_GROUP 256

// A work-item is a window of leaves; it refits, one after the other, the subtrees that begin in it.
__kernel void refitSubtreesSerial(__global BvhNode* restrict nodes, __global const uint* restrict splits,
                                  __global const uint* restrict order, __global const Triangle* restrict triangles,
                                  __global const float* restrict start, __global const float* restrict end,
                                  __global const float* restrict meshRadius, __global StepCounters* restrict counters,
                                  const uint leafCount)
{
    const uint window = get_global_id(0) * DRAPE_SUBTREE_LEAVES;
    if (window >= leafCount) return;
    const uint first = nextBegin(splits, window, leafCount, 0u);
    if (first >= window + DRAPE_SUBTREE_LEAVES) return;
    const uint last = nextBegin(splits, window + DRAPE_SUBTREE_LEAVES, leafCount, 0u);
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

// One work-item refits what spans groves. tops holds how many splits there are and then the splits, in order.
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

// The first begins of a tier at or after `from` and at or after `from + window`. Every work-item of the group calls it.
static void stretchOfWindow(__global const uint* restrict splits, const uint from, const uint window, const uint leafCount,
                            const uint tier, __local uint* stretch)
{
    if (get_local_id(0) < 2) stretch[get_local_id(0)] = leafCount;
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint limit = min(leafCount, from + 2 * window);
    for (uint leaf = from + get_local_id(0); leaf < limit; leaf += get_local_size(0))
    {
        if (!beginsTier(splits, leaf, tier)) continue;
        atomic_min(stretch + 0, leaf);
        if (leaf >= from + window) atomic_min(stretch + 1, leaf);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// A group's volumes while they are made: leaves first, then the nodes by their split. A row holds one word of a node; its
// length is odd, so that neither a row nor a column of it falls on one bank.
#define DRAPE_SUBTREE_PLACES (2 * DRAPE_SUBTREE_GROUP)
#define DRAPE_SUBTREE_ROW (DRAPE_SUBTREE_PLACES + 1)
#define DRAPE_DOP_WORDS (2 * DRAPE_DOP_DIRECTIONS)
#define DRAPE_NODE_WORDS (DRAPE_DOP_WORDS + 2)
#define DRAPE_NO_PLACE 0xffffu

static uint localIndex(__global const BvhNode* node, const uint first)
{
    return node->m_count == 0u ? node->m_first - first : DRAPE_SUBTREE_GROUP + splitOfPair(node->m_first) - first;
}

static void keepVolume(__local float* volumes, const uint index, const Dop* dop)
{
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        volumes[i * DRAPE_SUBTREE_ROW + index] = dop->m_low[i];
        volumes[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_SUBTREE_ROW + index] = dop->m_high[i];
    }
}

static void mergeVolumes(__local float* volumes, const uint index, const uint left, const uint right)
{
    for (int i = 0; i < DRAPE_DOP_WORDS; ++i)
    {
        __local float* row = volumes + i * DRAPE_SUBTREE_ROW;
        row[index] = i < DRAPE_DOP_DIRECTIONS ? drapeMin(row[left], row[right]) : drapeMax(row[left], row[right]);
    }
}

// Writes volumes word by word, so that neighbouring work-items write neighbouring words: the nodes of a stretch of leaves lie
// side by side. indexOfPlace: of the places from `base` on.
static void storeStretch(__global BvhNode* nodes, const uint base, const uint places, __local const float* volumes,
                         __local const ushort* indexOfPlace)
{
    __global float* words = (__global float*)(nodes + base);
    for (uint i = get_local_id(0); i < places * DRAPE_NODE_WORDS; i += get_local_size(0))
    {
        const uint index = indexOfPlace[i / DRAPE_NODE_WORDS], word = i % DRAPE_NODE_WORDS;
        if (index != DRAPE_NO_PLACE && word < DRAPE_DOP_WORDS) words[i] = volumes[word * DRAPE_SUBTREE_ROW + index];
    }
}

// A work-group is a window of leaves; it refits the subtrees that begin in it. A work-item has one leaf and the split behind
// it, and merges when both children are there. Volumes stay in local memory until all are there; they are minima and
// maxima, so the order of merging does not show.
__kernel __attribute__((reqd_work_group_size(DRAPE_SUBTREE_GROUP, 1, 1))) void refitSubtreesGroups(
    __global BvhNode* restrict nodes, __global const uint* restrict splits, __global const uint* restrict order,
    __global const Triangle* restrict triangles, __global const float* restrict start, __global const float* restrict end,
    __global const float* restrict meshRadius, __global StepCounters* restrict counters, const uint leafCount)
{
    __local float volumes[DRAPE_DOP_WORDS * DRAPE_SUBTREE_ROW];
    __local ushort indexOfPlace[DRAPE_SUBTREE_PLACES];
    __local uchar done[DRAPE_SUBTREE_PLACES];
    __local uint stretch[2];
    __local uint pending;
    const uint item = get_local_id(0), window = get_group_id(0) * DRAPE_SUBTREE_LEAVES;
    if (item == 0) pending = 0;
    stretchOfWindow(splits, window, DRAPE_SUBTREE_LEAVES, leafCount, 0u, stretch);
    const uint first = stretch[0], count = stretch[1] - first;
    if (first >= window + DRAPE_SUBTREE_LEAVES || count == 0) return;

    const uint leaf = first + item;
    int waits = 0;
    uint left = 0, right = 0;
    done[item] = 1;
    done[DRAPE_SUBTREE_GROUP + item] = 0;
    indexOfPlace[item] = indexOfPlace[DRAPE_SUBTREE_GROUP + item] = DRAPE_NO_PLACE;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < count)
    {
        __global const Triangle* triangle = triangles + order[leaf];
        Dop dop;
        const uint invalid = leafVolume(&dop, triangle, start, end, meshRadius[triangle->m_mesh]);
        if (invalid > 0) atomic_add(&counters->m_invalidNodes, invalid);
        keepVolume(volumes, item, &dop);
        indexOfPlace[leafPlace(nodes, leaf, leafCount) - 2 * first] = (ushort)item;
        const uint word = item + 1 < count ? splits[leaf] : 0u;
        if (item + 1 < count && splitTier(word) == 0u)
        {
            waits = 1;
            left = localIndex(nodes + 2 * leaf + 1, first);
            right = localIndex(nodes + 2 * leaf + 2, first);
            indexOfPlace[splitPlace(word) - 2 * first] = (ushort)(DRAPE_SUBTREE_GROUP + item);
            atomic_inc(&pending);
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    while (pending > 0)
    {
        const int ready = waits && done[left] && done[right];
        if (ready)
        {
            mergeVolumes(volumes, DRAPE_SUBTREE_GROUP + item, left, right);
            waits = 0;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        if (ready)
        {
            done[DRAPE_SUBTREE_GROUP + item] = 1;
            atomic_dec(&pending);
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    storeStretch(nodes, 2 * first, 2 * count, volumes, indexOfPlace);
}

// Volumes never hold NaN, so a NaN low end marks a node that is not complete yet.
#define DRAPE_INCOMPLETE 0x7fc00000u
static int isComplete(__global const BvhNode* node) { return as_uint(node->m_low[0]) != DRAPE_INCOMPLETE; }

// The whole group merges the given splits' pairs, each when its children are complete. Splits of lower tiers are.
static void mergeSplits(__global BvhNode* nodes, __global const uint* splits, const uint count, const uint base,
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

// A work-group is a window of leaves; it refits the groves that begin in it.
__kernel __attribute__((reqd_work_group_size(DRAPE_GROVE_GROUP, 1, 1))) void refitGrovesGroups(
    __global BvhNode* nodes, __global const uint* splits, const uint leafCount)
{
    __local ushort found[2 * DRAPE_GROVE_LEAVES];
    __local uint foundCount, pending;
    __local uint stretch[2];
    const uint window = get_group_id(0) * DRAPE_GROVE_LEAVES;
    if (get_local_id(0) == 0) foundCount = 0;
    stretchOfWindow(splits, window, DRAPE_GROVE_LEAVES, leafCount, 1u, stretch);
    const uint first = stretch[0];
    const uint end = stretch[1];
    if (first >= window + DRAPE_GROVE_LEAVES) return;
    for (uint leaf = first + get_local_id(0); leaf + 1 < end; leaf += get_local_size(0))
    {
        if (splitTier(splits[leaf]) == 1u) found[atomic_inc(&foundCount)] = (ushort)(leaf - first);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    mergeSplits(nodes, splits, foundCount, first, found, 0, &pending);
}

// One work-group refits what spans groves.
__kernel __attribute__((reqd_work_group_size(DRAPE_GROVE_GROUP, 1, 1))) void refitTopsGroup(
    __global BvhNode* nodes, __global const uint* splits, __global const uint* tops)
{
    __local uint pending;
    mergeSplits(nodes, splits, tops[0], 0, 0, tops + 1, &pending);
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
__kernel void treeListTops(__global const uint* restrict splits, const uint leafCount,
                           __global const uint* restrict counts, const uint windows, __global uint* restrict tops)
{
    const uint item = get_global_id(0);
    if (item >= windows) return;
    uint place = 1;
    for (uint i = 0; i < item; ++i) place += counts[i];
    if (item + 1 == windows) tops[0] = place - 1 + counts[item];
    if (counts[item] == 0) return;
    const uint end = min(leafCount - 1, (item + 1) * DRAPE_GROVE_LEAVES);
    for (uint leaf = item * DRAPE_GROVE_LEAVES; leaf < end; ++leaf)
    {
        if (splitTier(splits[leaf]) == 2u) tops[place++] = leaf;
    }
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
