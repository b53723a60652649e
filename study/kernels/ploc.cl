// Clustering of triangles in Morton order to a tree. Rounds are launched in batches without asking the device: rounds[2
// k] is how many clusters round k starts with, rounds[2 k + 1] how many were made before it.
#include "../../kernels/lib/work_items/group_scan.h"
#include "lib/ploc.h"
#include "ploc_bindings.h"

// A work-item is a leaf in Morton order.
__kernel void plocLeaves(__global const Triangle* restrict triangles, __global const float* restrict positions,
                         __global const uint* restrict mortonOrder, const uint leafCount, __global Box* restrict boxes,
                         __global uint* restrict numbers, __global uint* restrict sizes, __global uint* restrict rounds)
{
    const uint i = get_global_id(0);
    if (i >= leafCount) return;
    boxes[i] = boxOfTriangle(triangles + mortonOrder[i], positions);
    numbers[i] = i;
    sizes[i] = 1;
    if (i == 0)
    {
        rounds[0] = leafCount;
        rounds[1] = 0;
    }
}

// A work-item is a cluster.
__kernel void plocFindNearest(__global const Box* restrict boxes, __global const uint* restrict rounds,
                              const uint round, const uint radius, __global uint* restrict nearest)
{
    const uint i = get_global_id(0);
    const uint count = rounds[2 * round];
    if (i >= count || count < 2) return;
    nearest[i] = plocNearest(boxes, count, i, radius, plocIsForced(round, count));
}

static int merges(__global const uint* nearest, const uint count, const uint i)
{
    return count >= 2 && nearest[i] != i && nearest[nearest[i]] == i;
}

// Counts the clusters of a work-item's share that stay (the left of two that merge does), in the low half, and that
// merge, in the high.
static uint countShare(__global const uint* nearest, const uint count, const uint first, const uint end)
{
    uint kept = 0;
    uint merged = 0;
    for (uint i = first; i < end; ++i)
    {
        const int pair = merges(nearest, count, i);
        if (pair && nearest[i] < i) continue;
        ++kept;
        merged += pair ? 1u : 0u;
    }
    return kept | (merged << 16);
}

// A work-group counts its block; a work-item has `share` adjacent clusters. Blocks have fewer than 65,536.
__kernel void plocCount(__global const uint* restrict nearest, __global const uint* restrict rounds, const uint round,
                        const uint share, __global uint* restrict blockCounts, __local uint* scratch)
{
    const uint count = rounds[2 * round];
    const uint first = min(count, (uint)(get_global_id(0) * share));
    uint total;
    groupPrefix(scratch, countShare(nearest, count, first, min(count, first + share)), &total);
    if (get_local_id(0) == 0) blockCounts[get_group_id(0)] = total;
}

// Writes the next round's clusters: those that stay, in order, pairs merged. The work-group of the same block as above.
__kernel void plocMerge(DRAPE_PLOC_MERGE)
{
    const uint round = values.m_round, share = values.m_share, leafCount = values.m_leafCount;
    const uint count = rounds[2 * round];
    const uint made = rounds[2 * round + 1];
    uint kept = 0;
    uint merged = 0;
    for (uint i = get_local_id(0); i < get_group_id(0); i += get_local_size(0))
    {
        kept += blockCounts[i] & 0xffffu;
        merged += blockCounts[i] >> 16;
    }
    uint keptBefore, mergedBefore;
    groupPrefix(scratch, kept, &keptBefore);
    groupPrefix(scratch, merged, &mergedBefore);
    const uint first = min(count, (uint)(get_global_id(0) * share));
    const uint end = min(count, first + share);
    uint total;
    const uint before = groupPrefix(scratch, countShare(nearest, count, first, end), &total);
    uint place = keptBefore + (before & 0xffffu);
    uint cluster = made + mergedBefore + (before >> 16);
    for (uint i = first; i < end; ++i)
    {
        Box box = boxes[i];
        uint number = numbers[i];
        if (merges(nearest, count, i))
        {
            if (nearest[i] < i) continue;
            const Box other = boxes[nearest[i]];
            box = boxUnion(&box, &other);
            clusters[cluster].m_left = number;
            clusters[cluster].m_right = numbers[nearest[i]];
            sizes[leafCount + cluster] = sizes[number] + sizes[numbers[nearest[i]]];
            number = leafCount + cluster;
            ++cluster;
        }
        boxesOut[place] = box;
        numbersOut[place] = number;
        ++place;
    }
    if (get_group_id(0) + 1 == get_num_groups(0) && get_local_id(0) == 0)
    {
        rounds[2 * round + 2] = keptBefore + (total & 0xffffu);
        rounds[2 * round + 3] = made + mergedBefore + (total >> 16);
    }
}

// A work-item is a cluster of one round; the rounds go backwards, so that a cluster has its place before its children.
__kernel void plocPlace(__global BvhNode* restrict nodes, __global uint* restrict splits, __global uint* restrict order,
                        __global const uint* restrict mortonOrder, __global const Cluster* restrict clusters,
                        __global const uint* restrict sizes, __global ClusterPlace* restrict places,
                        const uint leafCount, const uint first, const uint count)
{
    const uint i = get_global_id(0);
    if (leafCount == 1 && i == 0)
    {
        treeSetLeaf(nodes, 0, 0);
        order[0] = mortonOrder[0];
    }
    if (i >= count) return;
    const uint cluster = first + i;
    if (cluster + 2 == leafCount)
    {
        places[cluster].m_place = 0;
        places[cluster].m_firstLeaf = 0;
    }
    plocLink(nodes, splits, order, mortonOrder, clusters, sizes, places, leafCount, cluster);
}
