// Broad phase over patches on a CPU. Packets of neighbouring cloth triangles traverse the wide tree of the obstacles'
// patches with their joint volume. For each patch found, the packet's triangles are tested: their nodes and edges
// that may be near the patch, and their faces, against the patch's features, a vector of lanes at a time. The
// remaining feature tests are listed.
#include "../lib/broad_phase/cull_packet.h"
#include "../lib/broad_phase/patch_pairs.h"

// Rows of the six corners of a packet's triangles, see cornersSeen(): one row of lanes for each x, y and z.
#define DRAPE_CORNER_ROWS 18

// A packet's traversal of the resting obstacles, or of one that moves.
typedef struct Packet
{
    uint m_cloth[DRAPE_LANES];    // triangles
    float m_radius[DRAPE_LANES];  // m, negative outside the step
    uint m_motion;
    CullVolumes m_volumes;
    CullVolume m_joined;
    float m_corners[DRAPE_CORNER_ROWS * DRAPE_LANES];  // corners from which the volumes are made
    CullQuery m_queries[DRAPE_LANES];
    NodeIntervals m_nodes[DRAPE_LANES];
    uint m_ready;  // bit i: whether query i and its nodes are ready
} Packet;

static void takeNodes(Packet* packet, const uint triangle)
{
    const Directions directions = directionLanes();
    Vec3 corners[6];
    for (int k = 0; k < 6; ++k)
    {
        const float* rows = packet->m_corners + 3 * k * DRAPE_LANES + triangle;
        corners[k] = vec3(rows[0], rows[DRAPE_LANES], rows[2 * DRAPE_LANES]);
    }
    nodeIntervals(packet->m_nodes + triangle, &directions, corners, laneOf(&packet->m_volumes.m_noise, triangle),
                  laneOf(&packet->m_volumes.m_rounding, triangle));
}

static const CullQuery* queryOf(Packet* packet, const StepCloths* cloths, const uint triangle)
{
    CullQuery* query = packet->m_queries + triangle;
    if (packet->m_ready >> triangle & 1u) return query;
    packet->m_ready |= 1u << triangle;
    makeQuery(query, cloths, packet->m_cloth[triangle], packet->m_motion);
    takeNodes(packet, triangle);
    return query;
}

// Returns the triangle's nodes and edges among `owned` that are not proved out of reach of a patch, bits as in
// Triangle::m_owned: the test of cullPacketChild() for features instead of triangles. volume: the patch's, as stored
// by patchVolumes of patch_pack.cl.
static uint featuresNear(const Packet* packet, const uint triangle, const uint owned, __global const float* volume)
{
    const NodeIntervals* nodes = packet->m_nodes + triangle;
    const Directions directions = directionLanes();
    const NearPatch patch =
        nearPatch(&directions, lanesLoad(volume, 0), lanesLoad(volume + DRAPE_DOP_DIRECTIONS, 0),
                  lanesLoad(volume + 2 * DRAPE_DOP_DIRECTIONS, 0), laneOf(&packet->m_volumes.m_radius, triangle),
                  laneOf(&packet->m_volumes.m_least, triangle));
    uint near = 0;
    DRAPE_UNROLL
    for (int k = 0; k < 3; ++k)
    {
        if ((owned & DRAPE_OWNS_VERTEX(k)) && !anyLane(nodeIsOut(nodes, k, patch))) near |= DRAPE_OWNS_VERTEX(k);
        if ((owned & DRAPE_OWNS_EDGE(k)) && !anyLane(edgeIsOut(nodes, k, patch))) near |= DRAPE_OWNS_EDGE(k);
    }
    return near;
}

// Lists the feature tests of a pair of cloth triangle and patch: tests of the triangle's nodes and edges among `own`
// (bits as in Triangle::m_owned), and of its face.
static void cullPatch(SimdGroup* group, const PackedPatches* patches, const FeatureTest pair, const CullQuery* query,
                      const CullReach reach, const uint own, const TestList* list)
{
    const uint index = pair.m_lane;
    __global const Patch* patch = patches->m_patches + index;
    const CullTriangle* cull = &query->m_cull;
    for (int i = 0; i < 3; ++i)
    {
        if (!(own & DRAPE_OWNS_VERTEX(i))) continue;
        const LaneMask mask =
            cullNodeFace(cull, i, reach, patches->m_faces + index * DRAPE_FACE_FLOATS * DRAPE_PATCH_WIDTH);
        keepLanes(group, mask, pair, DRAPE_TEST_NODE + i, index * DRAPE_PATCH_WIDTH, list);
    }
    for (uint block = patch->m_vertexBlock;
         query->m_valid == DRAPE_ALL_FEATURES && block < patch->m_vertexBlock + patch->m_vertexBlocks; ++block)
    {
        const LaneMask mask =
            cullFaceVertex(cull, reach, patches->m_vertices + block * DRAPE_VERTEX_FLOATS * DRAPE_PATCH_WIDTH);
        keepLanes(group, mask, pair, DRAPE_TEST_FACE, block * DRAPE_PATCH_WIDTH, list);
    }
    if (!(own & (DRAPE_OWNS_EDGE(0) | DRAPE_OWNS_EDGE(1) | DRAPE_OWNS_EDGE(2)))) return;
    for (uint block = patch->m_edgeBlock; block < patch->m_edgeBlock + patch->m_edgeBlocks; ++block)
    {
        const CullEdges edges = loadCullEdges(cull, patches->m_edges + block * DRAPE_EDGE_FLOATS * DRAPE_PATCH_WIDTH);
        for (int i = 0; i < 3; ++i)
        {
            if (!(own & DRAPE_OWNS_EDGE(i))) continue;
            const LaneMask mask = cullEdgeEdge(cull, i, reach, &edges);
            keepLanes(group, mask, pair, DRAPE_TEST_EDGE + i, block * DRAPE_PATCH_WIDTH, list);
        }
    }
}

static void visitPatch(SimdGroup* group, Packet* packet, const StepCloths* cloths, const PackedPatches* patches,
                       const uint triangle, const uint patch, const TestList* list)
{
    FeatureTest pair;
    if (!pairWith(&pair, cloths, patches, packet->m_cloth[triangle], packet->m_motion, patch)) return;
    const CullQuery* query = queryOf(packet, cloths, triangle);
    const CullReach reach = cullReach(&query->m_cull, pair.m_reach, patches->m_sizes[patch], cloths->m_cloth.m_mode);
    const uint own = featuresNear(packet, triangle, query->m_owned & query->m_valid,
                                  patches->m_volumes + patch * DRAPE_WIDE_NODE_FLOATS);
    if (simdMakeRoom(group, list)) cullPatch(group, patches, pair, query, reach, own, list);
}

static void walkTree(SimdGroup* group, Packet* packet, const StepCloths* cloths, const PackedPatches* patches,
                     const TestList* list)
{
    uint stack[DRAPE_WALK_STACK];
    uint depth = 1;
    stack[0] = walkEntry(patches->m_levelCount, 0);
    while (depth > 0 && group->m_index <= list->m_limit)
    {
        const uint entry = stack[--depth];
        const uint level = entryLevel(entry), index = entryIndex(entry);
        __global const float* node =
            patches->m_wideNodes + (patches->m_levels[level - 1] + index) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH;
        const LaneMask near = cullWideNode(&packet->m_joined, node);
        forLanes(lane, near)
        {
            const uint child = index * DRAPE_PATCH_WIDTH + lane;
            if (level > 1)
            {
                stack[depth++] = walkEntry(level - 1, child);
                continue;
            }
            const LaneMask touching = cullPacketChild(&packet->m_volumes, node + lane);
            forLanes(triangle, touching) visitPatch(group, packet, cloths, patches, triangle, child, list);
        }
    }
}

static void putCorners(float* rows, const uint lane, const Vec3* p)
{
    for (int k = 0; k < 6; ++k)
    {
        rows[3 * k * DRAPE_LANES + lane] = p[k].x;
        rows[(3 * k + 1) * DRAPE_LANES + lane] = p[k].y;
        rows[(3 * k + 2) * DRAPE_LANES + lane] = p[k].z;
    }
}

// Returns the triangles all of whose corners are valid.
static LaneMask getCorners(LanesVec3* p, const float* rows)
{
    Lanes sum = lanesSplat(0.0f);
    for (int k = 0; k < 6; ++k)
    {
        p[k] = lanesVec3(lanesLoad(rows, 3 * k), lanesLoad(rows, 3 * k + 1), lanesLoad(rows, 3 * k + 2));
        sum += lanesNorm1(p[k]);
    }
    return sum <= DRAPE_FARTHEST;
}

// Computes the packet's volumes for its motion. Returns whether any of its triangles may come near the obstacle.
// Counts the invalid nodes along with the resting obstacles, which happens once.
static int takeVolumes(Packet* packet, const StepCloths* cloths, __global StepCounters* counters)
{
    const ClothView* view = &cloths->m_cloth;
    __global const ObstacleMotion* motion = motionOf(cloths, packet->m_motion);
    float rows[DRAPE_CORNER_ROWS * DRAPE_LANES], radius[DRAPE_LANES];
    Vec3 own[6];
    for (uint lane = 0; lane < DRAPE_LANES; ++lane)
    {
        const uint cloth = packet->m_cloth[lane];
        cornersSeen(own, motion, view->m_triangles + cloth, view->m_start, view->m_end);
        putCorners(rows, lane, own);
        const int paired = !motion || thicknessWith(cloths, cloth, motion->m_mesh) >= 0.0f;
        radius[lane] = paired ? packet->m_radius[lane] : -1.0f;
    }
    LanesVec3 p[6];
    const LaneMask whole = getCorners(p, rows);
    const LaneMask torn = lanesNot(whole) & (lanesLoad(radius, 0) >= 0.0f);
    forLanes(lane, torn)
    {
        const uint cloth = packet->m_cloth[lane];
        cornersSeen(own, motion, view->m_triangles + cloth, view->m_start, view->m_end);
        if (replaceInvalidCorners(own, own + 3) == 0u) radius[lane] = -1.0f;
        putCorners(rows, lane, own);
        if (!motion) countInvalid(cloths, cloth, counters);
    }
    getCorners(p, rows);
    CullVolumes* volumes = &packet->m_volumes;
    const LaneMask near = cullVolumes(volumes, p, lanesLoad(radius, 0), whole, view->m_mode, motion);
    for (int k = 0; k < 6; ++k)
    {
        lanesStore(p[k].x, packet->m_corners, 3 * k);
        lanesStore(p[k].y, packet->m_corners, 3 * k + 1);
        lanesStore(p[k].z, packet->m_corners, 3 * k + 2);
    }
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        packet->m_joined.m_volume.m_low[i] = leastLane(volumes->m_low[i]);
        packet->m_joined.m_volume.m_high[i] = -leastLane(-volumes->m_high[i]);
    }
    packet->m_joined.m_radius = -leastLane(-volumes->m_radius);
    packet->m_joined.m_least = -leastLane(-volumes->m_least);
    return laneBits(near) != 0;
}

// Lists the feature tests of a packet: DRAPE_LANES cloth triangles in leaf order. The list's number of tests and
// counters->m_invalidNodes must be zero before.
static void cullPacket(const StepCloths* cloths, const PackedPatches* patches, const uint index, const TestList* list,
                       __global StepCounters* counters)
{
    const uint first = index * DRAPE_LANES;
    if (first >= cloths->m_count) return;
    Packet packet;
    for (uint lane = 0; lane < DRAPE_LANES; ++lane)
    {
        const uint cloth = cloths->m_order[min(first + lane, cloths->m_count - 1)];
        packet.m_cloth[lane] = cloth;
        packet.m_radius[lane] =
            first + lane < cloths->m_count ? cloths->m_radius[cloths->m_cloth.m_triangles[cloth].m_mesh] : -1.0f;
    }
    SimdGroup group;
    simdStart(&group);
    for (packet.m_motion = 0; packet.m_motion <= cloths->m_motionCount && group.m_index <= list->m_limit;
         ++packet.m_motion)
    {
        packet.m_ready = 0;
        if (takeVolumes(&packet, cloths, counters)) walkTree(&group, &packet, cloths, patches, list);
    }
    simdFlush(&group, list);
}

#ifdef __OPENCL_VERSION__
#include "broad_phase_views.h"

// Culls a packet per work-item.
__kernel void patchCull(DRAPE_PATCH_CULL)
{
    const StepCloths step = stepCloths(&values, nodes, cloths, radius, thickness, motions);
    const PackedPatches packed = patchesAt(patches, &values.m_patches);
    const TestList tests = {list, values.m_capacity, values.m_limit, &counters->m_candidates};
    cullPacket(&step, &packed, get_global_id(0), &tests, counters);
}
#endif
