// Construction from the root down: nodes so large that many work-groups split one, in pairs of kernels. The first of a
// pair works on blocks of a node's triangles, the second puts the blocks' results together.
#include "lib/group_reduce.h"
#include "../../kernels/lib/work_items/group_scan.h"
#include "lib/top_down.h"

// A work-group's share of a large node: triangles m_first … m_end - 1 of the order, of the m_node-th large node, whose
// blocks begin with m_firstBlock.
typedef struct LargeBlock
{
    uint m_node;
    uint m_first;
    uint m_end;
    uint m_firstBlock;
} LargeBlock;

// A large node: where it is in the level's queue, and its blocks.
typedef struct LargeNode
{
    uint m_queued;
    uint m_firstBlock;
    uint m_blockCount;
} LargeNode;

// Sum of a block's centroids, in cells.
__kernel void largeSums(__global const BvhNode* restrict nodes, __global const uint* restrict order,
                        __global const Vec3* restrict centroids, __global const OpenNode* restrict queue,
                        __global const LargeNode* restrict large, __global const LargeBlock* restrict blocks,
                        __global ulong* restrict sums, __local ulong* scratch)
{
    const LargeBlock block = blocks[get_group_id(0)];
    const SplitAxis axis = splitAxisOf(nodes + queue[large[block.m_node].m_queued].m_place);
    ulong sum = 0;
    for (uint i = block.m_first + get_local_id(0); i < block.m_end; i += get_local_size(0))
    {
        sum += centroidCell(&axis, centroids[order[i]]);
    }
    sum = groupSum(scratch, sum);
    if (get_local_id(0) == 0) sums[get_group_id(0)] = sum;
}

// A work-group is a large node: its pivot.
__kernel void largePivots(__global const OpenNode* restrict queue, __global const LargeNode* restrict large,
                          __global const ulong* restrict sums, __global uint* restrict pivots, const uint depth,
                          const uint leafSize, __local ulong* scratch)
{
    const LargeNode node = large[get_group_id(0)];
    ulong sum = 0;
    for (uint i = get_local_id(0); i < node.m_blockCount; i += get_local_size(0))
        sum += sums[node.m_firstBlock + i];
    sum = groupSum(scratch, sum);
    if (get_local_id(0) > 0) return;
    const OpenNode open = queue[node.m_queued];
    const SplitRule rule = {depth, leafSize, 0};
    const uint size = open.m_end - open.m_first;
    pivots[get_group_id(0)] = halvesBlindly(&rule, size) ? 0 : pivotOfSum(sum, size);
}

// The median's pivot is found a digit a round, from a histogram of the cells that agree with it so far: 256 bins fit
// into any local memory.
#define DRAPE_MEDIAN_BITS 8
#define DRAPE_MEDIAN_BINS (1u << DRAPE_MEDIAN_BITS)

// Adds a block's cells to its node's histogram of the digit at `shift`, which must be zero before the round's first
// block. pivots: the digits above, and zeros. bins: one for each value of a digit.
__kernel void largeHistograms(__global const BvhNode* restrict nodes, __global const uint* restrict order,
                              __global const Vec3* restrict centroids, __global const OpenNode* restrict queue,
                              __global const LargeNode* restrict large, __global const LargeBlock* restrict blocks,
                              __global const uint* restrict pivots, const uint shift,
                              __global uint* restrict histograms, __local uint* bins)
{
    const LargeBlock block = blocks[get_group_id(0)];
    const SplitAxis axis = splitAxisOf(nodes + queue[large[block.m_node].m_queued].m_place);
    const uint above = pivots[block.m_node] >> (shift + DRAPE_MEDIAN_BITS);
    for (uint bin = get_local_id(0); bin < DRAPE_MEDIAN_BINS; bin += get_local_size(0))
        bins[bin] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = block.m_first + get_local_id(0); i < block.m_end; i += get_local_size(0))
    {
        const uint cell = centroidCell(&axis, centroids[order[i]]);
        if (cell >> (shift + DRAPE_MEDIAN_BITS) == above)
            atomic_inc(bins + ((cell >> shift) & (DRAPE_MEDIAN_BINS - 1)));
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint bin = get_local_id(0); bin < DRAPE_MEDIAN_BINS; bin += get_local_size(0))
    {
        if (bins[bin] > 0) atomic_add(histograms + block.m_node * DRAPE_MEDIAN_BINS + bin, bins[bin]);
    }
}

// A work-group of a power of two of work-items is a large node. It finds the digit at `shift` of the node's pivot: the
// largest with which no more than half of the cells are below, as pivotOfNode() finds it. After the last digit it has
// the pivot itself. below: number of cells below the pivot so far. Both must be zero before the first round. Leaves the
// histogram zero.
__kernel void largeMedianDigits(__global const OpenNode* restrict queue, __global const LargeNode* restrict large,
                                __global uint* restrict histograms, __global uint* restrict pivots,
                                __global uint* restrict below, const uint shift, const uint depth, const uint leafSize,
                                __local uint* scan)
{
    const uint number = get_group_id(0);
    const OpenNode open = queue[large[number].m_queued];
    const uint size = open.m_end - open.m_first;
    const uint each = DRAPE_MEDIAN_BINS / get_local_size(0);
    const uint first = get_local_id(0) * each;
    __global uint* histogram = histograms + number * DRAPE_MEDIAN_BINS;
    const uint belowDigits = below[number];
    barrier(CLK_GLOBAL_MEM_FENCE);  // one work-item writes it below
    uint sum = 0;
    for (uint bin = first; bin < first + each; ++bin)
        sum += histogram[bin];
    uint total;
    uint before = belowDigits + groupPrefix(scan, sum, &total);
    for (uint bin = first; bin < first + each; ++bin)
    {
        const uint behind = before + histogram[bin];
        histogram[bin] = 0;
        const int isLargest = bin + 1 == DRAPE_MEDIAN_BINS || !keepsMedianBit(behind, size);
        if (keepsMedianBit(before, size) && isLargest)
        {
            const SplitRule rule = {depth, leafSize, 1};
            const uint pivot = pivots[number] + (bin << shift);
            below[number] = before;
            pivots[number] = shift > 0 ? pivot : halvesBlindly(&rule, size) ? 0 : medianPivot(pivot, before);
        }
        before = behind;
    }
}

// Counts the triangles of a block that go left.
__kernel void largeCounts(__global const BvhNode* restrict nodes, __global const uint* restrict order,
                          __global const Vec3* restrict centroids, __global const OpenNode* restrict queue,
                          __global const LargeNode* restrict large, __global const LargeBlock* restrict blocks,
                          __global const uint* restrict pivots, __global uint* restrict counts, __local ulong* scratch)
{
    const LargeBlock block = blocks[get_group_id(0)];
    const SplitAxis axis = splitAxisOf(nodes + queue[large[block.m_node].m_queued].m_place);
    const uint pivot = pivots[block.m_node];
    ulong below = 0;
    for (uint i = block.m_first + get_local_id(0); i < block.m_end; i += get_local_size(0))
    {
        below += centroidCell(&axis, centroids[order[i]]) < pivot ? 1 : 0;
    }
    below = groupSum(scratch, below);
    if (get_local_id(0) == 0) counts[get_group_id(0)] = (uint)below;
}

// The sum of a node's counts up to a block; every work-item of the group gets it.
static uint countsBefore(__global const uint* counts, const uint first, const uint end, __local ulong* scratch)
{
    ulong sum = 0;
    for (uint i = first + get_local_id(0); i < end; i += get_local_size(0))
        sum += counts[i];
    return (uint)groupSum(scratch, sum);
}

// Moves a block's triangles to their side, in other.
__kernel void largeReorder(__global const BvhNode* restrict nodes, __global const uint* restrict order,
                           __global uint* restrict other, __global const Vec3* restrict centroids,
                           __global const OpenNode* restrict queue, __global const LargeNode* restrict large,
                           __global const LargeBlock* restrict blocks, __global const uint* restrict pivots,
                           __global const uint* restrict counts, __local ulong* scratch, __local uint* scan)
{
    const LargeBlock block = blocks[get_group_id(0)];
    const LargeNode node = large[block.m_node];
    const OpenNode open = queue[node.m_queued];
    const SplitAxis axis = splitAxisOf(nodes + open.m_place);
    const uint pivot = pivots[block.m_node];
    uint below = countsBefore(counts, node.m_firstBlock, get_group_id(0), scratch);
    const uint all = countsBefore(counts, node.m_firstBlock, node.m_firstBlock + node.m_blockCount, scratch);
    const int stays = all == 0 || all == open.m_end - open.m_first;
    for (uint first = block.m_first; first < block.m_end; first += get_local_size(0))
    {
        const uint i = first + get_local_id(0);
        const uint triangle = i < block.m_end ? order[i] : 0;
        const int isLeft = i < block.m_end && centroidCell(&axis, centroids[triangle]) < pivot;
        uint total;
        const uint before = groupPrefix(scan, isLeft ? 1 : 0, &total);
        if (i < block.m_end)
        {
            other[stays ? i : partedPlace(&open, i - open.m_first, below + before, isLeft)] = triangle;
        }
        below += total;
    }
}

// Takes a block of the new order over, and the hulls of its triangles on the left and on the right.
__kernel void largeVolumes(__global uint* restrict order, __global const uint* restrict other,
                           __global const Dop* restrict volumes, __global const OpenNode* restrict queue,
                           __global const LargeNode* restrict large, __global const LargeBlock* restrict blocks,
                           __global const uint* restrict counts, __global Dop* restrict hulls, __local ulong* scratch,
                           __local float* scratchHull)
{
    const LargeBlock block = blocks[get_group_id(0)];
    const LargeNode node = large[block.m_node];
    const OpenNode open = queue[node.m_queued];
    const uint all = countsBefore(counts, node.m_firstBlock, node.m_firstBlock + node.m_blockCount, scratch);
    const uint middle = open.m_first + leftSize(all, open.m_end - open.m_first);
    for (uint side = 0; side < 2; ++side)
    {
        const uint first = side == 0 ? block.m_first : max(block.m_first, middle);
        const uint end = side == 0 ? min(block.m_end, middle) : block.m_end;
        Dop dop;
        dopClear(&dop);
        for (uint i = first + get_local_id(0); i < end; i += get_local_size(0))
        {
            const uint triangle = other[i];
            order[i] = triangle;
            dopAddDop(&dop, volumes + triangle);
        }
        groupHull(scratchHull, &dop);
        if (get_local_id(0) == 0) hulls[2 * get_group_id(0) + side] = dop;
        barrier(CLK_GLOBAL_MEM_FENCE);
    }
}

// A work-group is a large node: links it, and merges its blocks' hulls to its children's volumes.
__kernel void largeLinks(__global BvhNode* restrict nodes, __global uint* restrict splits,
                         __global const OpenNode* restrict queue, __global const LargeNode* restrict large,
                         __global const uint* restrict counts, __global const Dop* restrict hulls,
                         __global OpenNode* restrict children, __local ulong* scratch, __local float* scratchHull)
{
    const LargeNode node = large[get_group_id(0)];
    const OpenNode open = queue[node.m_queued];
    const uint all = countsBefore(counts, node.m_firstBlock, node.m_firstBlock + node.m_blockCount, scratch);
    const uint left = leftSize(all, open.m_end - open.m_first);
    const uint pair = 2 * (open.m_first + left - 1) + 1;
    for (uint side = 0; side < 2; ++side)
    {
        Dop dop;
        dopClear(&dop);
        for (uint i = get_local_id(0); i < node.m_blockCount; i += get_local_size(0))
        {
            dopAddDop(&dop, hulls + 2 * (node.m_firstBlock + i) + side);
        }
        groupHull(scratchHull, &dop);
        if (get_local_id(0) == 0) dopStore(nodes + pair + side, &dop);
        barrier(CLK_GLOBAL_MEM_FENCE);
    }
    if (get_local_id(0) == 0) splitOpenNode(nodes, splits, &open, left, children + 2 * node.m_queued);
}

// The root's volume: hulls of blocks of all triangles …
__kernel void largeRootBlocks(__global const Dop* restrict volumes, const uint triangleCount, const uint blockSize,
                              __global Dop* restrict hulls, __local float* scratchHull)
{
    const uint first = get_group_id(0) * blockSize;
    const uint end = min(triangleCount, first + blockSize);
    Dop dop;
    dopClear(&dop);
    for (uint i = first + get_local_id(0); i < end; i += get_local_size(0))
        dopAddDop(&dop, volumes + i);
    groupHull(scratchHull, &dop);
    if (get_local_id(0) == 0) hulls[get_group_id(0)] = dop;
}
