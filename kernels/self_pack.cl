// The cloths' own patches over a step, for cloths that collide with themselves: the patches' volumes and, for teams that are
// one work-item, the boxes of their features.
#include "lib/self_contact.h"
#include "lib/self_cull.h"

static void storeBox(__global float* restrict boxes, const uint lane, const FeatureBox box)
{
    __global float* out = boxes + (lane / DRAPE_PATCH_WIDTH) * DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH + lane % DRAPE_PATCH_WIDTH;
    for (int i = 0; i < 3; ++i)
    {
        out[i * DRAPE_PATCH_WIDTH] = box.m_low[i];
        out[(3 + i) * DRAPE_PATCH_WIDTH] = box.m_high[i];
    }
}

// Boxes by node instead: a GPU's groups join those of the features that they meet.
static void storeNode(__global float* restrict boxes, const uint node, const FeatureBox box)
{
    for (int i = 0; i < 3; ++i)
    {
        boxes[node * DRAPE_BOX_FLOATS + i] = box.m_low[i];
        boxes[node * DRAPE_BOX_FLOATS + 3 + i] = box.m_high[i];
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

// A work-group of DRAPE_PATCH_WIDTH takes a patch, or one of the empty places behind patchCount: writes its volume, in the
// first level of the wide tree, and the boxes of its features in blocks, or of its nodes alone at the nodes' places. Ids are those of the lanes' features,
// DRAPE_NO_FEATURE where there is none. start: the end's positions in a discrete step. radius: m, per cloth, half the reach,
// negative for cloths that do not collide with themselves; obstacleRadius: of the search for obstacles.
__kernel __attribute__((reqd_work_group_size(DRAPE_PATCH_WIDTH, 1, 1))) void selfPack(
    __global const Patch* restrict patches, const uint patchCount, __global const uint* restrict faceIds,
    __global const uint* restrict vertexIds, __global const uint* restrict edgeIds,
    __global const Triangle* restrict triangles, __global const Edge* restrict edges, __global const float* start,
    __global const float* end, __global const float* restrict radius, __global const float* restrict obstacleRadius,
    const uint inBlocks, __global float* restrict faceBoxes, __global float* restrict vertexBoxes,
    __global float* restrict edgeBoxes, __global float* restrict wideNodes, __global StepCounters* restrict counters)
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
    if (index < patchCount && inBlocks) storeBox(faceBoxes, index * DRAPE_PATCH_WIDTH + lane, boxOfVolume(&dop));
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        bounds[i * DRAPE_PATCH_WIDTH + lane] = dop.m_low[i];
        bounds[(DRAPE_DOP_DIRECTIONS + i) * DRAPE_PATCH_WIDTH + lane] = dop.m_high[i];
    }
    for (uint block = patch.m_vertexBlock; block < patch.m_vertexBlock + patch.m_vertexBlocks; ++block)
    {
        const uint place = block * DRAPE_PATCH_WIDTH + lane, vertex = vertexIds[place];
        const int there = vertex != DRAPE_NO_FEATURE && grown >= 0.0f;
        if (inBlocks)
            storeBox(vertexBoxes, place, there ? nodeBox(start, end, vertex, grown) : emptyBox());
        else if (there)
            storeNode(vertexBoxes, vertex, nodeBox(start, end, vertex, grown));
    }
    for (uint block = patch.m_edgeBlock; inBlocks && block < patch.m_edgeBlock + patch.m_edgeBlocks; ++block)
    {
        const uint place = block * DRAPE_PATCH_WIDTH + lane, edge = edgeIds[place];
        FeatureBox box = emptyBox();
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
