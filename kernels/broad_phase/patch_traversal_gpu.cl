// Broad phase over patches on a GPU, in two launches. If one group did all of the work for a cloth triangle, its
// steps would run one after the other with most of the machine idle. The traversal therefore only lists pairs of a
// triangle and a patch that it may touch, and the groups of the second launch share them (patch_cull_pairs_gpu.cl). A
// group traverses for one triangle where there are few, otherwise for a packet of neighbouring triangles.
#include "../lib/broad_phase/cull_volume.h"
#include "../lib/broad_phase/patch_pairs.h"

// Maximum patches found before they are turned into pairs.
#define DRAPE_WALK_FOUND (2 * DRAPE_WALK_NODES * DRAPE_PATCH_WIDTH)

// Local memory of a group.
typedef struct Walkers
{
    SimdGroup m_group;
    uint m_stack[DRAPE_WALK_NODES * DRAPE_WALK_STACK];
    uint m_found[DRAPE_WALK_FOUND];
    uint m_foundCount;
    CullVolume m_volumes[DRAPE_PATCH_WIDTH];  // volumes of a packet's triangles; empty if out of the obstacle's reach
    CullVolume m_joined;                      // union of the volumes, or the single triangle's
} Walkers;

// A traversal of the resting obstacles, or of one that moves.
typedef struct Walk
{
    uint m_motion;
    uint m_packet;  // triangles: 1 or DRAPE_PATCH_WIDTH
    uint m_cloth;   // this lane's triangle
} Walk;

// Lists the pairs of this lane's triangle and the patches found from first up to last, at most DRAPE_PATCH_WIDTH. They
// are adjacent in the list, which makes patchCullPairs faster.
static void pairLane(__local Walkers* walkers, const Walk* walk, const StepCloths* cloths, const PackedPatches* patches,
                     const uint first, const uint last, const TestList* list)
{
    __local const CullVolume* own = walkers->m_volumes + simdLane() % DRAPE_PATCH_WIDTH;
    uint touched = 0;
    FeatureTest pair;
    for (uint i = first; i < last; ++i)
    {
        const uint patch = walkers->m_found[i];
        __global const float* node =
            patches->m_wideNodes + (patch / DRAPE_PATCH_WIDTH) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH;
        if (cullWideChild(own, node + patch % DRAPE_PATCH_WIDTH) &&
            pairWith(&pair, cloths, patches, walk->m_cloth, walk->m_motion, patch))
            touched |= 1u << (i - first);
    }
    uint kept = touched == 0 ? 0 : atomic_add(&walkers->m_group.m_keptCount, popcount(touched));
    for (; touched != 0; touched &= touched - 1)
    {
        pairWith(&pair, cloths, patches, walk->m_cloth, walk->m_motion,
                 walkers->m_found[first + 31 - clz(touched & -touched)]);
        simdPut(&walkers->m_group, list, kept++, pair);
    }
}

// Turns the patches found into pairs if there are at least `least`. In a packet the lanes, which had a patch each, now
// have a triangle each, and each DRAPE_PATCH_WIDTH lanes a share of the patches.
static void listFound(__local Walkers* walkers, const Walk* walk, const StepCloths* cloths,
                      const PackedPatches* patches, const TestList* list, const uint least)
{
    simdSync();
    const uint count = walkers->m_foundCount;
    simdSync();
    if (count < least) return;
    for (uint i = simdLane(); i < count && walk->m_packet == 1; i += simdWidth())
    {
        FeatureTest pair;
        if (pairWith(&pair, cloths, patches, walk->m_cloth, walk->m_motion, walkers->m_found[i]))
            simdKeep(&walkers->m_group, list, pair);
    }
    const uint turns = simdWidth() / DRAPE_PATCH_WIDTH, turn = simdLane() / DRAPE_PATCH_WIDTH;
    for (uint first = 0; first < count && walk->m_packet > 1; first += simdWidth())
    {
        const uint part = min(count - first, (uint)simdWidth()), share = (part + turns - 1) / turns;
        pairLane(walkers, walk, cloths, patches, first + min(part, turn * share), first + min(part, (turn + 1) * share),
                 list);
        if (!simdMakeRoom(&walkers->m_group, list)) break;
    }
    simdSync();
    if (simdLane() == 0) walkers->m_foundCount = 0;
    simdSync();
}

static void walkTree(__local Walkers* walkers, const Walk* walk, const StepCloths* cloths, const PackedPatches* patches,
                     const TestList* list)
{
    __local SimdGroup* group = &walkers->m_group;
    __local uint* stack = walkers->m_stack;
    const uint most = simdWidth() / DRAPE_PATCH_WIDTH;
    const uint turn = simdLane() / DRAPE_PATCH_WIDTH, lane = simdLane() % DRAPE_PATCH_WIDTH;
    simdSync();
    if (simdLane() == 0) group->m_depth = beginWalk(stack, patches->m_levels, patches->m_levelCount);
    simdSync();
    while (group->m_depth > 0)
    {
        const uint depth = group->m_depth;
        const uint nodes = nodesInTurn(stack, depth, most);
        const uint entry = stack[depth - 1 - min(turn, nodes - 1)];
        simdSync();
        if (simdLane() == 0) group->m_depth = depth - nodes;
        simdSync();
        const uint level = entryLevel(entry), index = entryIndex(entry);
        __global const float* node =
            patches->m_wideNodes + (patches->m_levels[level - 1] + index) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH;
        const uint child = index * DRAPE_PATCH_WIDTH + lane;
        if (turn < nodes && cullWideChild(&walkers->m_joined, node + lane))
        {
            if (level > 1)
                stack[atomic_inc(&group->m_depth)] = walkEntry(level - 1, child);
            else
                walkers->m_found[atomic_inc(&walkers->m_foundCount)] = child;
        }
        listFound(walkers, walk, cloths, patches, list, DRAPE_WALK_FOUND - DRAPE_WALK_NODES * DRAPE_PATCH_WIDTH + 1);
        if (!simdMakeRoom(group, list)) return;
    }
    listFound(walkers, walk, cloths, patches, list, 1);
}

// Joins a packet's volumes. They are in local memory, since in registers they would leave room for few groups.
static void joinVolumes(__local Walkers* walkers)
{
    // Joins the volumes in one direction per lane; one more lane joins their radii.
    const uint lane = simdLane();
    if (lane > DRAPE_DOP_DIRECTIONS) return;
    __local CullVolume* joined = &walkers->m_joined;
    const int ofRadii = lane == DRAPE_DOP_DIRECTIONS;
    float least = INFINITY, most = -INFINITY;
    for (uint i = 0; i < DRAPE_PATCH_WIDTH; ++i)
    {
        __local const CullVolume* volume = walkers->m_volumes + i;
        least = ofRadii ? drapeMin(least, -volume->m_least) : drapeMin(least, volume->m_volume.m_low[lane]);
        most = ofRadii ? drapeMax(most, volume->m_radius) : drapeMax(most, volume->m_volume.m_high[lane]);
    }
    *(ofRadii ? &joined->m_least : joined->m_volume.m_low + lane) = ofRadii ? -least : least;
    *(ofRadii ? &joined->m_radius : joined->m_volume.m_high + lane) = most;
}

// Stores a volume's interval in one direction, empty if the triangle cannot come near the obstacle.
static void storeInterval(__local CullVolume* volume, const CullCorners* corners, const int near, const uint direction)
{
    float low = INFINITY, high = -INFINITY;
    if (near) cullInterval(corners, direction, &low, &high);
    volume->m_volume.m_low[direction] = low;
    volume->m_volume.m_high[direction] = high;
}

// Makes the volumes of the group's triangles for the resting obstacles, or for one that moves. In a packet each of the
// first lanes makes its triangle's volume; for a single triangle each lane makes the volume's interval in one
// direction.
static void makeVolumes(__local Walkers* walkers, const Walk* walk, const StepCloths* cloths, const float clothRadius)
{
    const ClothView* view = &cloths->m_cloth;
    __global const ObstacleMotion* motion = motionOf(cloths, walk->m_motion);
    const uint lane = simdLane();
    const int alone = walk->m_packet == 1;
    simdSync();
    if (lane < DRAPE_PATCH_WIDTH)
    {
        __local CullVolume* volume = alone ? &walkers->m_joined : walkers->m_volumes + lane;
        CullCorners corners;
        float least = 0.0f;
        const int near = clothRadius >= 0.0f &&
                         !(motion && thicknessWith(cloths, walk->m_cloth, motion->m_mesh) < 0.0f) &&
                         cullCorners(&corners, &least, motion, view->m_triangles + walk->m_cloth, view->m_start,
                                     view->m_end, clothRadius, view->m_mode) &&
                         cullMeets(&corners, clothRadius, motion);
        if (!alone)
        {
            DRAPE_UNROLL
            for (uint i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
                storeInterval(volume, &corners, near, i);
        }
        else if (lane < DRAPE_DOP_DIRECTIONS)
            storeInterval(volume, &corners, near, lane);
        if (!alone || lane == 0)
        {
            volume->m_radius = near ? clothRadius : 0.0f;
            volume->m_least = near ? least : 0.0f;
        }
    }
    simdSync();
    if (!alone) joinVolumes(walkers);
    simdSync();
}

#include "broad_phase_views.h"

// Lists the pairs of values.m_packet cloth triangles, in leaf order, per group: 1 or DRAPE_PATCH_WIDTH, with as many
// lanes or up to DRAPE_WALK_NODES times as many. The list has no particular order. counters->m_patchPairs and
// m_invalidNodes must be zero before.
__kernel void patchWalk(DRAPE_PATCH_WALK)
{
    __local Walkers walkers;
    const StepCloths step = stepCloths(&values, nodes, cloths, radius, thickness, motions);
    const PackedPatches packed = patchesAt(patches, &values.m_patches);
    const TestList pairs = {list, values.m_pairCapacity, values.m_pairLimit, &counters->m_patchPairs};
    const uint group = get_group_id(0), lane = simdLane() % DRAPE_PATCH_WIDTH, count = step.m_count;
    const uint leaf = values.m_packet == 1 ? group : group * values.m_packet + lane;
    Walk walk;
    walk.m_packet = values.m_packet;
    walk.m_cloth = step.m_order[min(leaf, count - 1)];
    const float clothRadius = leaf < count ? radius[step.m_cloth.m_triangles[walk.m_cloth].m_mesh] : -1.0f;
    // The last lanes run this while the first make volumes.
    if (clothRadius >= 0.0f && simdLane() >= simdWidth() - walk.m_packet) countInvalid(&step, walk.m_cloth, counters);
    if (simdLane() == 0) walkers.m_foundCount = 0;
    simdStart(&walkers.m_group);
    for (walk.m_motion = 0; walk.m_motion <= step.m_motionCount && walkers.m_group.m_index <= pairs.m_limit;
         ++walk.m_motion)
    {
        makeVolumes(&walkers, &walk, &step, clothRadius);
        walkTree(&walkers, &walk, &step, &packed, &pairs);
    }
    simdFlush(&walkers.m_group, &pairs);
}
