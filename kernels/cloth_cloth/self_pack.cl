// Packs the cloths' own patches over a step, for cloths that collide with themselves: the patches' volumes and their
// nodes' boxes. self_pack_simd.cl is the CPU's version.
#include "../lib/invalid_nodes.h"
#include "../lib/self_cull.h"

// Stores the box by node: groups join the boxes of the features that they meet.
static void storeNode(__global float* restrict boxes, const uint node, const FeatureBox box)
{
    for (int i = 0; i < 3; ++i)
    {
        boxes[node * DRAPE_BOX_FLOATS + i] = box.m_low[i];
        boxes[node * DRAPE_BOX_FLOATS + 3 + i] = box.m_high[i];
    }
}

// Packs a patch per work-group of DRAPE_PATCH_WIDTH, or one of the empty positions behind patchCount. Writes the
// patch's volume, in the first level of the wide tree, and its nodes' boxes, by node. Ids are those of the lanes'
// features, DRAPE_NO_FEATURE where there is none. start: the end's positions in a discrete step. radius: m, per
// cloth, half the reach, negative for cloths that do not collide with themselves; obstacleRadius: of the search for
// obstacles.
__kernel __attribute__((reqd_work_group_size(DRAPE_PATCH_WIDTH, 1, 1))) void selfPack(
    __global const Patch* restrict patches, const uint patchCount, __global const uint* restrict faceIds,
    __global const uint* restrict vertexIds, __global const Triangle* restrict triangles, __global const float* start,
    __global const float* end, __global const float* restrict radius, __global const float* restrict obstacleRadius,
    __global float* restrict nodeBoxes, __global float* restrict wideNodes, __global StepCounters* restrict counters)
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
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        bounds[i * DRAPE_PATCH_WIDTH + lane] = dop.m_low[i];
        bounds[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH + lane] = dop.m_high[i];
    }
    for (uint block = patch.m_vertexBlock; block < patch.m_vertexBlock + patch.m_vertexBlocks; ++block)
    {
        const uint vertex = vertexIds[block * DRAPE_PATCH_WIDTH + lane];
        if (vertex != DRAPE_NO_FEATURE && grown >= 0.0f) storeNode(nodeBoxes, vertex, nodeBox(start, end, vertex, grown));
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
