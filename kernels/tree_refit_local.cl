// The upper heights of a refit in local memory: volumes that come from below are read once, all at the same time, and the
// heights above them wait for barriers only, not for global memory. In place of refitGrovesGroups and refitTopsGroup.
#include "lib/tree_refit.h"
#include "lib/tree_stretch.h"

#define DRAPE_LOCAL_GROUP 256
// Splits that a group merges in local memory: as many as fit into the 32 KiB that every device has.
#ifndef DRAPE_LOCAL_SPLITS
#define DRAPE_LOCAL_SPLITS 352u
#endif
// Rows of words, of an odd length, so that neither a row nor a column falls on one bank.
#define DRAPE_LOCAL_ROW (DRAPE_LOCAL_SPLITS + 1u)
#define DRAPE_DOP_WORDS (2 * DRAPE_DOP_DIRECTIONS)
#define DRAPE_NO_CHILD 0xffffu

typedef struct LocalMerge
{
    __local float* m_volumes;
    __local uint* m_splits;    // rising
    __local ushort* m_left;    // index of the child's split, or DRAPE_NO_CHILD where the child is complete
    __local ushort* m_right;
    __local uchar* m_done;
    __local uint* m_pending;
    uint m_count;
} LocalMerge;

// Index of a split in the list; its length where it is not there.
static uint indexOfSplit(const LocalMerge* merge, const uint split)
{
    uint first = 0, count = merge->m_count;
    while (count > 0)
    {
        const uint half_ = count / 2;
        const int below = merge->m_splits[first + half_] < split;
        first = below ? first + half_ + 1 : first;
        count = below ? count - half_ - 1 : half_;
    }
    return first < merge->m_count && merge->m_splits[first] == split ? first : merge->m_count;
}

// Tells the parent's split, where it is of the list, of a child in the list. A left child lies at an odd place.
static void tellParent(const LocalMerge* merge, const uint index, const uint place)
{
    if (place == 0) return;
    const uint parent = indexOfSplit(merge, (place - 1) / 2);
    if (parent == merge->m_count) return;
    (place % 2 == 1 ? merge->m_left : merge->m_right)[parent] = (ushort)index;
}

// The hull of the children that are complete.
static void takeComplete(const LocalMerge* merge, __global const BvhNode* nodes, const uint index)
{
    __global const BvhNode* left = nodes + 2 * merge->m_splits[index] + 1;
    const int useLeft = merge->m_left[index] == DRAPE_NO_CHILD, useRight = merge->m_right[index] == DRAPE_NO_CHILD;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        const float low = useLeft ? left[0].m_low[i] : DRAPE_INFINITY, high = useLeft ? left[0].m_high[i] : -DRAPE_INFINITY;
        merge->m_volumes[i * DRAPE_LOCAL_ROW + index] = useRight ? drapeMin(low, left[1].m_low[i]) : low;
        merge->m_volumes[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_LOCAL_ROW + index] =
            useRight ? drapeMax(high, left[1].m_high[i]) : high;
    }
}

static void growBy(const LocalMerge* merge, const uint index, const uint child)
{
    if (child == DRAPE_NO_CHILD) return;
    for (int i = 0; i < DRAPE_DOP_WORDS; ++i)
    {
        __local float* row = merge->m_volumes + i * DRAPE_LOCAL_ROW;
        row[index] = i < DRAPE_DOP_DIRECTIONS ? drapeMin(row[index], row[child]) : drapeMax(row[index], row[child]);
    }
}

static int isDone(const LocalMerge* merge, const uint child) { return child == DRAPE_NO_CHILD || merge->m_done[child]; }

// The whole group merges the listed splits' pairs; what lies below them is complete. The list is in place.
static void mergeLocally(__global BvhNode* nodes, __global const uint* splits, const LocalMerge* merge)
{
    const uint id = get_local_id(0), size = get_local_size(0);
    for (uint i = id; i < merge->m_count; i += size)
    {
        merge->m_left[i] = merge->m_right[i] = DRAPE_NO_CHILD;
        merge->m_done[i] = 0;
    }
    if (id == 0) *merge->m_pending = merge->m_count;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = id; i < merge->m_count; i += size) tellParent(merge, i, splitPlace(splits[merge->m_splits[i]]));
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = id; i < merge->m_count; i += size) takeComplete(merge, nodes, i);
    barrier(CLK_LOCAL_MEM_FENCE);
    while (*merge->m_pending > 0)
    {
        // At most two splits a work-item: bit k is its k-th. First all look, then all say that they are done.
        uint ready = 0;
        for (uint i = id, k = 0; i < merge->m_count; i += size, ++k)
        {
            if (merge->m_done[i] || !isDone(merge, merge->m_left[i]) || !isDone(merge, merge->m_right[i])) continue;
            growBy(merge, i, merge->m_left[i]);
            growBy(merge, i, merge->m_right[i]);
            ready |= 1u << k;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint i = id, k = 0; i < merge->m_count; i += size, ++k)
        {
            if (ready & (1u << k)) merge->m_done[i] = 1;
        }
        if (ready != 0) atomic_sub(merge->m_pending, popcount(ready));
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    // Word by word: neighbouring work-items write neighbouring words.
    for (uint i = id; i < merge->m_count * DRAPE_DOP_WORDS; i += size)
    {
        const uint index = i / DRAPE_DOP_WORDS, word = i % DRAPE_DOP_WORDS;
        __global float* words = (__global float*)(nodes + splitPlace(splits[merge->m_splits[index]]));
        words[word] = merge->m_volumes[word * DRAPE_LOCAL_ROW + index];
    }
}

// One work-item merges every split of the tier in a stretch, or in all leaves: for shapes with more than fit.
static void mergeSerially(__global BvhNode* nodes, __global const uint* splits, const uint first, const uint end,
                          const uint leafCount, const uint tier)
{
    if (get_local_id(0) == 0) refitStretch(nodes, splits, first, end, leafCount, tier);
}

// Lists the tier's splits among leaves first … end - 1, rising. found gets their number; more than fit are counted only.
static void listSplits(__global const uint* restrict splits, const uint first, const uint end, const uint tier,
                       __local uint* unsorted, __local uint* sorted, __local uint* found)
{
    const uint size = get_local_size(0);
    for (uint leaf = first + get_local_id(0); leaf + 1 < end; leaf += DRAPE_STRETCH_BATCH * size)
    {
        uint mine = 0;
        for (uint k = 0; k < DRAPE_STRETCH_BATCH; ++k)
        {
            if (leaf + k * size + 1 < end) mine |= (uint)(splitTier(splits[leaf + k * size]) == tier) << k;
        }
        for (; mine != 0; mine &= mine - 1)
        {
            const uint place = atomic_inc(found);
            if (place < DRAPE_LOCAL_SPLITS) unsorted[place] = leaf + (31 - clz(mine & -mine)) * size;
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint count = *found;
    for (uint i = get_local_id(0); count <= DRAPE_LOCAL_SPLITS && i < count; i += size)
    {
        uint rank = 0;
        for (uint k = 0; k < count; ++k) rank += unsorted[k] < unsorted[i];
        sorted[rank] = unsorted[i];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// A work-group is a window of leaves; it refits the groves that begin in it.
__kernel __attribute__((reqd_work_group_size(DRAPE_LOCAL_GROUP, 1, 1))) void refitGrovesLocal(
    __global BvhNode* nodes, __global const uint* splits, const uint leafCount)
{
    __local float volumes[DRAPE_DOP_WORDS * DRAPE_LOCAL_ROW];
    __local uint listed[DRAPE_LOCAL_SPLITS];
    __local ushort left[DRAPE_LOCAL_SPLITS], right[DRAPE_LOCAL_SPLITS];
    __local uchar done[DRAPE_LOCAL_SPLITS];
    __local uint stretch[2];
    __local uint found, pending;
    const uint window = get_group_id(0) * DRAPE_GROVE_LEAVES;
    if (get_local_id(0) == 0) found = 0;
    stretchOfWindow(splits, window, DRAPE_GROVE_LEAVES, leafCount, 1u, stretch);
    const uint first = stretch[0], end = stretch[1];
    if (first >= window + DRAPE_GROVE_LEAVES) return;
    // The unsorted list lies where volumes will.
    listSplits(splits, first, end, 1u, (__local uint*)volumes, listed, &found);
    const LocalMerge merge = {volumes, listed, left, right, done, &pending, found};
    if (found <= DRAPE_LOCAL_SPLITS)
        mergeLocally(nodes, splits, &merge);
    else
        mergeSerially(nodes, splits, first, end, leafCount, 1u);
}

// One work-group refits what spans groves. tops holds how many splits there are and then the splits, rising.
__kernel __attribute__((reqd_work_group_size(DRAPE_LOCAL_GROUP, 1, 1))) void refitTopsLocal(
    __global BvhNode* nodes, __global const uint* splits, __global const uint* tops, const uint leafCount)
{
    __local float volumes[DRAPE_DOP_WORDS * DRAPE_LOCAL_ROW];
    __local uint listed[DRAPE_LOCAL_SPLITS];
    __local ushort left[DRAPE_LOCAL_SPLITS], right[DRAPE_LOCAL_SPLITS];
    __local uchar done[DRAPE_LOCAL_SPLITS];
    __local uint pending;
    const uint count = tops[0];
    const LocalMerge merge = {volumes, listed, left, right, done, &pending, count};
    for (uint i = get_local_id(0); i < min(count, DRAPE_LOCAL_SPLITS); i += get_local_size(0)) listed[i] = tops[1 + i];
    barrier(CLK_LOCAL_MEM_FENCE);
    if (count <= DRAPE_LOCAL_SPLITS)
        mergeLocally(nodes, splits, &merge);
    else
        mergeSerially(nodes, splits, 0, leafCount, leafCount, 2u);
}
