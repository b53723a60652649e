// Pairs of a cloth triangle and a patch of the obstacles: selects a step's pairs, the data for testing a patch, and
// the list of remaining feature tests. For kernels only; see simd_group.h for the group that runs them.
#ifndef DRAPE_LIB_PATCH_PAIRS_H
#define DRAPE_LIB_PATCH_PAIRS_H

#include "feature_cull.h"
#include "../geometry/rigid_motion.h"
#include "../step_data/step_views.h"
#include "../work_items/simd_group.h"
#include "wide_walk.h"

// motion: 0 for none, else 1 + its index.
static __global const ObstacleMotion* motionOf(const StepCloths* cloths, const uint motion)
{
    return motion == 0 ? 0 : cloths->m_motions + (motion - 1);
}

// Returns the pair's thickness, m; negative for an untested pair.
static float thicknessWith(const StepCloths* cloths, const uint cloth, const uint mesh)
{
    return cloths->m_thickness[cloths->m_cloth.m_triangles[cloth].m_mesh * cloths->m_obstacleMeshes + mesh];
}

// Returns whether a cloth triangle must be tested against a patch of the obstacles with this motion (all resting
// ones, or one that moves); *pair then holds the test.
static int pairWith(FeatureTest* pair, const StepCloths* cloths, const PackedPatches* patches, const uint cloth,
                    const uint motion, const uint patch)
{
    const uint mesh = patches->m_patches[patch].m_mesh;
    const float thickness = thicknessWith(cloths, cloth, mesh);
    if (thickness < 0.0f) return 0;
    if (findMotion(cloths->m_motions, cloths->m_motionCount, mesh) != motionOf(cloths, motion)) return 0;
    pair->m_cloth = cloth;
    pair->m_lane = patch;
    pair->m_reach = thickness * cloths->m_reachScale;
    pair->m_motion = motion;
    return 1;
}

// Counts the invalid nodes that the triangle owns.
static void countInvalid(const StepCloths* cloths, const uint cloth, __global StepCounters* counters)
{
    const ClothView* view = &cloths->m_cloth;
    __global const Triangle* triangle = view->m_triangles + cloth;
    for (int i = 0; i < 3; ++i)
    {
        const uint vertex = triangle->m_vertices[i];
        if ((triangle->m_owned & DRAPE_OWNS_VERTEX(i)) &&
            !(positionIsValid(vec3Load(view->m_start, vertex)) && positionIsValid(vec3Load(view->m_end, vertex))))
        {
            atomic_inc(&counters->m_invalidNodes);
        }
    }
}

// A cloth triangle relative to one obstacle, for tests against that obstacle's features.
typedef struct CullQuery
{
    CullTriangle m_cull;
    uint m_valid, m_owned;  // its features, bits as in Triangle::m_owned
} CullQuery;

static void makeQuery(CullQuery* query, const StepCloths* cloths, const uint cloth, const uint motion)
{
    const ClothView* view = &cloths->m_cloth;
    query->m_valid = prepareCull(&query->m_cull, view->m_start, view->m_end, view->m_triangles + cloth, view->m_mode,
                                 motionOf(cloths, motion));
    query->m_owned = view->m_triangles[cloth].m_owned;
}

// Lists the tests of a block's lanes in the mask. kind: DRAPE_TEST_NODE …; first: the block's first lane.
static void keepLanes(DRAPE_GROUP_MEMORY SimdGroup* group, const LaneMask mask, FeatureTest test, const uint kind,
                      const uint first, const TestList* list)
{
    test.m_cloth |= kind << DRAPE_TEST_SHIFT;
    forLanes(lane, mask)
    {
        test.m_lane = first + lane;
        simdKeep(group, list, test);
    }
}

#endif
