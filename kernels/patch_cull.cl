// Broad phase over patches: every cloth triangle walks the wide tree of the obstacles' patches, tests the features of those
// it may touch a block of lanes at a time, and lists the feature tests that are left.
//
// A team does this for one cloth triangle: one work-item with vectors of lanes (DRAPE_LANES 8 or 16), or one work-group whose
// work-items are the lanes (DRAPE_LANES 1). Which of the two is a build option; the text is the same.
#include "lib/dop.h"
#include "lib/feature_cull.h"
#include "lib/rigid_motion.h"

// Levels of the wide tree over 2^28 triangles, each of which can leave all but one of a node's children on the stack.
#define DRAPE_TEAM_STACK (10 * DRAPE_PATCH_WIDTH)
// Feature tests gathered before room is reserved for them with one atomic.
#define DRAPE_TEAM_KEPT (4 * DRAPE_PATCH_WIDTH)
// Stack entries: level in the high bits, 0 for a patch.
#define DRAPE_LEVEL_SHIFT 28

typedef struct Team
{
    uint m_stack[DRAPE_TEAM_STACK];
    uint m_depth;
    FeatureTest m_kept[DRAPE_TEAM_KEPT];
    uint m_keptCount;
    uint m_place;
} Team;

#if DRAPE_LANES > 1
#define DRAPE_TEAM
#define teamIndex() get_global_id(0)
#define teamLane() 0
#define teamWidth() 1
#define teamSync()

// Bit i: lane i's mask.
static uint laneBits(const LaneMask mask)
{
#if DRAPE_LANES == 16
    const int16 all = mask & (int16)(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768);
    const int8 half8 = all.lo | all.hi;
#else
    const int8 half8 = mask & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
#endif
    const int4 half4 = half8.lo | half8.hi;
    const int2 half2 = half4.lo | half4.hi;
    return (uint)(half2.lo | half2.hi);
}

#define forLanes(lane, mask) \
    for (uint bits = laneBits(mask), lane = 31 - clz(bits & -bits); bits; bits &= bits - 1, lane = 31 - clz(bits & -bits))
#define teamAdd(counter) ((counter)++)
#else
#define DRAPE_TEAM __local
#define teamIndex() get_group_id(0)
#define teamLane() get_local_id(0)
#define teamWidth() DRAPE_PATCH_WIDTH
#define teamSync() barrier(CLK_LOCAL_MEM_FENCE)
#define forLanes(lane, mask) for (uint lane = get_local_id(0), once = (mask) != 0; once; once = 0)
#define teamAdd(counter) atomic_inc(&(counter))
#endif

typedef struct TestList
{
    __global FeatureTest* m_tests;
    uint m_capacity, m_limit;
    __global StepCounters* m_counters;
    uint m_motion;  // of the tests that are being kept
} TestList;

// Moves what the team kept to the list. The demand counts on past the capacity; what does not fit is not written, and the
// host repeats the step with a larger list. Past the limit the team ends: the step is over it whatever follows, and a count
// that ran on could wrap around.
static void teamFlush(DRAPE_TEAM Team* team, const TestList* list)
{
    teamSync();
    const uint count = team->m_keptCount;
    if (teamLane() == 0)
    {
        team->m_place = atomic_add(&list->m_counters->m_candidates, count);
        if (team->m_place > list->m_limit) team->m_depth = 0;
    }
    teamSync();
    const uint place = team->m_place;
    for (uint i = teamLane(); i < count; i += teamWidth())
    {
        if (place + i < list->m_capacity) list->m_tests[place + i] = team->m_kept[i];
    }
    teamSync();
    if (teamLane() == 0) team->m_keptCount = 0;
    teamSync();
}

// Keeps the lanes' tests. first: lane 0 of the block.
static void teamKeep(DRAPE_TEAM Team* team, const LaneMask mask, const uint cloth, const uint test, const uint first, const float reach,
                     const TestList* list)
{
    teamSync();
    const uint count = team->m_keptCount;
    teamSync();
    if (count > DRAPE_TEAM_KEPT - DRAPE_PATCH_WIDTH) teamFlush(team, list);
    forLanes(lane, mask)
    {
        FeatureTest kept;
        kept.m_cloth = cloth | (test << DRAPE_TEST_SHIFT);
        kept.m_lane = first + lane;
        kept.m_reach = reach;
        kept.m_motion = list->m_motion;
        team->m_kept[teamAdd(team->m_keptCount)] = kept;
    }
}

// The lanes of a wide node whose volumes are not proved separate from the triangle's.
static LaneMask wideOverlap(__global const float* restrict node, const Dop* dop)
{
    LaneMask overlap = (lanesLoad(node, 0) <= lanesSplat(dop->m_high[0])) &
                       (lanesLoad(node, DRAPE_DOP_DIRECTIONS) >= lanesSplat(dop->m_low[0]));
    for (int i = 1; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        overlap &= (lanesLoad(node, i) <= lanesSplat(dop->m_high[i])) &
                   (lanesLoad(node, DRAPE_DOP_DIRECTIONS + i) >= lanesSplat(dop->m_low[i]));
    }
    return overlap;
}

typedef struct PatchArrays
{
    __global const float* m_wideNodes;
    __global const uint* m_levels;  // first node of each level of the wide tree, lowest first
    uint m_levelCount;
    __global const Patch* m_patches;
    __global const float* m_sizes;
    __global const float* m_faces;
    __global const float* m_vertices;
    __global const float* m_edges;
} PatchArrays;

// The feature tests of one cloth triangle and one patch.
static void cullPatch(DRAPE_TEAM Team* team, const PatchArrays* arrays, const uint index, const CullTriangle* cull,
                      const CullReach reach, const float contactReach,
                      const uint cloth, const uint triangleOwned, const uint valid, const TestList* list)
{
    __global const Patch* patch = arrays->m_patches + index;
    const uint owned = triangleOwned & valid;
    for (int i = 0; i < 3; ++i)
    {
        if (!(owned & DRAPE_OWNS_VERTEX(i))) continue;
        const LaneMask mask =
            cullNodeFace(cull, i, reach, arrays->m_faces + index * DRAPE_FACE_FLOATS * DRAPE_PATCH_WIDTH);
        teamKeep(team, mask, cloth, DRAPE_TEST_NODE + i, index * DRAPE_PATCH_WIDTH, contactReach, list);
    }
    for (uint block = patch->m_vertexBlock;
         valid == DRAPE_ALL_FEATURES && block < patch->m_vertexBlock + patch->m_vertexBlocks; ++block)
    {
        const LaneMask mask =
            cullFaceVertex(cull, reach, arrays->m_vertices + block * DRAPE_VERTEX_FLOATS * DRAPE_PATCH_WIDTH);
        teamKeep(team, mask, cloth, DRAPE_TEST_FACE, block * DRAPE_PATCH_WIDTH, contactReach, list);
    }
    if (!(owned & (DRAPE_OWNS_EDGE(0) | DRAPE_OWNS_EDGE(1) | DRAPE_OWNS_EDGE(2)))) return;
    for (uint block = patch->m_edgeBlock; block < patch->m_edgeBlock + patch->m_edgeBlocks; ++block)
    {
        const CullEdges edges = loadCullEdges(cull, arrays->m_edges + block * DRAPE_EDGE_FLOATS * DRAPE_PATCH_WIDTH);
        for (int i = 0; i < 3; ++i)
        {
            if (!(owned & DRAPE_OWNS_EDGE(i))) continue;
            const LaneMask mask = cullEdgeEdge(cull, i, reach, &edges);
            teamKeep(team, mask, cloth, DRAPE_TEST_EDGE + i, block * DRAPE_PATCH_WIDTH, contactReach, list);
        }
    }
}

static void countInvalid(__global const Triangle* triangle, __global const float* restrict start,
                         __global const float* restrict end, __global StepCounters* restrict counters)
{
    for (int i = 0; i < 3; ++i)
    {
        const uint vertex = triangle->m_vertices[i];
        if ((triangle->m_owned & DRAPE_OWNS_VERTEX(i)) &&
            !(positionIsValid(vec3Load(start, vertex)) && positionIsValid(vec3Load(end, vertex))))
        {
            atomic_inc(&counters->m_invalidNodes);
        }
    }
}

// A cloth triangle's walk: over the obstacles that rest, or over one that moves.
typedef struct Walk
{
    __global const float* m_start;
    __global const float* m_end;
    __global const Triangle* m_triangle;
    uint m_cloth;
    __global const float* m_thickness;  // of its cloth, per obstacle
    float m_reachScale;
    uint m_mode;
    __global const ObstacleMotion* m_motions;
    uint m_motionCount;
    __global const ObstacleMotion* m_motion;  // null for those that rest
} Walk;

// Lists the tests of the walk's obstacles. dop: the triangle's volume as they see it.
static void teamWalk(DRAPE_TEAM Team* team, const PatchArrays* arrays, const Walk* walk, const Dop* dop, const TestList* list)
{
    CullTriangle cull;
    uint valid = 0;
    teamSync();
    if (teamLane() == 0)
    {
        team->m_stack[0] = arrays->m_levelCount << DRAPE_LEVEL_SHIFT;
        team->m_depth = 1;
    }
    teamSync();
    while (team->m_depth > 0)
    {
        const uint entry = team->m_stack[team->m_depth - 1];
        teamSync();
        if (teamLane() == 0) --team->m_depth;
        teamSync();
        const uint level = entry >> DRAPE_LEVEL_SHIFT, index = entry & ((1u << DRAPE_LEVEL_SHIFT) - 1u);
        if (level == 0)
        {
            const uint mesh = arrays->m_patches[index].m_mesh;
            const float pairThickness = walk->m_thickness[mesh];
            if (pairThickness < 0.0f || findMotion(walk->m_motions, walk->m_motionCount, mesh) != walk->m_motion) continue;
            if (valid == 0) valid = prepareCull(&cull, walk->m_start, walk->m_end, walk->m_triangle, walk->m_mode, walk->m_motion);
            const float contactReach = pairThickness * walk->m_reachScale;
            const CullReach reach = cullReach(&cull, contactReach, arrays->m_sizes[index], walk->m_mode);
            cullPatch(team, arrays, index, &cull, reach, contactReach, walk->m_cloth, walk->m_triangle->m_owned, valid, list);
            continue;
        }
        const uint node = arrays->m_levels[level - 1] + index;
        const LaneMask overlap =
            wideOverlap(arrays->m_wideNodes + node * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH, dop);
        const uint children = ((level - 1) << DRAPE_LEVEL_SHIFT) + index * DRAPE_PATCH_WIDTH;
        forLanes(lane, overlap)
        {
            team->m_stack[teamAdd(team->m_depth)] = children + lane;
        }
        teamSync();
    }
}

// A team takes one cloth triangle, in leaf order. levels holds the first node of each of levelCount levels of the wide tree,
// lowest first. mode: DRAPE_DISCRETE …. radius: m, per cloth; thickness: cloths × obstacles, negative where the pair is not
// tested. motions: of the obstacles that move in the step. counters' candidates and invalid nodes must be zero before; the
// atomic reserves disjoint ranges, whose order does not matter.
__kernel void patchCull(__global const uint* restrict clothOrder, __global const Triangle* restrict clothTriangles,
                        const uint clothCount, __global const float* restrict start, __global const float* restrict end,
                        __global const float* restrict radius, __global const float* restrict wideNodes,
                        __global const uint* restrict levels, const uint levelCount, __global const Patch* restrict patches,
                        __global const float* restrict patchSizes, __global const float* restrict faces,
                        __global const float* restrict vertices, __global const float* restrict edges,
                        __global const float* restrict thickness,
                        const uint obstacleMeshes, const float reachScale, const uint mode,
                        __global const ObstacleMotion* restrict motions, const uint motionCount,
                        __global FeatureTest* restrict tests,
                        const uint capacity, const uint limit, __global StepCounters* restrict counters)
{
#if DRAPE_LANES > 1
    Team space;
#else
    __local Team space;
#endif
    DRAPE_TEAM Team* team = &space;
    const uint leaf = teamIndex();
    if (leaf >= clothCount) return;
    const uint cloth = clothOrder[leaf];
    __global const Triangle* triangle = clothTriangles + cloth;
    const float clothRadius = radius[triangle->m_mesh];
    if (clothRadius < 0.0f) return;
    if (teamLane() == 0)
    {
        countInvalid(triangle, start, end, counters);
        team->m_keptCount = 0;
        team->m_place = 0;
    }
    const PatchArrays arrays = {wideNodes, levels, levelCount, patches, patchSizes, faces, vertices, edges};
    TestList list = {tests, capacity, limit, counters, 0};  // those that rest first
    Walk walk = {start, end, triangle, cloth, thickness + triangle->m_mesh * obstacleMeshes, reachScale, mode, motions,
                 motionCount, 0};
    for (; list.m_motion <= motionCount; ++list.m_motion)
    {
        teamSync();
        if (team->m_place > limit) break;
        walk.m_motion = list.m_motion == 0 ? 0 : motions + (list.m_motion - 1);
        if (walk.m_motion && walk.m_thickness[walk.m_motion->m_mesh] < 0.0f) continue;
        Dop dop;
        if (!volumeSeen(&dop, walk.m_motion, triangle, start, end, clothRadius, mode)) continue;
        teamWalk(team, &arrays, &walk, &dop, &list);
    }
    teamFlush(team, &list);
}

// Packing, when an obstacle came or moved: positions that are invalid become NaN. A work-item is a lane of a face block, of
// those from first up to last.
static Vec3 packedPosition(__global const float* restrict positions, const uint vertex, const int used)
{
    const Vec3 none = vec3(NAN, NAN, NAN);
    if (!used) return none;
    const Vec3 p = vec3Load(positions, vertex);
    return positionIsValid(p) ? p : none;
}

static void packVec3(__global float* restrict out, const uint first, const Vec3 v)
{
    out[first * DRAPE_PATCH_WIDTH] = v.x;
    out[(first + 1) * DRAPE_PATCH_WIDTH] = v.y;
    out[(first + 2) * DRAPE_PATCH_WIDTH] = v.z;
}

__kernel void patchPackFaces(__global const uint* restrict owners, const uint first, const uint last,
                             __global const Triangle* restrict triangles, __global const float* restrict positions,
                             __global const float* restrict spreads, __global float* restrict faces)
{
    const uint i = first + get_global_id(0);
    if (i >= last) return;
    const int used = owners[i] != DRAPE_NO_FEATURE;
    const uint owner = used ? owners[i] : 0;
    __global float* out = faces + (i / DRAPE_PATCH_WIDTH) * DRAPE_FACE_FLOATS * DRAPE_PATCH_WIDTH + i % DRAPE_PATCH_WIDTH;
    for (int k = 0; k < 3; ++k) packVec3(out, 3 * k, packedPosition(positions, triangles[owner].m_vertices[k], used));
    out[9 * DRAPE_PATCH_WIDTH] = used ? spreads[owner] : 0.0f;
}

// A work-item is a lane of a vertex block. ids: the vertex of each lane.
__kernel void patchPackVertices(__global const uint* restrict owners, const uint first, const uint last,
                                __global const Triangle* restrict triangles, __global const float* restrict positions,
                                __global const NormalCone* restrict cones, __global float* restrict vertices,
                                __global uint* restrict ids)
{
    const uint i = first + get_global_id(0);
    if (i >= last) return;
    __global float* out =
        vertices + (i / DRAPE_PATCH_WIDTH) * DRAPE_VERTEX_FLOATS * DRAPE_PATCH_WIDTH + i % DRAPE_PATCH_WIDTH;
    const uint owner = owners[i] & ((1u << DRAPE_PLACE_SHIFT) - 1u), place = owners[i] >> DRAPE_PLACE_SHIFT;
    const int used = owners[i] != DRAPE_NO_FEATURE;
    const uint vertex = used ? triangles[owner].m_vertices[place] : 0;
    ids[i] = vertex;
    packVec3(out, 0, packedPosition(positions, vertex, used));
    packVec3(out, 3, cones[vertex].m_axis);
    out[6 * DRAPE_PATCH_WIDTH] = cones[vertex].m_cosine;
}

// A work-item is a lane of an edge block. ids: the edge of each lane.
__kernel void patchPackEdges(__global const uint* restrict owners, const uint first, const uint last,
                             __global const Triangle* restrict triangles, __global const float* restrict positions,
                             __global const NormalCone* restrict cones, __global float* restrict edges,
                             __global uint* restrict ids)
{
    const uint i = first + get_global_id(0);
    if (i >= last) return;
    __global float* out = edges + (i / DRAPE_PATCH_WIDTH) * DRAPE_EDGE_FLOATS * DRAPE_PATCH_WIDTH + i % DRAPE_PATCH_WIDTH;
    const int used = owners[i] != DRAPE_NO_FEATURE;
    const uint owner = used ? owners[i] & ((1u << DRAPE_PLACE_SHIFT) - 1u) : 0;
    const uint place = used ? owners[i] >> DRAPE_PLACE_SHIFT : 0;
    const uint edge = triangles[owner].m_edges[place];
    ids[i] = edge;
    packVec3(out, 0, packedPosition(positions, triangles[owner].m_vertices[place], used));
    packVec3(out, 3, packedPosition(positions, triangles[owner].m_vertices[place == 2 ? 0 : place + 1], used));
    packVec3(out, 6, cones[edge].m_axis);
    out[9 * DRAPE_PATCH_WIDTH] = cones[edge].m_cosine;
}

static void wideStore(__global float* restrict wideNodes, const uint child, const Dop* dop)
{
    __global float* out = wideNodes + (child / DRAPE_PATCH_WIDTH) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH +
                          child % DRAPE_PATCH_WIDTH;
    for (int k = 0; k < DRAPE_DOP_DIRECTIONS; ++k)
    {
        out[k * DRAPE_PATCH_WIDTH] = dop->m_low[k];
        out[(DRAPE_DOP_DIRECTIONS + k) * DRAPE_PATCH_WIDTH] = dop->m_high[k];
    }
}

// A work-item is a child place of the wide tree's lowest level, of those from first up to last: a patch, or none from patchCount on. Writes its volume and its
// size, m.
__kernel void patchVolumes(__global const uint* restrict faceOwners, const uint patchCount, const uint first, const uint last,
                           __global const Triangle* restrict triangles, __global const float* restrict positions,
                           __global float* restrict wideNodes, __global float* restrict patchSizes)
{
    const uint patch = first + get_global_id(0);
    if (patch >= last) return;
    Dop dop;
    dopClear(&dop);
    for (uint lane = 0; lane < DRAPE_PATCH_WIDTH && patch < patchCount; ++lane)
    {
        const uint owner = faceOwners[patch * DRAPE_PATCH_WIDTH + lane];
        if (owner == DRAPE_NO_FEATURE) break;
        Dop one;
        triangleVolume(&one, triangles + owner, positions, positions, 0.0f);
        for (int k = 0; k < DRAPE_DOP_DIRECTIONS; ++k)
        {
            dop.m_low[k] = drapeMin(dop.m_low[k], one.m_low[k]);
            dop.m_high[k] = drapeMax(dop.m_high[k], one.m_high[k]);
        }
    }
    wideStore(wideNodes, patch, &dop);
    if (patch >= patchCount) return;
    float size = 0.0f;
    for (int k = 0; k < 3; ++k) size += drapeMax(dop.m_high[k] - dop.m_low[k], 0.0f);
    patchSizes[patch] = size;
}

// A work-item is a child place of one level: a node of the level below, or none from nodeCount on. below and level: that
// level's nodes and this one's.
__kernel void patchWiden(__global float* restrict wideNodes, const uint below, const uint nodeCount, const uint level,
                         const uint first, const uint last)
{
    const uint node = first + get_global_id(0);
    if (node >= last) return;
    Dop dop;
    dopClear(&dop);
    __global const float* lanes = wideNodes + (below + node) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH;
    for (uint lane = 0; lane < DRAPE_PATCH_WIDTH && node < nodeCount; ++lane)
    {
        for (int k = 0; k < DRAPE_DOP_DIRECTIONS; ++k)
        {
            dop.m_low[k] = drapeMin(dop.m_low[k], lanes[k * DRAPE_PATCH_WIDTH + lane]);
            dop.m_high[k] = drapeMax(dop.m_high[k], lanes[(DRAPE_DOP_DIRECTIONS + k) * DRAPE_PATCH_WIDTH + lane]);
        }
    }
    wideStore(wideNodes + level * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH, node, &dop);
}
