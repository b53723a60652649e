// Construction from the root down, a level at a time: the root, a work-group or a work-item per node, and the
// compaction of the queue. Large nodes are in top_down_large.cl. See lib/top_down.h for how a node is split.
#include "lib/group_reduce.h"
#include "../../kernels/lib/work_items/group_scan.h"
#include "lib/top_down.h"
#include "top_down_bindings.h"

// A work-item is a triangle: its centroid, its volume, and its place in the order before anything moves.
__kernel void topDownSummaries(__global const Triangle* restrict triangles, __global const float* restrict positions,
                               const uint triangleCount, __global Vec3* restrict centroids,
                               __global Dop* restrict volumes, __global uint* restrict order)
{
    const uint i = get_global_id(0);
    if (i >= triangleCount) return;
    Dop dop;
    leafVolume(&dop, triangles + i, positions, positions, 0.0f);
    volumes[i] = dop;
    centroids[i] = triangleCentroid(triangles + i, positions);
    order[i] = i;
}

// One work-group gives the root its volume, the hull of volumeCount volumes, and opens it.
__kernel void topDownRoot(__global BvhNode* restrict nodes, __global const Dop* restrict volumes,
                          const uint volumeCount, const uint triangleCount, __global OpenNode* restrict queue,
                          __local float* scratch)
{
    Dop dop;
    dopClear(&dop);
    for (uint i = get_local_id(0); i < volumeCount; i += get_local_size(0))
        dopAddDop(&dop, volumes + i);
    groupHull(scratch, &dop);
    if (get_local_id(0) > 0) return;
    dopStore(nodes, &dop);
    if (triangleCount == 1) treeSetLeaf(nodes, 0, 0);
    queue->m_place = 0;
    queue->m_first = 0;
    queue->m_end = triangleCount == 1 ? 0 : triangleCount;
}

// Computes pivotOfNode() with a work-group: one round for the mean, one a bit for the median.
static uint groupPivot(const TriangleSummary* summary, __global const uint* order, const OpenNode* node,
                       const SplitAxis* axis, const SplitRule* rule, __local ulong* sums)
{
    const uint size = node->m_end - node->m_first;
    uint bit = DRAPE_CENTROID_CELLS / 2;
    uint pivot = 0;
    uint belowPivot = 0;
    ulong sum;
    do  // at least once, see groupPrefix()
    {
        sum = 0;
        for (uint i = node->m_first + get_local_id(0); i < node->m_end; i += get_local_size(0))
        {
            const uint cell = centroidCell(axis, summary->m_centroids[order[i]]);
            sum += !rule->m_median ? cell : cell < pivot + bit ? 1 : 0;
        }
        sum = groupSum(sums, sum);
        if (rule->m_median && keepsMedianBit((uint)sum, size))
        {
            pivot += bit;
            belowPivot = (uint)sum;
        }
        bit /= 2;
    } while (rule->m_median && bit > 0);
    if (halvesBlindly(rule, size)) return 0;
    return rule->m_median ? medianPivot(pivot, belowPivot) : pivotOfSum(sum, size);
}

// Does the work of splitSerial() with a work-group. scan holds a uint per work-item.
static void groupSplit(__global BvhNode* nodes, __global uint* splits, __global uint* order, __global uint* other,
                       const TriangleSummary* summary, const SplitRule* rule, const OpenNode* node,
                       __global OpenNode* children, __local ulong* sums, __local uint* scan, __local float* hulls)
{
    const uint id = get_local_id(0);
    const uint group = get_local_size(0);
    const uint size = node->m_end - node->m_first;
    const SplitAxis axis = splitAxisOf(nodes + node->m_place);
    const uint pivot = groupPivot(summary, order, node, &axis, rule, sums);
    uint below = 0;
    uint block = 0;
    do
    {
        const uint index = block + id;
        const uint triangle = index < size ? order[node->m_first + index] : 0;
        const int isLeft = index < size && centroidCell(&axis, summary->m_centroids[triangle]) < pivot;
        uint total;
        const uint before = groupPrefix(scan, isLeft ? 1 : 0, &total);
        if (index < size) other[partedPlace(node, index, below + before, isLeft)] = triangle;
        below += total;
        block += group;
    } while (block < size);
    barrier(CLK_GLOBAL_MEM_FENCE);
    const uint taken = below != 0 && below != size ? size : 0;
    for (uint i = id; i < taken; i += group)
        order[node->m_first + i] = other[node->m_first + i];
    barrier(CLK_GLOBAL_MEM_FENCE);
    const uint left = leftSize(below, size);
    const uint middle = node->m_first + left;
    for (uint side = 0; side < 2; ++side)
    {
        const uint end = side == 0 ? middle : node->m_end;
        Dop dop;
        dopClear(&dop);
        for (uint i = (side == 0 ? node->m_first : middle) + id; i < end; i += group)
        {
            dopAddDop(&dop, summary->m_volumes + order[i]);
        }
        groupHull(hulls, &dop);
        if (id == 0) dopStore(nodes + 2 * (middle - 1) + 1 + side, &dop);
        barrier(CLK_GLOBAL_MEM_FENCE);
    }
    if (id == 0) splitOpenNode(nodes, splits, node, left, children);
    barrier(CLK_GLOBAL_MEM_FENCE);
}

// A work-group takes nodesPerGroup nodes of the queue. Its first work-item parts them: those of at most smallSize
// triangles go to one end of a list, the others to the other end; nodes of largeSize or more are another kernel's. The
// group splits the others one after the other, and then every work-item splits some of the small ones alone.
__kernel void topDownSplitGroups(DRAPE_TOP_DOWN_SPLIT_GROUPS)
{
    __local uint smallCount, otherCount;
    const TriangleSummary summary = {centroids, volumes};
    const SplitRule rule = values.m_rule;
    const uint nodesPerGroup = values.m_nodesPerGroup;
    __local uint* list = scratch + get_local_size(0);
    if (get_local_id(0) == 0)
    {
        smallCount = 0;
        otherCount = 0;
        const uint first = get_group_id(0) * nodesPerGroup;
        for (uint i = first; i < min(values.m_count, first + nodesPerGroup); ++i)
        {
            const uint size = queue[i].m_end - queue[i].m_first;
            if (size <= values.m_smallSize)
            {
                list[nodesPerGroup - 1 - smallCount++] = i;
            }
            else if (size < values.m_largeSize)
            {
                list[otherCount++] = i;
            }
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint k = 0; k < otherCount; ++k)
    {
        const OpenNode node = queue[list[k]];
        groupSplit(nodes, splits, order, other, &summary, &rule, &node, children + 2 * list[k], sums, scratch, hulls);
    }
    for (uint k = get_local_id(0); k < smallCount; k += get_local_size(0))
    {
        const uint i = list[nodesPerGroup - 1 - k];
        const OpenNode node = queue[i];
        splitSerial(nodes, splits, order, other, &summary, &rule, &node, children + 2 * i);
    }
}

// A work-item splits a node alone.
__kernel void topDownSplitItems(DRAPE_TOP_DOWN_SPLIT_ITEMS)
{
    const uint i = get_global_id(0);
    if (i >= values.m_count) return;
    const TriangleSummary summary = {centroids, volumes};
    const SplitRule rule = values.m_rule;
    const OpenNode node = queue[i];
    if (node.m_end - node.m_first >= values.m_largeSize) return;
    splitSerial(nodes, splits, order, other, &summary, &rule, &node, children + 2 * i);
}

static uint isOpen(__global const OpenNode* node)
{
    return node->m_end > node->m_first ? 1u : 0u;
}

// Counts for the host, which reads after a level how many nodes are open, and how many of them are small.
static void countOpen(__global uint* level, __global const OpenNode* node, const uint smallSize)
{
    if (node->m_end - node->m_first <= smallSize) atomic_inc(level + 1);
}

// Compaction of a small queue: one work-group moves its open nodes to the front, each work-item two of them. level[0]
// gets how many there are; level[1] must be zero before and counts the small ones.
__kernel void topDownCompactSmall(__global const OpenNode* restrict children, const uint count, const uint smallSize,
                                  __global OpenNode* restrict queue, __global uint* restrict level, __local uint* scan)
{
    const uint i = 2 * get_local_id(0);
    const uint first = i < count ? isOpen(children + i) : 0;
    const uint second = i + 1 < count ? isOpen(children + i + 1) : 0;
    uint total;
    const uint before = groupPrefix(scan, first + second, &total);
    if (first) queue[before] = children[i];
    if (second) queue[before + first] = children[i + 1];
    if (first) countOpen(level, children + i, smallSize);
    if (second) countOpen(level, children + i + 1, smallSize);
    if (get_local_id(0) == 0) level[0] = total;
}

// Compaction of a large queue. First every work-group scans a block …
__kernel void topDownCompactBlocks(__global const OpenNode* restrict children, const uint count,
                                   __global uint* restrict places, __global uint* restrict blockCounts,
                                   __local uint* scan)
{
    const uint i = get_global_id(0);
    uint total;
    const uint before = groupPrefix(scan, i < count ? isOpen(children + i) : 0, &total);
    if (i < count) places[i] = before;
    if (get_local_id(0) == 0) blockCounts[get_group_id(0)] = total;
}

// … then one work-group turns the blocks' counts into the sums before them …
__kernel void topDownCompactScan(__global uint* restrict blockCounts, const uint blocks, __global uint* restrict level,
                                 __local uint* scan)
{
    uint base = 0;
    for (uint first = 0; first < blocks; first += get_local_size(0))
    {
        const uint i = first + get_local_id(0);
        uint total;
        const uint before = groupPrefix(scan, i < blocks ? blockCounts[i] : 0, &total);
        if (i < blocks) blockCounts[i] = base + before;
        base += total;
    }
    if (get_local_id(0) == 0) level[0] = base;
}

// … and every work-group, of the same size, moves its block's open nodes.
__kernel void topDownCompactMove(__global const OpenNode* restrict children, const uint count, const uint smallSize,
                                 __global const uint* restrict places, __global const uint* restrict blockCounts,
                                 __global OpenNode* restrict queue, __global uint* restrict level)
{
    const uint i = get_global_id(0);
    if (i >= count || !isOpen(children + i)) return;
    queue[blockCounts[get_group_id(0)] + places[i]] = children[i];
    countOpen(level, children + i, smallSize);
}
