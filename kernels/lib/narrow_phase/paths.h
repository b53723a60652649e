// Tests features that the feature tests accept as met or near against the directions of the volumes.
//
// Feature tests drop a pair only on proof. If a feature is long, far from the other or degenerate, rounding may keep
// a pair that is farther apart than the reach, and than volumes contain. The volumes would then decide whether there
// is a contact. The tests here are proofs, too, and are the same as those of any traversal's volumes: every
// traversal's volumes contain the pairs that remain.
#ifndef DRAPE_LIB_PATHS_H
#define DRAPE_LIB_PATHS_H

#include "../geometry/dop.h"
#include "feature_contact.h"

DRAPE_NAMESPACE_BEGIN

// Share of the reach by which paths of features that met may be apart. Volumes contain more than this in any
// direction (DRAPE_CULL_MET of feature_cull.h).
#define DRAPE_PATH_REACH 0.01f
// Rounding error of distances, as a share of a pair's extent.
#define DRAPE_PATH_ROUNDING 3e-6f

// Returns whether the paths of two features, of the first `count` points and of the others, are not proved farther
// apart than the distance, m.
DRAPE_FUNCTION int pathsOverlap(const Vec3 start[4], const Vec3 end[4], int count, float distance)
{
    int overlap = 1;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS && overlap; ++i)
    {
        float low[2] = {DRAPE_INFINITY, DRAPE_INFINITY}, high[2] = {-DRAPE_INFINITY, -DRAPE_INFINITY};
        for (int k = 0; k < 4; ++k)
        {
            const float from = dopProject(start[k], i), to = dopProject(end[k], i);
            const float inner = drapeMax(dopInner(start[k], i), dopInner(end[k], i));
            dopGrowInterval(low + (k >= count), high + (k >= count), drapeMin(from, to), drapeMax(from, to),
                            0.5f * distance * dopNorm(i), inner);
        }
        overlap = (low[0] <= high[1]) & (low[1] <= high[0]);
    }
    return overlap;
}

// Returns whether features with this computed distance, m, are farther apart than the reach after all.
DRAPE_FUNCTION int outOfReach(float distance, const Vec3 points[4], int count, PairBounds bounds)
{
    return distance > bounds.m_reach - DRAPE_PATH_ROUNDING * bounds.m_extent &&
           !pathsOverlap(points, points, count, bounds.m_reach);
}

DRAPE_FUNCTION int pointIsOutOfReach(float distance, Vec3 point, FeatureTriangle face, PairBounds bounds)
{
    const Vec3 points[4] = {point, face.m_p[0], face.m_p[1], face.m_p[2]};
    return outOfReach(distance, points, 1, bounds);
}

// The first edge runs from a to b, the second from the frame's origin to `far`.
DRAPE_FUNCTION int edgesAreOutOfReach(float distance, Vec3 a, Vec3 b, Vec3 far, PairBounds bounds)
{
    const Vec3 points[4] = {a, b, vec3(0.0f, 0.0f, 0.0f), far};
    return outOfReach(distance, points, 2, bounds);
}

DRAPE_NAMESPACE_END

#endif
