// Pairs of a cloth triangle and a patch of the obstacles: selects a step's pairs, the data for testing a patch, and
// the list of remaining feature tests. For kernels only; see team.h for the team that runs them.
#ifndef DRAPE_LIB_PATCH_PAIRS_H
#define DRAPE_LIB_PATCH_PAIRS_H

#include "feature_cull.h"
#include "rigid_motion.h"
#include "team.h"
#include "wide_walk.h"

// The cloths of a step and their pairs. thickness: m, cloths × obstacles, negative for untested pairs. mode:
// DRAPE_DISCRETE …. motions: of the obstacles that move in the step.
typedef struct StepCloths
{
    __global const Triangle* m_triangles;
    __global const float* m_start;
    __global const float* m_end;
    __global const float* m_thickness;
    uint m_obstacleMeshes;
    float m_reachScale;
    uint m_mode;
    __global const ObstacleMotion* m_motions;
    uint m_motionCount;
} StepCloths;

// The wide tree over the patches.
typedef struct PatchTree
{
    __global const float* m_nodes;
    __global const uint* m_levels;  // first node of each of m_levelCount levels, lowest first
    uint m_levelCount;
    __global const Patch* m_patches;
} PatchTree;

// Inputs and output list of traversal kernels. radius: m, per cloth, negative for cloths outside the step. limit: see
// team.h. Counters must be zero before. The list has no particular order.
#define DRAPE_WALK_ARGUMENTS                                                                                           \
    __global const uint *restrict clothOrder, __global const Triangle *restrict clothTriangles, const uint clothCount, \
        __global const float *restrict start, __global const float *restrict end,                                      \
        __global const float *restrict radius, __global const float *restrict thickness, const uint obstacleMeshes,    \
        const float reachScale, const uint mode, __global const ObstacleMotion *restrict motions,                      \
        const uint motionCount, __global const float *restrict wideNodes, __global const uint *restrict levels,        \
        const uint levelCount, __global const Patch *restrict patches, __global FeatureTest *restrict list,            \
        const uint capacity, const uint limit, __global StepCounters *restrict counters
#define DRAPE_STEP_CLOTHS                                                                             \
    {                                                                                                 \
        clothTriangles, start, end, thickness, obstacleMeshes, reachScale, mode, motions, motionCount \
    }
#define DRAPE_PATCH_TREE                       \
    {                                          \
        wideNodes, levels, levelCount, patches \
    }

// motion: 0 for none, else 1 + its index.
static __global const ObstacleMotion* motionOf(const StepCloths* cloths, const uint motion)
{
    return motion == 0 ? 0 : cloths->m_motions + (motion - 1);
}

// Returns the pair's thickness, m; negative for an untested pair.
static float thicknessWith(const StepCloths* cloths, const uint cloth, const uint mesh)
{
    return cloths->m_thickness[cloths->m_triangles[cloth].m_mesh * cloths->m_obstacleMeshes + mesh];
}

// Returns whether a cloth triangle must be tested against a patch of the obstacles with this motion (all resting
// ones, or one that moves); *pair then holds the test.
static int pairWith(FeatureTest* pair, const StepCloths* cloths, const PatchTree* tree, const uint cloth,
                    const uint motion, const uint patch)
{
    const uint mesh = tree->m_patches[patch].m_mesh;
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
    __global const Triangle* triangle = cloths->m_triangles + cloth;
    for (int i = 0; i < 3; ++i)
    {
        const uint vertex = triangle->m_vertices[i];
        if ((triangle->m_owned & DRAPE_OWNS_VERTEX(i)) &&
            !(positionIsValid(vec3Load(cloths->m_start, vertex)) && positionIsValid(vec3Load(cloths->m_end, vertex))))
        {
            atomic_inc(&counters->m_invalidNodes);
        }
    }
}

// A cloth triangle relative to one obstacle, for tests against that obstacle's features.
typedef struct Looker
{
    CullTriangle m_cull;
    uint m_valid, m_owned;  // its features, bits as in Triangle::m_owned
} Looker;

static void look(Looker* looker, const StepCloths* cloths, const uint cloth, const uint motion)
{
    looker->m_valid = prepareCull(&looker->m_cull, cloths->m_start, cloths->m_end, cloths->m_triangles + cloth,
                                  cloths->m_mode, motionOf(cloths, motion));
    looker->m_owned = cloths->m_triangles[cloth].m_owned;
}

// The obstacles' features in blocks.
typedef struct PatchFeatures
{
    __global const Patch* m_patches;
    __global const float* m_sizes;
    __global const float* m_faces;
    __global const float* m_vertices;
    __global const float* m_edges;
} PatchFeatures;

// Lists the tests of a block's lanes in the mask. kind: DRAPE_TEST_NODE …; first: the block's first lane.
static void keepLanes(DRAPE_TEAM Team* team, const LaneMask mask, FeatureTest test, const uint kind, const uint first,
                      const TestList* list)
{
    test.m_cloth |= kind << DRAPE_TEST_SHIFT;
    forLanes(lane, mask)
    {
        test.m_lane = first + lane;
        teamKeep(team, list, test);
    }
}

#endif
