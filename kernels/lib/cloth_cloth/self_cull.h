// Finds pairs of features of one cloth that may touch in a step: tests boxes of features a block of lanes at a time,
// then the features' own volumes.
//
// Every volume is the union of its nodes' volumes (vertexVolume). A box or a patch's volume therefore contains those
// of all its features, and the pairs found do not depend on the patches. If only the outermost projections of several
// nodes are padded, a bound may differ in its last bit; selfGrowth() covers a thousand times that.
#ifndef DRAPE_LIB_SELF_CULL_H
#define DRAPE_LIB_SELF_CULL_H

#include "../broad_phase/leaf_walk.h"
#include "../work_items/lanes.h"

DRAPE_NAMESPACE_BEGIN

// The first three directions of a volume.
typedef struct FeatureBox
{
    float m_low[3], m_high[3];
} FeatureBox;

DRAPE_FUNCTION FeatureBox emptyBox(void)
{
    FeatureBox box;
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
    {
        box.m_low[i] = DRAPE_INFINITY;
        box.m_high[i] = -DRAPE_INFINITY;
    }
    return box;
}

DRAPE_FUNCTION FeatureBox joinBoxes(FeatureBox a, FeatureBox b)
{
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
    {
        a.m_low[i] = drapeMin(a.m_low[i], b.m_low[i]);
        a.m_high[i] = drapeMax(a.m_high[i], b.m_high[i]);
    }
    return a;
}

DRAPE_FUNCTION int boxesMeet(const FeatureBox* a, const FeatureBox* b)
{
    int meet = 1;
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
        meet &= (a->m_low[i] <= b->m_high[i]) & (a->m_high[i] >= b->m_low[i]);
    return meet;
}

// Grows an interval along one direction to contain a node's position, like dopAddPoint.
DRAPE_FUNCTION void growInterval(Vec3 p, float radius, int direction, float* low, float* high)
{
    const float v = dopProject(p, direction);
    dopGrowInterval(low, high, v, v, radius * dopNorm(direction), dopInner(p, direction));
}

DRAPE_FUNCTION int nodeIsValid(const DRAPE_GLOBAL float* start, const DRAPE_GLOBAL float* end, DRAPE_UINT node)
{
    return positionIsValid(vec3Load(start, node)) && positionIsValid(vec3Load(end, node));
}

// Returns a node's box; empty for an invalid node.
DRAPE_FUNCTION FeatureBox nodeBox(const DRAPE_GLOBAL float* start, const DRAPE_GLOBAL float* end, DRAPE_UINT node,
                                  float radius)
{
    FeatureBox box = emptyBox();
    const Vec3 from = vec3Load(start, node), to = vec3Load(end, node);
    if (!positionIsValid(from) || !positionIsValid(to)) return box;
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
    {
        growInterval(from, radius, i, &box.m_low[i], &box.m_high[i]);
        growInterval(to, radius, i, &box.m_low[i], &box.m_high[i]);
    }
    return box;
}

// Maximum padding of two volumes, as a share of their growth, of the bounds that face each other and of the inner
// sum. Each share is less than 3e-7.
#define DRAPE_SELF_PAD 1e-6f

// Returns whether a direction beyond the axes separates two features by more than their volumes are grown and padded.
// nodeVolumesOverlap() would then return false, in three times the time. Nodes and split as there.
DRAPE_FUNCTION int nodesFarApart(const Vec3 start[4], const Vec3 end[4], int split, float radius)
{
    DRAPE_UNROLL
    for (int i = 3; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        float low = DRAPE_INFINITY, high = -DRAPE_INFINITY, lowOther = DRAPE_INFINITY, highOther = -DRAPE_INFINITY;
        float inner = 0.0f;
        DRAPE_UNROLL
        for (int k = 0; k < 4; ++k)
        {
            const int other = k >= split;
            const float v0 = dopProject(start[k], i), v1 = dopProject(end[k], i);
            inner = drapeMax(inner, drapeMax(dopInner(start[k], i), dopInner(end[k], i)));
            const float least = drapeMin(v0, v1), greatest = drapeMax(v0, v1);
            low = other ? low : drapeMin(low, least);
            high = other ? high : drapeMax(high, greatest);
            lowOther = other ? drapeMin(lowOther, least) : lowOther;
            highOther = other ? drapeMax(highOther, greatest) : highOther;
        }
        const float grown = 2.0f * radius * dopNorm(i), share = DRAPE_SELF_PAD;
        const float gap = low - highOther, gapOther = lowOther - high;
        if (gap > grown + share * (grown + inner + drapeAbs(low) + drapeAbs(highOther))) return 1;
        if (gapOther > grown + share * (grown + inner + drapeAbs(lowOther) + drapeAbs(high))) return 1;
    }
    return 0;
}

DRAPE_FUNCTION int placesAreValid(const Vec3 from[4], const Vec3 to[4])
{
    int valid = 1;
    for (int k = 0; k < 4; ++k)
        valid &= positionIsValid(from[k]) & positionIsValid(to[k]);
    return valid;
}

// Returns whether the volumes of two features overlap, given that their boxes do. A volume joins its feature's valid
// nodes; the first `split` of four nodes are the first feature's. The answer equals featuresOverlap() of the nodes'
// volumes.
DRAPE_FUNCTION int nodeVolumesOverlap(const Vec3 from[4], const Vec3 to[4], int split, float radius)
{
    DRAPE_UNROLL
    for (int i = 3; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        // Four scalars instead of arrays of two, which a GPU would keep in memory.
        float low = DRAPE_INFINITY, high = -DRAPE_INFINITY, lowOther = DRAPE_INFINITY, highOther = -DRAPE_INFINITY;
        DRAPE_UNROLL
        for (int k = 0; k < 4; ++k)
        {
            const int other = k >= split;
            float least = DRAPE_INFINITY, greatest = -DRAPE_INFINITY;
            growInterval(from[k], radius, i, &least, &greatest);
            growInterval(to[k], radius, i, &least, &greatest);
            low = other ? low : drapeMin(low, least);
            high = other ? high : drapeMax(high, greatest);
            lowOther = other ? drapeMin(lowOther, least) : lowOther;
            highOther = other ? drapeMax(highOther, greatest) : highOther;
        }
        if (low > highOther || lowOther > high) return 0;
    }
    return 1;
}

// Boxes of a block, a lane each.
typedef struct BoxLanes
{
    Lanes m_low[3], m_high[3];
} BoxLanes;

DRAPE_FUNCTION BoxLanes loadBoxes(const DRAPE_GLOBAL float* block)
{
    BoxLanes boxes;
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
    {
        boxes.m_low[i] = lanesLoad(block, i);
        boxes.m_high[i] = lanesLoad(block, 3 + i);
    }
    return boxes;
}

DRAPE_FUNCTION LaneMask boxesOverlap(const BoxLanes* boxes, const FeatureBox* box)
{
    LaneMask near = lanesMaskSplat(1);
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
        near &= (boxes->m_low[i] <= lanesSplat(box->m_high[i])) & (boxes->m_high[i] >= lanesSplat(box->m_low[i]));
    return near;
}

// Loads the volume of a patch, from the lowest level of the wide tree (patch.h).
DRAPE_FUNCTION Dop childVolume(const DRAPE_GLOBAL float* nodes, DRAPE_UINT patch)
{
    const DRAPE_GLOBAL float* child =
        nodes + (patch / DRAPE_PATCH_WIDTH) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH + patch % DRAPE_PATCH_WIDTH;
    Dop volume;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        volume.m_low[i] = child[i * DRAPE_PATCH_WIDTH];
        volume.m_high[i] = child[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH];
    }
    return volume;
}

DRAPE_FUNCTION FeatureBox boxOfVolume(const Dop* volume)
{
    FeatureBox box;
    for (int i = 0; i < 3; ++i)
    {
        box.m_low[i] = volume->m_low[i];
        box.m_high[i] = volume->m_high[i];
    }
    return box;
}

DRAPE_FUNCTION FeatureBox childBox(const DRAPE_GLOBAL float* nodes, DRAPE_UINT patch)
{
    const Dop volume = childVolume(nodes, patch);
    return boxOfVolume(&volume);
}

// Returns the number of patches under a child of a node of that level of the wide tree.
DRAPE_FUNCTION DRAPE_UINT patchesBelow(DRAPE_UINT level)
{
    DRAPE_UINT below = 1;
    for (DRAPE_UINT i = 1; i < level; ++i)
        below *= DRAPE_PATCH_WIDTH;
    return below;
}

// Returns the children of a wide node whose volumes overlap a volume; ignores the reach of their contacts.
DRAPE_FUNCTION LaneMask wideOverlaps(const Dop* volume, const DRAPE_GLOBAL float* node)
{
    LaneMask near = lanesMaskSplat(1);
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
        near &= (lanesLoad(node, i) <= lanesSplat(volume->m_high[i])) &
                (lanesLoad(node, DRAPE_DOP_DIRECTIONS + i) >= lanesSplat(volume->m_low[i]));
    return near;
}

DRAPE_NAMESPACE_END

#endif
