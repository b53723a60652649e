// Broad phase of cloths with themselves, over patches of the cloths' own triangles: their volumes and the boxes of their
// features, then every patch against those from itself on in order. What is left are pairs of features whose volumes over the
// step overlap, each once.
#include "lib/patch_pairs.h"
#include "lib/self_contact.h"
#include "lib/self_cull.h"

#define DRAPE_WALK_STACK (DRAPE_LEVELS * DRAPE_PATCH_WIDTH)
// Pairs whose boxes overlap are tried when there are DRAPE_SETTLE of them; until the next look at their number come three
// blocks at most.
#define DRAPE_SETTLE (3 * DRAPE_PATCH_WIDTH)
#define DRAPE_NEAR (DRAPE_SETTLE + 3 * DRAPE_PATCH_WIDTH)
#define DRAPE_KIND_SHIFT 31

static void storeBox(__global float* restrict boxes, const uint lane, const FeatureBox box)
{
    __global float* out = boxes + (lane / DRAPE_PATCH_WIDTH) * DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH + lane % DRAPE_PATCH_WIDTH;
    for (int i = 0; i < 3; ++i)
    {
        out[i * DRAPE_PATCH_WIDTH] = box.m_low[i];
        out[(3 + i) * DRAPE_PATCH_WIDTH] = box.m_high[i];
    }
}

// Counts the invalid nodes that the triangle owns, of a cloth that the search for obstacles does not look at.
static void countInvalidNodes(__global const Triangle* triangle, __global const float* start, __global const float* end,
                              __global StepCounters* counters)
{
    for (int i = 0; i < 3; ++i)
    {
        if ((triangle->m_owned & DRAPE_OWNS_VERTEX(i)) && !nodeIsValid(start, end, triangle->m_vertices[i]))
            atomic_inc(&counters->m_invalidNodes);
    }
}

// A work-group of DRAPE_PATCH_WIDTH takes a patch, or one of the empty places behind patchCount: writes the boxes of its
// features and its volume, in the first level of the wide tree. Ids are those of the lanes' features, DRAPE_NO_FEATURE where
// there is none. start: the end's positions in a discrete step. radius: m, per cloth, half the reach, negative for cloths that
// do not collide with themselves; obstacleRadius: of the search for obstacles.
__kernel __attribute__((reqd_work_group_size(DRAPE_PATCH_WIDTH, 1, 1))) void selfPack(
    __global const Patch* restrict patches, const uint patchCount, __global const uint* restrict faceIds,
    __global const uint* restrict vertexIds, __global const uint* restrict edgeIds,
    __global const Triangle* restrict triangles, __global const Edge* restrict edges, __global const float* start,
    __global const float* end, __global const float* restrict radius, __global const float* restrict obstacleRadius,
    __global float* restrict faceBoxes, __global float* restrict vertexBoxes, __global float* restrict edgeBoxes,
    __global float* restrict wideNodes, __global StepCounters* restrict counters)
{
    __local float bounds[2 * DRAPE_DOP_DIRECTIONS * DRAPE_PATCH_WIDTH];
    const uint index = get_group_id(0), lane = get_local_id(0);
    const uint face = index < patchCount ? faceIds[index * DRAPE_PATCH_WIDTH + lane] : DRAPE_NO_FEATURE;
    Patch patch = {0, 0, 0, 0, 0};
    if (index < patchCount) patch = patches[index];
    const float grown = index < patchCount ? radius[patch.m_mesh] : -1.0f;
    Dop dop;
    dopClear(&dop);
    if (face != DRAPE_NO_FEATURE && grown >= 0.0f)
    {
        triangleVolume(&dop, triangles + face, start, end, grown);
        if (obstacleRadius[patch.m_mesh] < 0.0f) countInvalidNodes(triangles + face, start, end, counters);
    }
    FeatureBox box;
    for (int i = 0; i < 3; ++i)
    {
        box.m_low[i] = dop.m_low[i];
        box.m_high[i] = dop.m_high[i];
    }
    if (index < patchCount) storeBox(faceBoxes, index * DRAPE_PATCH_WIDTH + lane, box);
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        bounds[i * DRAPE_PATCH_WIDTH + lane] = dop.m_low[i];
        bounds[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH + lane] = dop.m_high[i];
    }
    for (uint block = patch.m_vertexBlock; block < patch.m_vertexBlock + patch.m_vertexBlocks; ++block)
    {
        const uint place = block * DRAPE_PATCH_WIDTH + lane, vertex = vertexIds[place];
        const int there = vertex != DRAPE_NO_FEATURE && grown >= 0.0f;
        storeBox(vertexBoxes, place, there ? nodeBox(start, end, vertex, grown) : emptyBox());
    }
    for (uint block = patch.m_edgeBlock; block < patch.m_edgeBlock + patch.m_edgeBlocks; ++block)
    {
        const uint place = block * DRAPE_PATCH_WIDTH + lane, edge = edgeIds[place];
        box = emptyBox();
        if (edge != DRAPE_NO_FEATURE && grown >= 0.0f)
            box = joinBoxes(nodeBox(start, end, edges[edge].m_vertices[0], grown),
                            nodeBox(start, end, edges[edge].m_vertices[1], grown));
        storeBox(edgeBoxes, place, box);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    __global float* out =
        wideNodes + (index / DRAPE_PATCH_WIDTH) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH + index % DRAPE_PATCH_WIDTH;
    for (uint row = lane; row < DRAPE_WIDE_NODE_FLOATS; row += DRAPE_PATCH_WIDTH)
    {
        const int isLow = row < DRAPE_DOP_DIRECTIONS, isHigh = !isLow && row < 2 * DRAPE_DOP_DIRECTIONS;
        float bound = isLow ? DRAPE_INFINITY : isHigh ? -DRAPE_INFINITY : 0.0f;
        for (uint i = 0; i < DRAPE_PATCH_WIDTH && (isLow || isHigh); ++i)
        {
            const float own = bounds[row * DRAPE_PATCH_WIDTH + i];
            bound = isLow ? drapeMin(bound, own) : drapeMax(bound, own);
        }
        out[row * DRAPE_PATCH_WIDTH] = bound;
    }
}

// The cloths of a step and their packed features.
typedef struct SelfCloths
{
    __global const Triangle* m_triangles;
    __global const Edge* m_edges;
    __global const float* m_start;
    __global const float* m_end;
    __global const Patch* m_patches;
    __global const uint* m_faceIds;
    __global const uint* m_vertexIds;
    __global const uint* m_edgeIds;
    __global const float* m_faceBoxes;
    __global const float* m_vertexBoxes;
    __global const float* m_edgeBoxes;
    __global const float* m_nodes;  // of the wide tree
    __global const uint* m_levels;
    uint m_levelCount;
    float m_radius, m_thickness;  // m, of the cloth at hand
} SelfCloths;

// What a team shares.
typedef struct SelfTeam
{
    Team m_team;
    uint m_stack[DRAPE_WALK_STACK];
    uint m_found[DRAPE_PATCH_WIDTH];
    uint m_foundCount;
    uint m_bits;
    uint m_nearA[DRAPE_NEAR], m_nearB[DRAPE_NEAR];  // pairs of features, kind above the second
    uint m_nearCount;
} SelfTeam;

// A mask that the lanes have, as bits that all of them see; by all lanes together.
static uint sharedBits(DRAPE_TEAM SelfTeam* self, const LaneMask mask)
{
#if DRAPE_LANES > 1
    return laneBits(mask);
#else
    teamSync();
    if (teamLane() == 0) self->m_bits = 0;
    teamSync();
    if (mask) atomic_or(&self->m_bits, 1u << teamLane());
    teamSync();
    return self->m_bits;
#endif
}

// Notes a pair of features whose boxes overlap.
static void noteNear(DRAPE_TEAM SelfTeam* self, const uint a, const uint b, const uint kind)
{
    const uint slot = teamAdd(self->m_nearCount);
    self->m_nearA[slot] = a;
    self->m_nearB[slot] = b | (kind << DRAPE_KIND_SHIFT);
}

// Lists a pair whose boxes overlap if the features share no vertex and their volumes overlap.
static void tryPair(DRAPE_TEAM SelfTeam* self, const SelfCloths* cloths, const uint a, const uint b, const uint kind,
                    const TestList* list)
{
    const int edges = kind == DRAPE_SELF_TEST_EDGE;
    uint nodes[4];
    if (edges)
    {
        const Edge e = cloths->m_edges[a], o = cloths->m_edges[b];
        nodes[0] = e.m_vertices[0];
        nodes[1] = e.m_vertices[1];
        nodes[2] = o.m_vertices[0];
        nodes[3] = o.m_vertices[1];
    }
    else
    {
        nodes[0] = a;
        for (int i = 0; i < 3; ++i) nodes[1 + i] = cloths->m_triangles[b].m_vertices[i];
    }
    // Two nodes of a feature differ.
    if (nodes[0] == nodes[1] || nodes[0] == nodes[2] || nodes[0] == nodes[3] || nodes[1] == nodes[2] || nodes[1] == nodes[3])
        return;
    if (!nodeVolumesOverlap(cloths->m_start, cloths->m_end, nodes, edges ? 2 : 1, cloths->m_radius)) return;
    FeatureTest test;
    test.m_cloth = a;
    test.m_lane = b;
    test.m_reach = cloths->m_thickness;
    test.m_motion = kind;
    teamKeep(&self->m_team, list, test);
}

// Tries the pairs noted, where there are `least` of them, a lane each: few of the lanes that look at boxes find one at a time.
// By all lanes together; returns whether the list is within its limit.
static int settleNear(DRAPE_TEAM SelfTeam* self, const SelfCloths* cloths, const TestList* list, const uint least)
{
    teamSync();
    const uint count = self->m_nearCount;
    teamSync();
    if (count < least) return 1;
    int within = 1;
    for (uint first = 0; first < count && within; first += DRAPE_PATCH_WIDTH)
    {
        const uint last = min(count, first + DRAPE_PATCH_WIDTH);
        for (uint i = first + teamLane(); i < last; i += teamWidth())
        {
            const uint b = self->m_nearB[i];
            tryPair(self, cloths, self->m_nearA[i], b & ((1u << DRAPE_KIND_SHIFT) - 1u), b >> DRAPE_KIND_SHIFT, list);
        }
        within = teamMakeRoom(&self->m_team, list);
    }
    if (teamLane() == 0) self->m_nearCount = 0;
    teamSync();
    return within;
}

// Triangle `place` of patch `own` against the features of patch `other`, which is not before it. Within a patch every node
// meets every face from the node's side, and of two edges the one with the lesser index looks for the other. Returns whether
// the list is within its limit. box: of that patch.
static int pairTriangle(DRAPE_TEAM SelfTeam* self, const SelfCloths* cloths, const uint own, const uint place,
                        const uint other, const FeatureBox* box, const TestList* list)
{
    const uint face = cloths->m_faceIds[own * DRAPE_PATCH_WIDTH + place];
    const Triangle triangle = cloths->m_triangles[face];
    const Patch patch = cloths->m_patches[other];
    FeatureBox corner[3];
    for (int k = 0; k < 3; ++k)
        corner[k] = nodeBox(cloths->m_start, cloths->m_end, triangle.m_vertices[k], cloths->m_radius);
    const BoxLanes faces = loadBoxes(cloths->m_faceBoxes + other * DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH);
    for (int k = 0; k < 3; ++k)
    {
        if (!(triangle.m_owned & DRAPE_OWNS_VERTEX(k)) || !boxesMeet(&corner[k], box)) continue;
        const LaneMask mask = boxesOverlap(&faces, &corner[k]);
        forLanes(lane, mask) noteNear(self, triangle.m_vertices[k], cloths->m_faceIds[other * DRAPE_PATCH_WIDTH + lane],
                                      DRAPE_SELF_TEST_NODE);
    }
    if (!settleNear(self, cloths, list, DRAPE_SETTLE)) return 0;
    const FeatureBox whole = joinBoxes(joinBoxes(corner[0], corner[1]), corner[2]);
    for (uint block = patch.m_vertexBlock; own != other && block < patch.m_vertexBlock + patch.m_vertexBlocks; ++block)
    {
        const BoxLanes vertices = loadBoxes(cloths->m_vertexBoxes + block * DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH);
        const LaneMask mask = boxesOverlap(&vertices, &whole);
        forLanes(lane, mask)
            noteNear(self, cloths->m_vertexIds[block * DRAPE_PATCH_WIDTH + lane], face, DRAPE_SELF_TEST_NODE);
        if (!settleNear(self, cloths, list, DRAPE_SETTLE)) return 0;
    }
    FeatureBox edgeBox[3];
    int near[3];  // edges that may come near the patch
    for (int k = 0; k < 3; ++k)
    {
        edgeBox[k] = joinBoxes(corner[k], corner[k == 2 ? 0 : k + 1]);
        near[k] = (triangle.m_owned & DRAPE_OWNS_EDGE(k)) && boxesMeet(&edgeBox[k], box);
    }
    if (!near[0] && !near[1] && !near[2]) return 1;
    for (uint block = patch.m_edgeBlock; block < patch.m_edgeBlock + patch.m_edgeBlocks; ++block)
    {
        const BoxLanes edges = loadBoxes(cloths->m_edgeBoxes + block * DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH);
        for (int k = 0; k < 3; ++k)
        {
            if (!near[k]) continue;
            const LaneMask mask = boxesOverlap(&edges, &edgeBox[k]);
            forLanes(lane, mask)
            {
                const uint edge = cloths->m_edgeIds[block * DRAPE_PATCH_WIDTH + lane], mine = triangle.m_edges[k];
                if (own != other || mine < edge) noteNear(self, min(mine, edge), max(mine, edge), DRAPE_SELF_TEST_EDGE);
            }
        }
        if (!settleNear(self, cloths, list, DRAPE_SETTLE)) return 0;
    }
    return 1;
}

// Returns whether the list is within its limit.
static int pairPatches(DRAPE_TEAM SelfTeam* self, const SelfCloths* cloths, const uint own, const uint other,
                       const TestList* list)
{
    __global const float* volume = cloths->m_nodes +
                                   (other / DRAPE_PATCH_WIDTH) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH +
                                   other % DRAPE_PATCH_WIDTH;
    FeatureBox box;
    for (int i = 0; i < 3; ++i)
    {
        box.m_low[i] = volume[i * DRAPE_PATCH_WIDTH];
        box.m_high[i] = volume[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH];
    }
    const BoxLanes faces = loadBoxes(cloths->m_faceBoxes + own * DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH);
    uint near = sharedBits(self, boxesOverlap(&faces, &box));
    for (; near; near &= near - 1)
    {
        if (!pairTriangle(self, cloths, own, 31 - clz(near & -near), other, &box, list)) return 0;
    }
    return 1;
}

static void walkSelf(DRAPE_TEAM SelfTeam* self, const SelfCloths* cloths, const uint own, const TestList* list)
{
    DRAPE_TEAM Team* team = &self->m_team;
    __global const float* child =
        cloths->m_nodes + (own / DRAPE_PATCH_WIDTH) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH + own % DRAPE_PATCH_WIDTH;
    Dop volume;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        volume.m_low[i] = child[i * DRAPE_PATCH_WIDTH];
        volume.m_high[i] = child[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH];
    }
    if (teamLane() == 0)
    {
        self->m_stack[0] = cloths->m_levelCount << DRAPE_LEVEL_SHIFT;
        team->m_depth = 1;
    }
    teamSync();
    while (team->m_depth > 0)
    {
        const uint depth = team->m_depth;
        const uint entry = self->m_stack[depth - 1];
        const uint level = entry >> DRAPE_LEVEL_SHIFT, index = entry & ((1u << DRAPE_LEVEL_SHIFT) - 1u);
        teamSync();
        if (teamLane() == 0)
        {
            team->m_depth = depth - 1;
            self->m_foundCount = 0;
        }
        teamSync();
        uint below = 1;  // patches under a child
        for (uint i = 1; i < level; ++i) below *= DRAPE_PATCH_WIDTH;
        const LaneMask near = wideOverlaps(
            &volume, cloths->m_nodes + (cloths->m_levels[level - 1] + index) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH);
        forLanes(lane, near)
        {
            const uint next = index * DRAPE_PATCH_WIDTH + lane;
            if ((next + 1) * below <= own) continue;  // patches before this one look for it
            if (level > 1)
                self->m_stack[teamAdd(team->m_depth)] = ((level - 1) << DRAPE_LEVEL_SHIFT) + next;
            else
                self->m_found[teamAdd(self->m_foundCount)] = next;
        }
        teamSync();
        const uint found = self->m_foundCount;
        for (uint i = 0; i < found; ++i)
        {
            const uint other = self->m_found[i];
            if (cloths->m_patches[other].m_mesh != cloths->m_patches[own].m_mesh) continue;
            if (!pairPatches(self, cloths, own, other, list)) return;
        }
        teamSync();
    }
}

// A team (see lib/team.h) takes a patch: lists the self tests of its features and those of the patches from it on. The tree's
// volumes are those that selfPack wrote and patchWiden joined. limit: see team.h; counters->m_selfTests must be zero before.
__kernel void selfCull(__global const Patch* restrict patches, const uint patchCount, __global const uint* restrict faceIds,
                       __global const uint* restrict vertexIds, __global const uint* restrict edgeIds,
                       __global const Triangle* restrict triangles, __global const Edge* restrict edges,
                       __global const float* start, __global const float* end, __global const float* restrict radius,
                       __global const float* restrict thickness, __global const float* restrict faceBoxes,
                       __global const float* restrict vertexBoxes, __global const float* restrict edgeBoxes,
                       __global const float* restrict wideNodes, __global const uint* restrict levels,
                       const uint levelCount, __global FeatureTest* restrict list, const uint capacity, const uint limit,
                       __global StepCounters* restrict counters)
{
#if DRAPE_LANES > 1
    const uint own = get_global_id(0);
    SelfTeam self;
#else
    const uint own = get_group_id(0);
    __local SelfTeam self;
#endif
    if (own >= patchCount) return;
    const uint mesh = patches[own].m_mesh;
    if (radius[mesh] < 0.0f) return;
    const SelfCloths cloths = {triangles, edges, start, end, patches, faceIds, vertexIds, edgeIds, faceBoxes, vertexBoxes,
                               edgeBoxes, wideNodes, levels, levelCount, radius[mesh], thickness[mesh]};
    const TestList tests = {list, capacity, limit, &counters->m_selfTests};
    if (teamLane() == 0) self.m_nearCount = 0;
    teamStart(&self.m_team);
    walkSelf(&self, &cloths, own, &tests);
    settleNear(&self, &cloths, &tests, 1);
    teamFlush(&self.m_team, &tests);
}
