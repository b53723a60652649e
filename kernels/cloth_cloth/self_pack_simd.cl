// The CPU version of self_pack_gpu.cl: a work-item packs a patch, a vector of its features at a time, and also writes
// the features' boxes.
#include "../lib/broad_phase/cull_packet.h"
#include "../lib/cloth_cloth/invalid_nodes.h"
#include "../lib/cloth_cloth/self_cull.h"
#include "../lib/cloth_cloth/self_views.h"
#include "../lib/work_items/simd_group.h"

// Rows of a node of each lane's feature: x y z at the step's start and at its end.
#define DRAPE_NODE_ROWS (6 * DRAPE_LANES)

typedef struct NodeLanes
{
    LanesVec3 m_position[2];
    LaneMask m_valid;
} NodeLanes;

// A lane without a node gets an invalid position.
static void putNode(float* rows, const uint lane, __global const float* start, __global const float* end,
                    const uint node)
{
    if (node == DRAPE_NO_FEATURE)
    {
        rows[lane] = DRAPE_INFINITY;
        return;
    }
    DRAPE_UNROLL
    for (uint i = 0; i < 3; ++i)
    {
        rows[i * DRAPE_LANES + lane] = start[3 * node + i];
        rows[(3 + i) * DRAPE_LANES + lane] = end[3 * node + i];
    }
}

// See positionIsValid().
static LaneMask positionsValid(const LanesVec3 p)
{
    return (lanesAbs(p.x) <= DRAPE_FARTHEST) & (lanesAbs(p.y) <= DRAPE_FARTHEST) & (lanesAbs(p.z) <= DRAPE_FARTHEST);
}

static NodeLanes getNodes(const float* rows)
{
    NodeLanes nodes;
    for (int i = 0; i < 2; ++i)
        nodes.m_position[i] = lanesVec3(lanesLoad(rows, 3 * i), lanesLoad(rows, 3 * i + 1), lanesLoad(rows, 3 * i + 2));
    nodes.m_valid = positionsValid(nodes.m_position[0]) & positionsValid(nodes.m_position[1]);
    return nodes;
}

// Computes features' intervals along a direction, of `count` nodes each, like dopGrowInterval(); empty without a valid
// node.
static void growLanes(Lanes* low, Lanes* high, const NodeLanes* nodes, const int count, const float radius,
                      const int direction)
{
    Lanes least = lanesSplat(DRAPE_INFINITY), greatest = lanesSplat(-DRAPE_INFINITY), inner = lanesSplat(0.0f);
    for (int k = 0; k < 2 * count; ++k)
    {
        const NodeLanes* node = nodes + k / 2;
        const LanesVec3 p = node->m_position[k % 2];
        const Lanes v = projectLanes(p, direction);
        least = lanesSelect(node->m_valid, lanesMin(least, v), least);
        greatest = lanesSelect(node->m_valid, lanesMax(greatest, v), greatest);
        if (direction >= 3 + DRAPE_DOP_EDGES) inner = lanesSelect(node->m_valid, lanesMax(inner, lanesNorm1(p)), inner);
    }
    const float reach = radius * dopNorm(direction), pad = DRAPE_DOP_PAD;
    const Lanes from = least - reach, to = greatest + reach;
    const LaneMask any = least <= greatest;
    *low = lanesSelect(any, from - (pad * (lanesAbs(least) + inner + lanesAbs(from)) + DRAPE_TINY), least);
    *high = lanesSelect(any, to + (pad * (lanesAbs(greatest) + inner + lanesAbs(to)) + DRAPE_TINY), greatest);
}

static void storeBoxes(__global float* boxes, const uint block, const NodeLanes* nodes, const int count,
                       const float radius)
{
    __global float* out = boxes + block * DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH;
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
    {
        Lanes low, high;
        growLanes(&low, &high, nodes, count, radius, i);
        lanesStore(low, out, i);
        lanesStore(high, out, 3 + i);
    }
}

// Stores the volume at the patch's position in the first level of the wide tree; empty if no face is valid.
static void storeVolume(__global float* wideNodes, const uint patch, const NodeLanes* corners, const float radius)
{
    __global float* out = wideNodes + (patch / DRAPE_PATCH_WIDTH) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH +
                          patch % DRAPE_PATCH_WIDTH;
    DRAPE_UNROLL
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        Lanes low, high;
        growLanes(&low, &high, corners, 3, radius, i);
        out[i * DRAPE_PATCH_WIDTH] = leastLane(low);
        out[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH] = -leastLane(-high);
        out[(2 * DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH] = 0.0f;
    }
}

// Packs a patch, or one of the empty positions behind the last. Writes the patch's volume, in the lowest level of the
// wide tree, and its features' boxes, in blocks.
static void packSelf(const ClothView* cloth, const SelfRadii* radii, const SelfPatches* patches, const uint index,
                     __global StepCounters* counters)
{
    __global const float* start = volumeStart(cloth);
    const int exists = index < patches->m_patchCount;
    NodeLanes nodes[3];
    float rows[3][DRAPE_NODE_ROWS];
    for (int k = 0; k < 3; ++k)
        for (uint i = 0; i < DRAPE_NODE_ROWS; ++i)
            rows[k][i] = 0.0f;
    Patch patch = {0, 0, 0, 0, 0};
    if (exists) patch = patches->m_patches[index];
    const float grown = exists ? radii->m_radius[patch.m_mesh] : -1.0f;
    for (uint lane = 0; lane < DRAPE_LANES; ++lane)
    {
        const uint face = grown >= 0.0f ? patches->m_faceIds[index * DRAPE_PATCH_WIDTH + lane] : DRAPE_NO_FEATURE;
        for (int k = 0; k < 3; ++k)
            putNode(rows[k], lane, start, cloth->m_end,
                    face != DRAPE_NO_FEATURE ? cloth->m_triangles[face].m_vertices[k] : DRAPE_NO_FEATURE);
        if (face != DRAPE_NO_FEATURE && radii->m_obstacleRadius[patch.m_mesh] < 0.0f)
            countInvalidNodes(cloth->m_triangles + face, start, cloth->m_end, counters);
    }
    for (int k = 0; k < 3; ++k)
        nodes[k] = getNodes(rows[k]);
    storeVolume(patches->m_wideNodes, index, nodes, grown);
    if (exists) storeBoxes(patches->m_faceBoxes, index, nodes, 3, grown);
    for (uint block = patch.m_vertexBlock; block < patch.m_vertexBlock + patch.m_vertexBlocks; ++block)
    {
        for (uint lane = 0; lane < DRAPE_LANES; ++lane)
            putNode(rows[0], lane, start, cloth->m_end,
                    grown >= 0.0f ? patches->m_vertexIds[block * DRAPE_PATCH_WIDTH + lane] : DRAPE_NO_FEATURE);
        nodes[0] = getNodes(rows[0]);
        storeBoxes(patches->m_vertexBoxes, block, nodes, 1, grown);
    }
    for (uint block = patch.m_edgeBlock; block < patch.m_edgeBlock + patch.m_edgeBlocks; ++block)
    {
        for (uint lane = 0; lane < DRAPE_LANES; ++lane)
        {
            const uint edge = grown >= 0.0f ? patches->m_edgeIds[block * DRAPE_PATCH_WIDTH + lane] : DRAPE_NO_FEATURE;
            for (int k = 0; k < 2; ++k)
                putNode(rows[k], lane, start, cloth->m_end,
                        edge != DRAPE_NO_FEATURE ? cloth->m_edges[edge].m_vertices[k] : DRAPE_NO_FEATURE);
        }
        for (int k = 0; k < 2; ++k)
            nodes[k] = getNodes(rows[k]);
        storeBoxes(patches->m_edgeBoxes, block, nodes, 2, grown);
    }
}

#ifdef __OPENCL_VERSION__
#include "self_arena_views.h"

// Packs a position of the tree's lowest level per work-item.
__kernel void selfPack(DRAPE_SELF_PACK)
{
    const uint index = get_global_id(0);
    if (index >= values.m_patches.m_entries) return;
    const ClothView cloth = clothAt(nodes, cloths, &values.m_cloth, values.m_mode, 0);
    const SelfRadii radii = {radius, 0, obstacleRadius};
    const SelfPatches packed = selfPatchesAt(patches, &values.m_patches);
    packSelf(&cloth, &radii, &packed, index, counters);
}
#endif
