// Parallel locally-ordered clustering: clusters in Morton order look at their neighbours, and two that are each other's
// nearest become one, round by round.
//
// Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction", 2018.
// Distances are compared in one total order of pairs, so that the least pair always merges and every round makes
// progress; of equal distances even-odd neighbours come first, so that equal clusters halve in number.
#ifndef DRAPE_LIB_PLOC_H
#define DRAPE_LIB_PLOC_H

#include "../../../kernels/lib/geometry/dop.h"
#include "tree_layout.h"

DRAPE_NAMESPACE_BEGIN

typedef struct Box
{
    Vec3 m_low, m_high;
} Box;

DRAPE_FUNCTION Box boxUnion(const Box* a, const Box* b)
{
    Box both;
    both.m_low =
        vec3(drapeMin(a->m_low.x, b->m_low.x), drapeMin(a->m_low.y, b->m_low.y), drapeMin(a->m_low.z, b->m_low.z));
    both.m_high = vec3(drapeMax(a->m_high.x, b->m_high.x), drapeMax(a->m_high.y, b->m_high.y),
                       drapeMax(a->m_high.z, b->m_high.z));
    return both;
}

// Returns a triangle's box. A triangle with a NaN or infinite corner has an empty box and merges like any other.
DRAPE_FUNCTION Box boxOfTriangle(const DRAPE_GLOBAL Triangle* triangle, const DRAPE_GLOBAL float* positions)
{
    const Vec3 a = vec3Load(positions, triangle->m_vertices[0]);
    const Vec3 b = vec3Load(positions, triangle->m_vertices[1]);
    const Vec3 c = vec3Load(positions, triangle->m_vertices[2]);
    Box box;
    box.m_low = vec3(DRAPE_INFINITY, DRAPE_INFINITY, DRAPE_INFINITY);
    box.m_high = vec3(-DRAPE_INFINITY, -DRAPE_INFINITY, -DRAPE_INFINITY);
    if (!vec3IsFinite(a) || !vec3IsFinite(b) || !vec3IsFinite(c)) return box;
    box.m_low =
        vec3(drapeMin(a.x, drapeMin(b.x, c.x)), drapeMin(a.y, drapeMin(b.y, c.y)), drapeMin(a.z, drapeMin(b.z, c.z)));
    box.m_high =
        vec3(drapeMax(a.x, drapeMax(b.x, c.x)), drapeMax(a.y, drapeMax(b.y, c.y)), drapeMax(a.z, drapeMax(b.z, c.z)));
    return box;
}

// Half the surface of the box around both: the distance of two clusters.
DRAPE_FUNCTION float unionArea(const Box* a, const Box* b)
{
    const Box both = boxUnion(a, b);
    const float x = both.m_high.x - both.m_low.x;
    const float y = both.m_high.y - both.m_low.y;
    const float z = both.m_high.z - both.m_low.z;
    return x * y + y * z + z * x;
}

// Returns whether the rounds left below DRAPE_TREE_HEIGHT are just enough to halve the clusters until one is left: then
// even and odd neighbours merge whatever their distance.
DRAPE_FUNCTION int plocIsForced(DRAPE_UINT round, DRAPE_UINT count)
{
    return round + ceilLog2(count) >= DRAPE_TREE_HEIGHT;
}

// The cluster that the i-th of count (two or more) would merge with; itself when it has to wait.
DRAPE_FUNCTION DRAPE_UINT plocNearest(const DRAPE_GLOBAL Box* boxes, DRAPE_UINT count, DRAPE_UINT i, DRAPE_UINT radius,
                                      int forced)
{
    const DRAPE_UINT sibling = (i ^ 1u) < count ? i ^ 1u : i;
    if (forced) return sibling;
    const Box own = boxes[i];
    DRAPE_UINT nearest = sibling == i ? i - 1u : sibling;
    Box other = boxes[nearest];
    float least = unionArea(&own, &other);
    for (DRAPE_UINT offset = 1; offset <= radius; ++offset)
    {
        if (i >= offset)
        {
            other = boxes[i - offset];
            const float distance = unionArea(&own, &other);
            if (distance < least)
            {
                least = distance;
                nearest = i - offset;
            }
        }
        if (i + offset < count)
        {
            other = boxes[i + offset];
            const float distance = unionArea(&own, &other);
            if (distance < least)
            {
                least = distance;
                nearest = i + offset;
            }
        }
    }
    return nearest;
}

// A cluster of two: numbers below the triangles' count are leaves, in Morton order; the others are clusters in the
// order in which they were made.
typedef struct Cluster
{
    DRAPE_UINT m_left;
    DRAPE_UINT m_right;
} Cluster;

// The position of a cluster's node in the tree, and its first leaf.
typedef struct ClusterPlace
{
    DRAPE_UINT m_place;
    DRAPE_UINT m_firstLeaf;
} ClusterPlace;

// Links one cluster's node and gives its children their places; a leaf's triangle goes into the order. sizes: leaves
// below each number.
DRAPE_FUNCTION void plocLink(DRAPE_GLOBAL BvhNode* nodes, DRAPE_GLOBAL DRAPE_UINT* splits,
                             DRAPE_GLOBAL DRAPE_UINT* order, const DRAPE_GLOBAL DRAPE_UINT* mortonOrder,
                             const DRAPE_GLOBAL Cluster* clusters, const DRAPE_GLOBAL DRAPE_UINT* sizes,
                             DRAPE_GLOBAL ClusterPlace* places, DRAPE_UINT leafCount, DRAPE_UINT cluster)
{
    const DRAPE_UINT children[2] = {clusters[cluster].m_left, clusters[cluster].m_right};
    const ClusterPlace own = places[cluster];
    const DRAPE_UINT split = own.m_firstLeaf + sizes[children[0]] - 1u;
    treeSetSplit(nodes, splits, own.m_place, sizes[leafCount + cluster], split);
    for (DRAPE_UINT side = 0; side < 2u; ++side)
    {
        ClusterPlace place;
        place.m_place = 2u * split + 1u + side;
        place.m_firstLeaf = side == 0u ? own.m_firstLeaf : split + 1u;
        if (children[side] >= leafCount)
        {
            places[children[side] - leafCount] = place;
            continue;
        }
        treeSetLeaf(nodes, place.m_place, place.m_firstLeaf);
        order[place.m_firstLeaf] = mortonOrder[children[side]];
    }
}

DRAPE_NAMESPACE_END

#endif
