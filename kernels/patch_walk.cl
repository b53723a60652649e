// Broad phase over patches on a GPU, in two launches. A group's lanes that did all of it for one cloth triangle would do one
// thing after the other with most of the machine idle: so the walk only lists the pairs of a triangle and a patch that it may
// touch, and the groups of the second launch share them out. A group walks for one triangle where there are few, and else for
// a packet of triangles that lie near each other.
#include "lib/patch_pairs.h"

// Nodes of the wide tree that a group for one triangle looks at together, at most.
#define DRAPE_WALK_NODES 4
// Nodes are taken from the lowest level that is left, so that each level has the children of one turn on the stack.
#define DRAPE_WALK_STACK (DRAPE_LEVELS * DRAPE_PATCH_WIDTH * DRAPE_WALK_NODES)
// Patches found before they are made into pairs.
#define DRAPE_WALK_FOUND (2 * DRAPE_WALK_NODES * DRAPE_PATCH_WIDTH)

// What a group shares.
typedef struct Walkers
{
    Team m_team;
    uint m_stack[DRAPE_WALK_STACK];
    uint m_found[DRAPE_WALK_FOUND];
    uint m_foundCount;
    CullVolume m_volumes[DRAPE_PATCH_WIDTH];  // of a packet's triangles
} Walkers;

// A walk over the obstacles that rest, or over one that moves.
typedef struct Walk
{
    CullVolume m_volume;  // of the triangle, or of all of the packet
    uint m_motion;
    uint m_packet;     // triangles: 1 or DRAPE_PATCH_WIDTH
    uint m_cloth;      // this lane's triangle
    CullVolume m_own;  // its volume
    int m_near;        // whether it may come near the obstacle
} Walk;

// Lists the pairs of this lane's triangle and the patches found from first up to last, DRAPE_PATCH_WIDTH at most, side by
// side: patchCullPairs gains by it.
static void pairLane(__local Walkers* walkers, const Walk* walk, const StepCloths* cloths, const PatchTree* tree,
                     const uint first, const uint last, const TestList* list)
{
    uint touched = 0;
    FeatureTest pair;
    for (uint i = first; i < last; ++i)
    {
        const uint patch = walkers->m_found[i];
        __global const float* node = tree->m_nodes + (patch / DRAPE_PATCH_WIDTH) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH;
        if (walk->m_near && cullWideChild(&walk->m_own, node + patch % DRAPE_PATCH_WIDTH) &&
            pairWith(&pair, cloths, tree, walk->m_cloth, walk->m_motion, patch))
            touched |= 1u << (i - first);
    }
    uint slot = touched == 0 ? 0 : atomic_add(&walkers->m_team.m_keptCount, popcount(touched));
    for (; touched != 0; touched &= touched - 1)
    {
        pairWith(&pair, cloths, tree, walk->m_cloth, walk->m_motion, walkers->m_found[first + 31 - clz(touched & -touched)]);
        teamPut(&walkers->m_team, list, slot++, pair);
    }
}

// Makes the patches found into pairs, where there are `least` of them. In a packet the lanes, which had a patch each, now
// have a triangle each.
static void settleFound(__local Walkers* walkers, const Walk* walk, const StepCloths* cloths, const PatchTree* tree,
                        const TestList* list, const uint least)
{
    teamSync();
    const uint count = walkers->m_foundCount;
    teamSync();
    if (count < least) return;
    for (uint i = teamLane(); i < count && walk->m_packet == 1; i += teamWidth())
    {
        FeatureTest pair;
        if (pairWith(&pair, cloths, tree, walk->m_cloth, walk->m_motion, walkers->m_found[i]))
            teamKeep(&walkers->m_team, list, pair);
    }
    for (uint first = 0; first < count && walk->m_packet > 1; first += DRAPE_PATCH_WIDTH)
    {
        pairLane(walkers, walk, cloths, tree, first, min(count, first + DRAPE_PATCH_WIDTH), list);
        if (!teamMakeRoom(&walkers->m_team, list)) break;
    }
    teamSync();
    if (teamLane() == 0) walkers->m_foundCount = 0;
    teamSync();
}

// How many nodes are taken from the stack together: those on top that are of one level.
static uint nodesInTurn(__local const uint* stack, const uint depth, const uint most)
{
    uint nodes = 1;
    while (nodes < min(depth, most) && stack[depth - 1 - nodes] >> DRAPE_LEVEL_SHIFT == stack[depth - 1] >> DRAPE_LEVEL_SHIFT)
        ++nodes;
    return nodes;
}

static void walkTree(__local Walkers* walkers, const Walk* walk, const StepCloths* cloths, const PatchTree* tree,
                     const TestList* list)
{
    __local Team* team = &walkers->m_team;
    __local uint* stack = walkers->m_stack;
    const uint most = teamWidth() / DRAPE_PATCH_WIDTH;
    const uint turn = teamLane() / DRAPE_PATCH_WIDTH, lane = teamLane() % DRAPE_PATCH_WIDTH;
    teamSync();
    if (teamLane() == 0)
    {
        stack[0] = tree->m_levelCount << DRAPE_LEVEL_SHIFT;
        team->m_depth = 1;
    }
    teamSync();
    while (team->m_depth > 0)
    {
        const uint depth = team->m_depth;
        const uint nodes = nodesInTurn(stack, depth, most);
        const uint entry = stack[depth - 1 - min(turn, nodes - 1)];
        teamSync();
        if (teamLane() == 0) team->m_depth = depth - nodes;
        teamSync();
        const uint level = entry >> DRAPE_LEVEL_SHIFT, index = entry & ((1u << DRAPE_LEVEL_SHIFT) - 1u);
        __global const float* node =
            tree->m_nodes + (tree->m_levels[level - 1] + index) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH;
        const uint child = index * DRAPE_PATCH_WIDTH + lane;
        if (turn < nodes && cullWideChild(&walk->m_volume, node + lane))
        {
            if (level > 1)
                stack[atomic_inc(&team->m_depth)] = ((level - 1) << DRAPE_LEVEL_SHIFT) + child;
            else
                walkers->m_found[atomic_inc(&walkers->m_foundCount)] = child;
        }
        settleFound(walkers, walk, cloths, tree, list, DRAPE_WALK_FOUND - DRAPE_WALK_NODES * DRAPE_PATCH_WIDTH + 1);
        if (!teamMakeRoom(team, list)) return;
    }
    settleFound(walkers, walk, cloths, tree, list, 1);
}

// The volume of the whole packet.
static void joinVolumes(__local CullVolume* volumes, Walk* walk)
{
    walk->m_volume = walk->m_own;
    if (walk->m_packet == 1) return;
    teamSync();
    volumes[teamLane()] = walk->m_own;
    teamSync();
    for (uint lane = 0; lane < DRAPE_PATCH_WIDTH; ++lane)
    {
        for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
        {
            walk->m_volume.m_volume.m_low[i] = drapeMin(walk->m_volume.m_volume.m_low[i], volumes[lane].m_volume.m_low[i]);
            walk->m_volume.m_volume.m_high[i] = drapeMax(walk->m_volume.m_volume.m_high[i], volumes[lane].m_volume.m_high[i]);
        }
        walk->m_volume.m_radius = drapeMax(walk->m_volume.m_radius, volumes[lane].m_radius);
        walk->m_volume.m_least = drapeMax(walk->m_volume.m_least, volumes[lane].m_least);
    }
}

// A group lists the pairs of `packet` cloth triangles, in leaf order. packet: 1 with up to DRAPE_WALK_NODES times
// DRAPE_PATCH_WIDTH lanes, or DRAPE_PATCH_WIDTH with as many lanes.
__kernel void patchWalk(DRAPE_WALK_ARGUMENTS, const uint packet)
{
    __local Walkers walkers;
    const StepCloths cloths = DRAPE_STEP_CLOTHS;
    const PatchTree tree = DRAPE_PATCH_TREE;
    const TestList pairs = {list, capacity, limit, &counters->m_patchPairs};
    const uint group = get_group_id(0);
    const uint leaf = packet == 1 ? group : group * packet + teamLane();
    Walk walk;
    walk.m_packet = packet;
    walk.m_cloth = clothOrder[min(leaf, clothCount - 1)];
    __global const Triangle* triangle = clothTriangles + walk.m_cloth;
    const float clothRadius = leaf < clothCount ? radius[triangle->m_mesh] : -1.0f;
    if (clothRadius >= 0.0f && (packet > 1 || teamLane() == 0)) countInvalid(&cloths, walk.m_cloth, counters);
    if (teamLane() == 0) walkers.m_foundCount = 0;
    teamStart(&walkers.m_team);
    for (walk.m_motion = 0; walk.m_motion <= motionCount && walkers.m_team.m_place <= limit; ++walk.m_motion)
    {
        __global const ObstacleMotion* motion = motionOf(&cloths, walk.m_motion);
        walk.m_near = clothRadius >= 0.0f && !(motion && thicknessWith(&cloths, walk.m_cloth, motion->m_mesh) < 0.0f) &&
                      cullVolume(&walk.m_own, motion, triangle, start, end, clothRadius, mode);
        if (!walk.m_near) emptyVolume(&walk.m_own);
        joinVolumes(walkers.m_volumes, &walk);
        walkTree(&walkers, &walk, &cloths, &tree, &pairs);
    }
    teamFlush(&walkers.m_team, &pairs);
}

// Every lane makes the looker, which takes no longer than one does.
static void lookTogether(__local Looker* looker, const StepCloths* cloths, const FeatureTest pair)
{
    Looker own;
    look(&own, cloths, pair.m_cloth, pair.m_motion);
    teamSync();
    if (teamLane() == 0) *looker = own;
    teamSync();
}

// Lists the feature tests of the pairs that patchWalk listed, as many as fitted there. Each group takes a stretch of them:
// most pairs next to each other are of one cloth triangle.
__kernel void patchCullPairs(__global const FeatureTest* restrict pairs, const uint pairCapacity,
                             __global const Triangle* restrict clothTriangles, __global const float* restrict start,
                             __global const float* restrict end, const uint mode,
                             __global const ObstacleMotion* restrict motions, __global const Patch* restrict patches,
                             __global const float* restrict patchSizes, __global const float* restrict faces,
                             __global const float* restrict vertices, __global const float* restrict edges,
                             __global FeatureTest* restrict list, const uint capacity, const uint limit,
                             __global StepCounters* restrict counters)
{
    const uint count = min(counters->m_patchPairs, pairCapacity);
    const uint groups = get_num_groups(0), group = get_group_id(0);
    const uint share = (count + groups - 1) / groups;
    const uint first = min(group * share, count), last = min(first + share, count);
    const StepCloths cloths = {clothTriangles, start, end, 0, 0, 0.0f, mode, motions, 0};
    const PatchFeatures features = {patches, patchSizes, faces, vertices, edges};
    const TestList tests = {list, capacity, limit, &counters->m_candidates};
    __local Team team;
    __local Looker looker;
    teamStart(&team);
    for (uint i = first; i < last; ++i)
    {
        const FeatureTest pair = pairs[i];
        const int known = i > first && pairs[i - 1].m_cloth == pair.m_cloth && pairs[i - 1].m_motion == pair.m_motion;
        if (!known) lookTogether(&looker, &cloths, pair);
        cullPatch(&team, &features, pair, &looker, &tests);
        if (!teamMakeRoom(&team, &tests)) break;
    }
    teamFlush(&team, &tests);
}
