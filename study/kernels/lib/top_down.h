// Construction from the root down: a node's triangles part at the mean or the median of their centroids along the
// volume's longest direction. Sums are of whole numbers, so they do not depend on who adds what, and every back end
// parts alike.
//
// A part goes to the left end of the node's range in order, and the rest to the right end in reverse order, as blocks
// come. Where the rule parts nothing off, or would build too high, the range is halved as it lies.
#ifndef DRAPE_LIB_TOP_DOWN_H
#define DRAPE_LIB_TOP_DOWN_H

#include "../../../kernels/lib/geometry/morton.h"
#include "tree_refit.h"
#include "../../../kernels/lib/geometry/triangle_order.h"

DRAPE_NAMESPACE_BEGIN

#ifdef __OPENCL_VERSION__
#define DRAPE_ULONG ulong
#else
#define DRAPE_ULONG std::uint64_t
#endif

// Cells along a node's longest direction: as many as a float tells apart.
#define DRAPE_CENTROID_CELLS (1u << 24)

// A node that is to be split: its place in the tree and its leaves m_first … m_end - 1. Empty: nothing to split.
typedef struct OpenNode
{
    DRAPE_UINT m_place;
    DRAPE_UINT m_first;
    DRAPE_UINT m_end;
} OpenNode;

// The rule that a level's splits follow.
typedef struct SplitRule
{
    DRAPE_UINT m_depth;     // links from the root
    DRAPE_UINT m_leafSize;  // nodes of at most so many triangles are halved
    DRAPE_UINT m_median;    // 1: at the median, 0: at the mean
} SplitRule;

// The interval along the direction in which a volume is longest, lengths compared per unit of direction.
typedef struct SplitAxis
{
    int m_direction;
    float m_low, m_high;
} SplitAxis;

DRAPE_FUNCTION SplitAxis splitAxisOf(const DRAPE_GLOBAL BvhNode* node)
{
    SplitAxis axis;
    float longest = -1.0f;
    axis.m_direction = 0;
    axis.m_low = 0.0f;
    axis.m_high = 0.0f;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        const float length = (node->m_high[i] - node->m_low[i]) / dopNorm(i);
        if (!(length > longest)) continue;
        longest = length;
        axis.m_direction = i;
        axis.m_low = node->m_low[i];
        axis.m_high = node->m_high[i];
    }
    return axis;
}

DRAPE_FUNCTION DRAPE_UINT centroidCell(const SplitAxis* axis, Vec3 centroid)
{
    return mortonCell(dopProject(centroid, axis->m_direction), axis->m_low, axis->m_high, DRAPE_CENTROID_CELLS);
}

DRAPE_FUNCTION int halvesBlindly(const SplitRule* rule, DRAPE_UINT size)
{
    return size <= rule->m_leafSize || rule->m_depth + ceilLog2(size) >= DRAPE_TREE_HEIGHT;
}

// Cells below the pivot go left. The mean of size cells is at least a cell exactly when the cell is below this.
DRAPE_FUNCTION DRAPE_UINT pivotOfSum(DRAPE_ULONG sum, DRAPE_UINT size)
{
    return (DRAPE_UINT)((sum + size - 1u) / size);
}

// Triangles on the left, given how many the pivot sends there.
DRAPE_FUNCTION DRAPE_UINT leftSize(DRAPE_UINT below, DRAPE_UINT size)
{
    return below == 0u || below == size ? (size + 1u) / 2u : below;
}

// Returns the new position of the index-th triangle of its node's range, with `before` left ones before it.
DRAPE_FUNCTION DRAPE_UINT partedPlace(const OpenNode* node, DRAPE_UINT index, DRAPE_UINT before, int isLeft)
{
    return isLeft ? node->m_first + before : node->m_end - 1u - (index - before);
}

// Links a node that sends `left` triangles to the left, and opens its children.
DRAPE_FUNCTION void splitOpenNode(DRAPE_GLOBAL BvhNode* nodes, DRAPE_GLOBAL DRAPE_UINT* splits, const OpenNode* node,
                                  DRAPE_UINT left, DRAPE_GLOBAL OpenNode* children)
{
    const DRAPE_UINT size = node->m_end - node->m_first;
    const DRAPE_UINT split = node->m_first + left - 1u;
    treeSetSplit(nodes, splits, node->m_place, size, split);
    for (DRAPE_UINT side = 0; side < 2u; ++side)
    {
        OpenNode child;
        child.m_place = 2u * split + 1u + side;
        child.m_first = side == 0u ? node->m_first : split + 1u;
        child.m_end = side == 0u ? split + 1u : node->m_end;
        if (child.m_end - child.m_first == 1u)
        {
            treeSetLeaf(nodes, child.m_place, child.m_first);
            child.m_end = child.m_first;
        }
        children[side] = child;
    }
}

DRAPE_FUNCTION void dopAddDop(Dop* dop, const DRAPE_GLOBAL Dop* other)
{
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        dop->m_low[i] = drapeMin(dop->m_low[i], other->m_low[i]);
        dop->m_high[i] = drapeMax(dop->m_high[i], other->m_high[i]);
    }
}

// Per triangle, once per build.
typedef struct TriangleSummary
{
    const DRAPE_GLOBAL Vec3* m_centroids;
    const DRAPE_GLOBAL Dop* m_volumes;
} TriangleSummary;

DRAPE_FUNCTION DRAPE_UINT countBelow(const TriangleSummary* summary, const DRAPE_GLOBAL DRAPE_UINT* order,
                                     const OpenNode* node, const SplitAxis* axis, DRAPE_UINT pivot)
{
    DRAPE_UINT below = 0;
    for (DRAPE_UINT i = node->m_first; i < node->m_end; ++i)
    {
        below += centroidCell(axis, summary->m_centroids[order[i]]) < pivot ? 1u : 0u;
    }
    return below;
}

// The median's pivot is found bit by bit; this says whether a bit stays when so many cells are below the pivot with it.
DRAPE_FUNCTION int keepsMedianBit(DRAPE_UINT below, DRAPE_UINT size)
{
    return below <= size / 2u;
}

// Parts the lowest cell from the rest if it contains more than half.
DRAPE_FUNCTION DRAPE_UINT medianPivot(DRAPE_UINT pivot, DRAPE_UINT below)
{
    return below == 0u ? pivot + 1u : pivot;
}

DRAPE_FUNCTION DRAPE_UINT pivotOfNode(const TriangleSummary* summary, const DRAPE_GLOBAL DRAPE_UINT* order,
                                      const OpenNode* node, const SplitAxis* axis, const SplitRule* rule)
{
    const DRAPE_UINT size = node->m_end - node->m_first;
    if (halvesBlindly(rule, size)) return 0u;
    if (!rule->m_median)
    {
        DRAPE_ULONG sum = 0;
        for (DRAPE_UINT i = node->m_first; i < node->m_end; ++i)
        {
            sum += centroidCell(axis, summary->m_centroids[order[i]]);
        }
        return pivotOfSum(sum, size);
    }
    DRAPE_UINT pivot = 0;
    DRAPE_UINT belowPivot = 0;
    for (DRAPE_UINT bit = DRAPE_CENTROID_CELLS / 2u; bit > 0u; bit /= 2u)
    {
        const DRAPE_UINT below = countBelow(summary, order, node, axis, pivot + bit);
        if (!keepsMedianBit(below, size)) continue;
        pivot += bit;
        belowPivot = below;
    }
    return medianPivot(pivot, belowPivot);
}

// Splits one node alone: reorders its range (other has room for it), links it, gives its children volumes and opens
// them.
DRAPE_FUNCTION void splitSerial(DRAPE_GLOBAL BvhNode* nodes, DRAPE_GLOBAL DRAPE_UINT* splits,
                                DRAPE_GLOBAL DRAPE_UINT* order, DRAPE_GLOBAL DRAPE_UINT* other,
                                const TriangleSummary* summary, const SplitRule* rule, const OpenNode* node,
                                DRAPE_GLOBAL OpenNode* children)
{
    const DRAPE_UINT size = node->m_end - node->m_first;
    const SplitAxis axis = splitAxisOf(nodes + node->m_place);
    const DRAPE_UINT pivot = pivotOfNode(summary, order, node, &axis, rule);
    const DRAPE_UINT below = pivot == 0u ? 0u : countBelow(summary, order, node, &axis, pivot);
    const DRAPE_UINT left = leftSize(below, size);
    if (below != 0u && below != size)
    {
        DRAPE_UINT before = 0;
        for (DRAPE_UINT index = 0; index < size; ++index)
        {
            const DRAPE_UINT triangle = order[node->m_first + index];
            const int isLeft = centroidCell(&axis, summary->m_centroids[triangle]) < pivot;
            other[partedPlace(node, index, before, isLeft)] = triangle;
            before += isLeft ? 1u : 0u;
        }
        for (DRAPE_UINT i = node->m_first; i < node->m_end; ++i)
            order[i] = other[i];
    }
    Dop dops[2];
    dopClear(&dops[0]);
    dopClear(&dops[1]);
    for (DRAPE_UINT index = 0; index < size; ++index)
    {
        dopAddDop(&dops[index < left ? 0 : 1], summary->m_volumes + order[node->m_first + index]);
    }
    splitOpenNode(nodes, splits, node, left, children);
    dopStore(nodes + children[0].m_place, &dops[0]);
    dopStore(nodes + children[1].m_place, &dops[1]);
}

DRAPE_NAMESPACE_END

#endif
