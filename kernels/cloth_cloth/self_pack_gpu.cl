// Packs the cloths' own patches over a step, for cloths that collide with themselves: the patches' volumes and their
// nodes' boxes. self_pack_simd.cl is the CPU's version.
#include "../lib/cloth_cloth/invalid_nodes.h"
#include "../lib/cloth_cloth/self_cull.h"
#include "self_arena_views.h"

// Stores the box by node: groups join the boxes of the features that they meet.
static void storeNode(__global float* boxes, const uint node, const FeatureBox box)
{
    for (int i = 0; i < 3; ++i)
    {
        boxes[node * DRAPE_BOX_FLOATS + i] = box.m_low[i];
        boxes[node * DRAPE_BOX_FLOATS + 3 + i] = box.m_high[i];
    }
}

// Packs a patch per work-group of DRAPE_PATCH_WIDTH, or one of the empty positions behind patchCount. Writes the
// patch's volume, in the first level of the wide tree, and its nodes' boxes, by node. radius, obstacleRadius:
// see SelfRadii.
__kernel __attribute__((reqd_work_group_size(DRAPE_PATCH_WIDTH, 1, 1))) void selfPack(DRAPE_SELF_PACK)
{
    __local float bounds[2 * DRAPE_DOP_DIRECTIONS * DRAPE_PATCH_WIDTH];
    const uint index = get_group_id(0), lane = get_local_id(0);
    const ClothView cloth = clothAt(nodes, cloths, &values.m_cloth, values.m_mode, 0);
    const SelfPatches packed = selfPatchesAt(patches, &values.m_patches);
    __global const float* start = volumeStart(&cloth);
    const int exists = index < packed.m_patchCount;
    const uint face = exists ? packed.m_faceIds[index * DRAPE_PATCH_WIDTH + lane] : DRAPE_NO_FEATURE;
    Patch patch = {0, 0, 0, 0, 0};
    if (exists) patch = packed.m_patches[index];
    const float grown = exists ? radius[patch.m_mesh] : -1.0f;
    Dop dop;
    dopClear(&dop);
    if (face != DRAPE_NO_FEATURE && grown >= 0.0f)
    {
        __global const Triangle* triangle = cloth.m_triangles + face;
        triangleVolume(&dop, triangle, start, cloth.m_end, grown);
        if (obstacleRadius[patch.m_mesh] < 0.0f) countInvalidNodes(triangle, start, cloth.m_end, counters);
    }
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        bounds[i * DRAPE_PATCH_WIDTH + lane] = dop.m_low[i];
        bounds[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH + lane] = dop.m_high[i];
    }
    for (uint block = patch.m_vertexBlock; block < patch.m_vertexBlock + patch.m_vertexBlocks; ++block)
    {
        const uint vertex = packed.m_vertexIds[block * DRAPE_PATCH_WIDTH + lane];
        if (vertex != DRAPE_NO_FEATURE && grown >= 0.0f)
            storeNode(packed.m_vertexBoxes, vertex, nodeBox(start, cloth.m_end, vertex, grown));
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    __global float* out = packed.m_wideNodes +
                          (index / DRAPE_PATCH_WIDTH) * DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH +
                          index % DRAPE_PATCH_WIDTH;
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
