// Broad phase over patches on a CPU: every cloth triangle walks the wide tree of the obstacles' patches, tests the features
// of those it may touch a vector of lanes at a time, and lists the feature tests that are left.
#include "lib/patch_pairs.h"

// A cloth triangle's walk over the obstacles that rest, or over one that moves.
typedef struct Walk
{
    CullVolume m_volume;
    uint m_cloth, m_motion;
    Looker m_looker;
    int m_looks;  // whether m_looker is ready
} Walk;

static void visitPatch(Team* team, Walk* walk, const StepCloths* cloths, const PatchTree* tree, const PatchFeatures* features,
                       const uint patch, const TestList* list)
{
    FeatureTest pair;
    if (!pairWith(&pair, cloths, tree, walk->m_cloth, walk->m_motion, patch)) return;
    if (!walk->m_looks) look(&walk->m_looker, cloths, walk->m_cloth, walk->m_motion);
    walk->m_looks = 1;
    const CullReach reach = cullReach(&walk->m_looker.m_cull, pair.m_reach, features->m_sizes[patch], cloths->m_mode);
    if (teamMakeRoom(team, list)) cullPatch(team, features, pair, &walk->m_looker, reach, DRAPE_NEAR_ALL, list);
}

static void walkTree(Team* team, Walk* walk, const StepCloths* cloths, const PatchTree* tree, const PatchFeatures* features,
                     const TestList* list)
{
    uint stack[DRAPE_WALK_STACK];
    uint depth = 1;
    stack[0] = tree->m_levelCount << DRAPE_LEVEL_SHIFT;
    while (depth > 0 && team->m_place <= list->m_limit)
    {
        const uint entry = stack[--depth];
        const uint level = entry >> DRAPE_LEVEL_SHIFT, index = entry & ((1u << DRAPE_LEVEL_SHIFT) - 1u);
        const uint node = tree->m_levels[level - 1] + index;
        const LaneMask near = cullWideNode(&walk->m_volume, tree->m_nodes + node * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH);
        forLanes(lane, near)
        {
            const uint child = index * DRAPE_PATCH_WIDTH + lane;
            if (level > 1)
                stack[depth++] = ((level - 1) << DRAPE_LEVEL_SHIFT) + child;
            else
                visitPatch(team, walk, cloths, tree, features, child, list);
        }
    }
}

// A work-item takes one cloth triangle, in leaf order.
__kernel void patchCull(DRAPE_WALK_ARGUMENTS, __global const float* restrict patchSizes, __global const float* restrict faces,
                        __global const float* restrict vertices, __global const float* restrict edges)
{
    const uint leaf = get_global_id(0);
    if (leaf >= clothCount) return;
    Walk walk;
    walk.m_cloth = clothOrder[leaf];
    __global const Triangle* triangle = clothTriangles + walk.m_cloth;
    const float clothRadius = radius[triangle->m_mesh];
    if (clothRadius < 0.0f) return;
    const StepCloths cloths = DRAPE_STEP_CLOTHS;
    const PatchTree tree = DRAPE_PATCH_TREE;
    const PatchFeatures features = {patches, patchSizes, faces, vertices, edges};
    const TestList tests = {list, capacity, limit, &counters->m_candidates};
    countInvalid(&cloths, walk.m_cloth, counters);
    Team team;
    teamStart(&team);
    for (walk.m_motion = 0; walk.m_motion <= motionCount && team.m_place <= limit; ++walk.m_motion)
    {
        __global const ObstacleMotion* motion = motionOf(&cloths, walk.m_motion);
        if (motion && thicknessWith(&cloths, walk.m_cloth, motion->m_mesh) < 0.0f) continue;
        walk.m_looks = 0;
        if (cullVolume(&walk.m_volume, motion, triangle, start, end, clothRadius, mode))
            walkTree(&team, &walk, &cloths, &tree, &features, &tests);
    }
    teamFlush(&team, &tests);
}
