// Broad phase of cloths with themselves on a CPU, over patches of the cloths' own triangles. Every patch traverses
// the wide tree and tests its features against those of itself and of later patches, a vector of lanes at a time. The
// output is pairs of features whose volumes over the step overlap, each once.
#include "../lib/broad_phase/wide_walk.h"
#include "../lib/cloth_cloth/self_pairs.h"
#include "../lib/cloth_cloth/self_views.h"

// The current cloth, and the step's packed features.
typedef struct SelfCloths
{
    SelfCloth m_cloth;
    SelfPatches m_patches;
} SelfCloths;

// Boxes of the corners of a patch's triangles, computed when a triangle is first near another patch.
typedef struct OwnCorners
{
    FeatureBox m_boxes[3 * DRAPE_PATCH_WIDTH];
    uint m_made;  // bit i: boxes of the patch's triangle i are ready
} OwnCorners;

static const FeatureBox* cornersOf(OwnCorners* corners, const SelfCloth* cloth, const Triangle triangle, const uint at)
{
    FeatureBox* own = corners->m_boxes + 3 * at;
    if (corners->m_made >> at & 1u) return own;
    corners->m_made |= 1u << at;
    for (int k = 0; k < 3; ++k)
        own[k] = nodeBox(cloth->m_start, cloth->m_end, triangle.m_vertices[k], cloth->m_radius);
    return own;
}

// Returns the lanes whose features do not contain the node. Most features that are near each other share one, and
// such pairs are not listed. rows: nodes of a block's features, `count` each.
static LaneMask lanesWithout(__global const uint* rows, const uint block, const uint count, const uint node)
{
    LaneMask without = lanesMaskSplat(1);
    for (uint i = 0; i < count; ++i)
        without &= lanesLoadIds(rows, block * count + i) != (int)node;
    return without;
}

// Tests triangle `at` of patch `own` against the features of patch `other`, which is the same or a later one.
// Within a patch every node is tested against every face from the node's side, and of two edges the one with the
// lesser index finds the other. box: of patch `other`.
static void pairTriangle(SimdGroup* group, const SelfCloths* cloths, OwnCorners* corners, const uint own, const uint at,
                         const uint other, const FeatureBox* box, const TestList* list)
{
    const SelfCloth* cloth = &cloths->m_cloth;
    const uint face = cloths->m_patches.m_faceIds[own * DRAPE_PATCH_WIDTH + at];
    const Triangle triangle = cloth->m_triangles[face];
    const Patch patch = cloths->m_patches.m_patches[other];
    const FeatureBox* corner = cornersOf(corners, cloth, triangle, at);
    const BoxLanes faces = loadBoxes(cloths->m_patches.m_faceBoxes + other * DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH);
    for (int k = 0; k < 3; ++k)
    {
        if (!(triangle.m_owned & DRAPE_OWNS_VERTEX(k)) || !boxesMeet(&corner[k], box)) continue;
        const LaneMask mask = boxesOverlap(&faces, &corner[k]) &
                              lanesWithout(cloths->m_patches.m_faceNodes, other, 3, triangle.m_vertices[k]);
        forLanes(lane, mask)
            keepPair(group, cloth, triangle.m_vertices[k],
                     cloths->m_patches.m_faceIds[other * DRAPE_PATCH_WIDTH + lane], DRAPE_SELF_TEST_NODE, list);
    }
    const FeatureBox whole = joinBoxes(joinBoxes(corner[0], corner[1]), corner[2]);
    for (uint block = patch.m_vertexBlock; own != other && block < patch.m_vertexBlock + patch.m_vertexBlocks; ++block)
    {
        const BoxLanes vertices =
            loadBoxes(cloths->m_patches.m_vertexBoxes + block * DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH);
        LaneMask mask = boxesOverlap(&vertices, &whole);
        for (int k = 0; k < 3; ++k)
            mask &= lanesWithout(cloths->m_patches.m_vertexIds, block, 1, triangle.m_vertices[k]);
        forLanes(lane, mask) keepPair(group, cloth, cloths->m_patches.m_vertexIds[block * DRAPE_PATCH_WIDTH + lane],
                                      face, DRAPE_SELF_TEST_NODE, list);
    }
    FeatureBox edgeBox[3];
    int near[3];  // edges that may come near the patch
    for (int k = 0; k < 3; ++k)
    {
        edgeBox[k] = joinBoxes(corner[k], corner[k == 2 ? 0 : k + 1]);
        near[k] = (triangle.m_owned & DRAPE_OWNS_EDGE(k)) && boxesMeet(&edgeBox[k], box);
    }
    if (!near[0] && !near[1] && !near[2]) return;
    for (uint block = patch.m_edgeBlock; block < patch.m_edgeBlock + patch.m_edgeBlocks; ++block)
    {
        const BoxLanes edges = loadBoxes(cloths->m_patches.m_edgeBoxes + block * DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH);
        for (int k = 0; k < 3; ++k)
        {
            if (!near[k]) continue;
            const LaneMask mask =
                boxesOverlap(&edges, &edgeBox[k]) &
                lanesWithout(cloths->m_patches.m_edgeNodes, block, 2, triangle.m_vertices[k]) &
                lanesWithout(cloths->m_patches.m_edgeNodes, block, 2, triangle.m_vertices[k == 2 ? 0 : k + 1]);
            forLanes(lane, mask)
            {
                const uint edge = cloths->m_patches.m_edgeIds[block * DRAPE_PATCH_WIDTH + lane],
                           mine = triangle.m_edges[k];
                if (own != other || mine < edge)
                    keepPair(group, cloth, min(mine, edge), max(mine, edge), DRAPE_SELF_TEST_EDGE, list);
            }
        }
    }
}

// Returns whether the list is within its limit.
static int pairPatches(SimdGroup* group, const SelfCloths* cloths, OwnCorners* corners, const uint own,
                       const uint other, const TestList* list)
{
    if (liesSmoothly(&cloths->m_patches.m_smooth, own, other)) return 1;
    const FeatureBox box = childBox(cloths->m_patches.m_wideNodes, other);
    const BoxLanes faces = loadBoxes(cloths->m_patches.m_faceBoxes + own * DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH);
    const LaneMask near = boxesOverlap(&faces, &box);
    forLanes(at, near)
    {
        pairTriangle(group, cloths, corners, own, at, other, &box, list);
        if (!simdMakeRoom(group, list)) return 0;
    }
    return 1;
}

static void walkSelf(SimdGroup* group, const SelfCloths* cloths, const uint own, const TestList* list)
{
    uint stack[DRAPE_WALK_STACK];
    uint depth = 1;
    const Dop volume = childVolume(cloths->m_patches.m_wideNodes, own);
    OwnCorners corners;
    corners.m_made = 0;
    stack[0] = walkEntry(cloths->m_patches.m_levelCount, 0);
    while (depth > 0)
    {
        const uint entry = stack[--depth];
        const uint level = entryLevel(entry), index = entryIndex(entry);
        const uint below = patchesBelow(level);
        const LaneMask near =
            wideOverlaps(&volume, cloths->m_patches.m_wideNodes + (cloths->m_patches.m_levels[level - 1] + index) *
                                                                      DRAPE_WIDE_NODE_FLOATS * DRAPE_PATCH_WIDTH);
        forLanes(lane, near)
        {
            const uint next = index * DRAPE_PATCH_WIDTH + lane;
            if ((next + 1) * below <= own) continue;  // earlier patches find this pair
            if (level > 1)
                stack[depth++] = walkEntry(level - 1, next);
            else if (cloths->m_patches.m_patches[next].m_mesh == cloths->m_patches.m_patches[own].m_mesh &&
                     !pairPatches(group, cloths, &corners, own, next, list))
                return;
        }
    }
}

// Lists the self tests of the features of patch `own` with those of itself and of later patches. The tree's volumes are
// those of packSelf(), joined by widenChild(). The list's number of tests must be zero before.
static void cullSelf(const ClothView* cloth, const SelfRadii* radii, const SelfPatches* patches, const uint own,
                     const TestList* list)
{
    const uint mesh = patches->m_patches[own].m_mesh;
    const float radius = radii->m_radius[mesh];
    if (radius < 0.0f) return;
    const SelfCloths cloths = {
        {cloth->m_triangles, cloth->m_edges, volumeStart(cloth), cloth->m_end, radius, radii->m_thickness[mesh]},
        *patches};
    SimdGroup group;
    simdStart(&group);
    walkSelf(&group, &cloths, own, list);
    simdFlush(&group, list);
}

#ifdef __OPENCL_VERSION__
#include "self_arena_views.h"

// Culls a patch per work-item.
__kernel void selfCull(DRAPE_SELF_CULL)
{
    const uint own = get_global_id(0);
    if (own >= values.m_patches.m_patchCount) return;
    const ClothView cloth = clothAt(nodes, cloths, &values.m_cloth, values.m_mode, 0);
    const SelfRadii radii = {radius, thickness, 0};
    const SelfPatches packed = selfPatchesAt(patches, &values.m_patches);
    const TestList tests = {list, values.m_capacity, values.m_limit, &counters->m_selfTests};
    cullSelf(&cloth, &radii, &packed, own, &tests);
}
#endif
