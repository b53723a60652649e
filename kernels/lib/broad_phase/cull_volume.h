// Volumes in which to search for contacts of a cloth triangle, and their tests against the wide tree over patches
// (shared/patch.h).
#ifndef DRAPE_LIB_CULL_VOLUME_H
#define DRAPE_LIB_CULL_VOLUME_H

#include "feature_cull.h"

DRAPE_NAMESPACE_BEGIN

// Region to search for contacts of a cloth triangle over the step. m_volume: its path if it is swept, else its end.
// m_radius: m, the largest reach. m_least: m, the reach in any direction, however little the cones admit it
// (cone_reach.h). It is as far as an unswept triangle moves, and more than the distance that counts as met.
typedef struct CullVolume
{
    Dop m_volume;
    float m_radius, m_least;
} CullVolume;

// Positions from which a cloth triangle's volume is made.
typedef struct CullCorners
{
    Vec3 m_p[6];         // m, at the step's start and end; without the sweep both are the end
    int m_swept;         // see isSwept()
    DRAPE_UINT m_valid;  // features, see replaceInvalidCorners()
    float m_noise;       // m, see DRAPE_CULL_NOISE: at most the reach, whatever the cones admit
} CullCorners;

// The volume's interval along direction i.
DRAPE_FUNCTION void cullInterval(const CullCorners* corners, int i, float* low, float* high)
{
    cornersInterval(corners->m_p, i, corners->m_swept, 0.0f, low, high);
    // Four roundings of what the comparison subtracts, and the noise of directions.
    *low -= corners->m_noise * dopNorm(i) + 2.4e-7f * drapeAbs(*low);
    *high += corners->m_noise * dopNorm(i) + 2.4e-7f * drapeAbs(*high);
}

// Returns whether the volume holds anything. least: as in CullVolume.
DRAPE_FUNCTION int cullCorners(CullCorners* corners, float* least, const DRAPE_GLOBAL ObstacleMotion* motion,
                               const DRAPE_GLOBAL Triangle* triangle, const DRAPE_GLOBAL float* start,
                               const DRAPE_GLOBAL float* end, float radius, DRAPE_UINT mode)
{
    Vec3 normal;
    Vec3* p = corners->m_p;
    float height, moved = 0.0f;
    cornersSeen(p, motion, triangle, start, end);
    corners->m_swept = isSwept(p, radius, mode);
    for (int k = 0; k < 3 && !corners->m_swept; ++k)
    {
        if (mode != DRAPE_DISCRETE) moved = drapeMax(moved, vec3Length(vec3Sub(p[3 + k], p[k])));
        p[k] = p[3 + k];
    }
    corners->m_valid = replaceInvalidCorners(p, p + 3);
    *least = moved + DRAPE_CULL_MET * radius;
    const int thin = cullNormal(p + 3, &normal, &height);
    if (corners->m_valid != DRAPE_ALL_FEATURES || thin || height < DRAPE_CULL_SMALL * radius) *least = radius;
    float size = 2.0f * radius;
    for (int i = 0; i < 3; ++i)
    {
        float low, high;
        cornersInterval(p, i, corners->m_swept, 0.0f, &low, &high);
        size += high - low;
    }
    corners->m_noise = drapeMin(DRAPE_CULL_NOISE * size, radius);
    return corners->m_valid != 0u;
}

// Returns whether the volume, grown by the radius, meets the box of a moving obstacle's positions; always true for a
// resting one.
DRAPE_FUNCTION int cullMeets(const CullCorners* corners, float radius, const DRAPE_GLOBAL ObstacleMotion* motion)
{
    int meets = 1;
    for (int axis = 0; axis < 3 && motion; ++axis)
    {
        float low, high;
        cullInterval(corners, axis, &low, &high);
        meets &= (low - radius <= motion->m_high[axis]) & (high + radius >= motion->m_low[axis]);
    }
    return meets;
}

// Returns whether the triangle is not proved out of reach of one child of a wide node (patch.h), along the features'
// directions.
DRAPE_FUNCTION int cullWideChild(const DRAPE_GROUP_MEMORY CullVolume* cull, const DRAPE_GLOBAL float* child)
{
    int near = 1;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        const float share = child[(2 * DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH];
        const float reach = drapeMax(cull->m_radius * share, cull->m_least * dopNorm(i));
        near &= (child[i * DRAPE_PATCH_WIDTH] - reach <= cull->m_volume.m_high[i]) &
                (child[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH] + reach >= cull->m_volume.m_low[i]);
    }
    return near;
}

// Tests all children of the node at once.
DRAPE_FUNCTION LaneMask cullWideNode(const DRAPE_GROUP_MEMORY CullVolume* cull, const DRAPE_GLOBAL float* node)
{
    LaneMask near = lanesMaskSplat(1);
    DRAPE_UNROLL
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        const Lanes share = lanesLoad(node, 2 * DRAPE_DOP_DIRECTIONS + i);
        const Lanes reach = lanesMax(cull->m_radius * share, lanesSplat(cull->m_least * dopNorm(i)));
        near &= (lanesLoad(node, i) - reach <= lanesSplat(cull->m_volume.m_high[i])) &
                (lanesLoad(node, DRAPE_DOP_DIRECTIONS + i) + reach >= lanesSplat(cull->m_volume.m_low[i]));
    }
    return near;
}

DRAPE_NAMESPACE_END

#endif
