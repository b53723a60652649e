// Broad phase of cloths with themselves on a GPU, in two launches. In the first, every patch traverses the wide tree
// and lists itself and later patches whose volumes overlap its own. In the second, groups share these pairs of patches.
// The output is pairs of features whose volumes over the step overlap, each once.
#include "../lib/broad_phase/wide_walk.h"
#include "../lib/cloth_cloth/self_pairs.h"
#include "../lib/cloth_cloth/self_views.h"
#include "self_arena_views.h"

// Pairs of patches that a group gathers before it reserves room for them.
#define DRAPE_WALK_KEPT (2 * DRAPE_WALK_NODES * DRAPE_PATCH_WIDTH)

typedef struct SelfWalker
{
    uint m_stack[DRAPE_WALK_NODES * DRAPE_WALK_STACK];
    uint m_depth;
    uint m_kept[DRAPE_WALK_KEPT];  // patches
    uint m_keptCount;
    uint m_index;
} SelfWalker;

// Lists the kept patches if there are at least `least`; all lanes together. Returns whether the list is within its
// limit.
static int listPatches(__local SelfWalker* walker, const uint own, __global Candidate* restrict list,
                       const uint capacity, const uint limit, __global volatile uint* demand, const uint least)
{
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint count = walker->m_keptCount;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (count < least) return 1;
    if (get_local_id(0) == 0)
    {
        walker->m_index = atomic_add(demand, count);
        walker->m_keptCount = 0;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint index = walker->m_index;
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        const Candidate pair = {own, walker->m_kept[i]};
        if (index + i < capacity) list[index + i] = pair;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return index <= limit;
}

// Lists the pairs of a patch, one patch per work-group. The tree's volumes are those of selfPack, joined by patchWiden.
// radius: see selfPack. Past the limit a group ends: see lib/work_items/simd_group.h. counters->m_selfPairs must be
// zero before.
__kernel __attribute__((reqd_work_group_size(DRAPE_WALK_NODES * DRAPE_PATCH_WIDTH, 1, 1))) void selfWalk(
    DRAPE_SELF_WALK)
{
    __local SelfWalker walker;
    const SelfPatches packed = selfPatchesIn(patches, &values.m_patches);
    const uint own = get_group_id(0), mesh = packed.m_patches[own].m_mesh;
    const uint most = get_local_size(0) / DRAPE_PATCH_WIDTH;
    const uint turn = get_local_id(0) / DRAPE_PATCH_WIDTH, lane = get_local_id(0) % DRAPE_PATCH_WIDTH;
    if (radius[mesh] < 0.0f) return;
    const Dop volume = childVolume(packed.m_wideNodes, own);
    if (get_local_id(0) == 0)
    {
        walker.m_depth = beginWalk(walker.m_stack, packed.m_levels, packed.m_levelCount);
        walker.m_keptCount = 0;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    while (walker.m_depth > 0)
    {
        const uint depth = walker.m_depth;
        const uint nodes = nodesInTurn(walker.m_stack, depth, most);
        const uint entry = walker.m_stack[depth - 1 - min(turn, nodes - 1)];
        barrier(CLK_LOCAL_MEM_FENCE);
        if (get_local_id(0) == 0) walker.m_depth = depth - nodes;
        barrier(CLK_LOCAL_MEM_FENCE);
        const uint level = entryLevel(entry), index = entryIndex(entry);
        const uint next = index * DRAPE_PATCH_WIDTH + lane;
        const int ahead = (next + 1) * patchesBelow(level) > own;  // otherwise an earlier patch finds the pair
        if (turn < nodes && ahead &&
            wideOverlaps(&volume, packed.m_wideNodes + (packed.m_levels[level - 1] + index) * DRAPE_WIDE_NODE_FLOATS *
                                                           DRAPE_PATCH_WIDTH))
        {
            if (level > 1)
                walker.m_stack[atomic_inc(&walker.m_depth)] = walkEntry(level - 1, next);
            else if (packed.m_patches[next].m_mesh == mesh)
                walker.m_kept[atomic_inc(&walker.m_keptCount)] = next;
        }
        if (!listPatches(&walker, own, list, values.m_pairCapacity, values.m_limit, &counters->m_selfPairs,
                         DRAPE_WALK_KEPT - DRAPE_WALK_NODES * DRAPE_PATCH_WIDTH + 1))
            return;
    }
    listPatches(&walker, own, list, values.m_pairCapacity, values.m_limit, &counters->m_selfPairs, 1);
}

// Maximum features of one kind that a patch owns.
#define DRAPE_OWNED_MOST (3 * DRAPE_PATCH_WIDTH)
// Pairs of features whose boxes overlap, gathered before they are tested, one per lane.
#define DRAPE_NEAR (8 * DRAPE_PATCH_WIDTH)
#define DRAPE_KIND_SHIFT 31

// Boxes of a patch's features of one kind that are near the other patch of the pair; the boxes of other features are
// empty.
typedef struct NearFaces
{
    float m_boxes[DRAPE_BOX_FLOATS * DRAPE_PATCH_WIDTH];
    uint m_ids[DRAPE_PATCH_WIDTH];
    uint m_nodes[3 * DRAPE_PATCH_WIDTH];
} NearFaces;
typedef struct NearVertices
{
    float m_boxes[DRAPE_BOX_FLOATS * DRAPE_OWNED_MOST];
    uint m_ids[DRAPE_OWNED_MOST];
    uint m_count;  // number of positions, unused ones included
} NearVertices;
typedef struct NearEdges
{
    float m_boxes[DRAPE_BOX_FLOATS * DRAPE_OWNED_MOST];
    uint m_ids[DRAPE_OWNED_MOST];
    uint m_nodes[2 * DRAPE_OWNED_MOST];
    uint m_count;
} NearEdges;
typedef struct NearSide
{
    NearFaces m_faces;
    NearVertices m_vertices;
    NearEdges m_edges;
    uint m_near;  // true if a face is near
} NearSide;

typedef struct SelfCuller
{
    SimdGroup m_group;
    NearSide m_sides[2];                            // first and second patch of the pair
    uint m_nearA[DRAPE_NEAR], m_nearB[DRAPE_NEAR];  // pairs of features, kind above the second
    uint m_nearCount;
} SelfCuller;

// Stores a box, or an empty one if it does not meet the other patch's: its lower bound is not finite then.
static void putBox(__local float* boxes, const uint width, const uint index, FeatureBox box, const FeatureBox* other)
{
    if (!boxesMeet(&box, other)) box = emptyBox();
    for (int i = 0; i < 3; ++i)
    {
        boxes[i * width + index] = box.m_low[i];
        boxes[(3 + i) * width + index] = box.m_high[i];
    }
}

static FeatureBox takeBox(__local const float* boxes, const uint width, const uint index)
{
    FeatureBox box;
    for (int i = 0; i < 3; ++i)
    {
        box.m_low[i] = boxes[i * width + index];
        box.m_high[i] = boxes[(3 + i) * width + index];
    }
    return box;
}

static int isNear(__local const float* boxes, const uint index)
{
    return boxes[index] < DRAPE_INFINITY;
}

static FeatureBox loadNode(const SelfPatches* features, const uint node)
{
    FeatureBox box;
    for (int i = 0; i < 3; ++i)
    {
        box.m_low[i] = features->m_vertexBoxes[node * DRAPE_BOX_FLOATS + i];
        box.m_high[i] = features->m_vertexBoxes[node * DRAPE_BOX_FLOATS + 3 + i];
    }
    return box;
}

static void gatherFace(__local NearFaces* near, const SelfCloth* cloth, const SelfPatches* features, const uint index,
                       const uint face, const FeatureBox* other)
{
    FeatureBox box = emptyBox();
    for (int k = 0; k < 3 && face != DRAPE_NO_FEATURE; ++k)
    {
        const uint vertex = cloth->m_triangles[face].m_vertices[k];
        box = joinBoxes(box, loadNode(features, vertex));
        near->m_nodes[3 * index + k] = vertex;
    }
    putBox(near->m_boxes, DRAPE_PATCH_WIDTH, index, box, other);
    near->m_ids[index] = face;
}

static void gatherVertex(__local NearVertices* near, const SelfPatches* features, const uint index, const uint vertex,
                         const FeatureBox* other)
{
    FeatureBox box = emptyBox();
    if (vertex != DRAPE_NO_FEATURE) box = loadNode(features, vertex);
    putBox(near->m_boxes, DRAPE_OWNED_MOST, index, box, other);
    near->m_ids[index] = vertex;
}

static void gatherEdge(__local NearEdges* near, const SelfCloth* cloth, const SelfPatches* features, const uint index,
                       const uint edge, const FeatureBox* other)
{
    FeatureBox box = emptyBox();
    for (int k = 0; k < 2 && edge != DRAPE_NO_FEATURE; ++k)
    {
        const uint vertex = cloth->m_edges[edge].m_vertices[k];
        box = joinBoxes(box, loadNode(features, vertex));
        near->m_nodes[2 * index + k] = vertex;
    }
    putBox(near->m_boxes, DRAPE_OWNED_MOST, index, box, other);
    near->m_ids[index] = edge;
}

// Gathers the faces of both patches, one per lane. boxes: the patches'. Returns whether either has a face near the
// other patch: the volumes of patches alone overlap far more often.
static int gatherFaces(__local NearSide* sides, const SelfCloth* cloth, const SelfPatches* features,
                       const Candidate pair, const FeatureBox boxes[2])
{
    const uint turn = get_local_id(0) / DRAPE_PATCH_WIDTH, lane = get_local_id(0) % DRAPE_PATCH_WIDTH;
    __local NearSide* side = sides + min(turn, 1u);
    if (turn < 2 && lane == 0) side->m_near = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (turn < 2)
    {
        const uint patch = turn == 0 ? pair.m_cloth : pair.m_obstacle;
        gatherFace(&side->m_faces, cloth, features, lane, features->m_faceIds[patch * DRAPE_PATCH_WIDTH + lane],
                   turn == 0 ? boxes + 1 : boxes);
        if (isNear(side->m_faces.m_boxes, lane)) side->m_near = 1;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return sides[0].m_near && sides[1].m_near;
}

// Gathers the other features of a patch, one per lane. other: the other patch's box.
static void gatherSide(__local NearSide* side, const SelfCloth* cloth, const SelfPatches* features, const uint patch,
                       const FeatureBox* other)
{
    const Patch owned = features->m_patches[patch];
    const uint vertices = owned.m_vertexBlocks * DRAPE_PATCH_WIDTH, edges = owned.m_edgeBlocks * DRAPE_PATCH_WIDTH;
    if (get_local_id(0) == 0)
    {
        side->m_vertices.m_count = vertices;
        side->m_edges.m_count = edges;
    }
    for (uint i = get_local_id(0); i < vertices + edges; i += get_local_size(0))
    {
        const uint edge = i - vertices;
        if (i < vertices)
            gatherVertex(&side->m_vertices, features, i,
                         features->m_vertexIds[owned.m_vertexBlock * DRAPE_PATCH_WIDTH + i], other);
        else
            gatherEdge(&side->m_edges, cloth, features, edge,
                       features->m_edgeIds[owned.m_edgeBlock * DRAPE_PATCH_WIDTH + edge], other);
    }
}

// Notes a pair whose boxes overlap, or tests it at once if there is no room.
static void noteNear(__local SelfCuller* culler, const SelfCloth* cloth, const uint a, const uint b, const uint kind,
                     const TestList* list)
{
    const uint noted = atomic_inc(&culler->m_nearCount);
    if (noted >= DRAPE_NEAR)
    {
        keepPair(&culler->m_group, cloth, a, b, kind, list);
        return;
    }
    culler->m_nearA[noted] = a;
    culler->m_nearB[noted] = b | (kind << DRAPE_KIND_SHIFT);
}

// Tests nodes of one side against faces of the other: lanes have nodes, and each DRAPE_PATCH_WIDTH of them a share of
// the faces.
static void crossNodes(__local SelfCuller* culler, const SelfCloth* cloth, __local const NearVertices* vertices,
                       __local const NearFaces* faces, const TestList* list)
{
    const uint turns = get_local_size(0) / DRAPE_PATCH_WIDTH, turn = get_local_id(0) / DRAPE_PATCH_WIDTH;
    for (uint v = get_local_id(0) % DRAPE_PATCH_WIDTH; v < vertices->m_count; v += DRAPE_PATCH_WIDTH)
    {
        const FeatureBox box = takeBox(vertices->m_boxes, DRAPE_OWNED_MOST, v);
        const uint node = vertices->m_ids[v];
        for (uint f = turn; f < DRAPE_PATCH_WIDTH; f += turns)
        {
            if (!isNear(faces->m_boxes, f)) continue;
            const FeatureBox other = takeBox(faces->m_boxes, DRAPE_PATCH_WIDTH, f);
            __local const uint* corners = faces->m_nodes + 3 * f;
            if (boxesMeet(&box, &other) && corners[0] != node && corners[1] != node && corners[2] != node)
                noteNear(culler, cloth, node, faces->m_ids[f], DRAPE_SELF_TEST_NODE, list);
        }
    }
}

// Pairs the edges of two patches. once: both are the same patch, and the first edge of a pair has the lesser index.
static void crossEdges(__local SelfCuller* culler, const SelfCloth* cloth, __local const NearEdges* own,
                       __local const NearEdges* others, const int once, const TestList* list)
{
    const uint turns = get_local_size(0) / DRAPE_PATCH_WIDTH, turn = get_local_id(0) / DRAPE_PATCH_WIDTH;
    for (uint e = get_local_id(0) % DRAPE_PATCH_WIDTH; e < own->m_count; e += DRAPE_PATCH_WIDTH)
    {
        const FeatureBox box = takeBox(own->m_boxes, DRAPE_OWNED_MOST, e);
        const uint edge = own->m_ids[e], a = own->m_nodes[2 * e], b = own->m_nodes[2 * e + 1];
        for (uint o = turn; o < others->m_count; o += turns)
        {
            if (!isNear(others->m_boxes, o)) continue;
            const FeatureBox otherBox = takeBox(others->m_boxes, DRAPE_OWNED_MOST, o);
            const uint c = others->m_nodes[2 * o], d = others->m_nodes[2 * o + 1], other = others->m_ids[o];
            if (boxesMeet(&box, &otherBox) && a != c && a != d && b != c && b != d && (!once || edge < other))
                noteNear(culler, cloth, min(edge, other), max(edge, other), DRAPE_SELF_TEST_EDGE, list);
        }
    }
}

// Notes the feature pairs of two patches, or of one with itself, whose boxes overlap.
static void crossPatches(__local SelfCuller* culler, const SelfCloth* cloth, const SelfPatches* features,
                         const Candidate pair, const TestList* list)
{
    __local NearSide* sides = culler->m_sides;
    const int same = pair.m_cloth == pair.m_obstacle;
    const FeatureBox boxes[2] = {childBox(features->m_wideNodes, pair.m_cloth),
                                 childBox(features->m_wideNodes, pair.m_obstacle)};
    if (!gatherFaces(sides, cloth, features, pair, boxes)) return;
    gatherSide(sides, cloth, features, pair.m_cloth, boxes + 1);
    if (!same) gatherSide(sides + 1, cloth, features, pair.m_obstacle, boxes);
    barrier(CLK_LOCAL_MEM_FENCE);
    __local const NearSide* other = same ? sides : sides + 1;
    crossNodes(culler, cloth, &sides->m_vertices, &other->m_faces, list);
    if (!same) crossNodes(culler, cloth, &other->m_vertices, &sides->m_faces, list);
    crossEdges(culler, cloth, &sides->m_edges, &other->m_edges, same, list);
}

// Tests the noted pairs, one per lane, if there are at least `least`. All lanes call it together. Returns whether the
// list is within its limit.
static int listNear(__local SelfCuller* culler, const SelfCloth* cloth, const TestList* list, const uint least)
{
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint count = min(culler->m_nearCount, (uint)DRAPE_NEAR);
    barrier(CLK_LOCAL_MEM_FENCE);
    int within = simdMakeRoom(&culler->m_group, list);
    if (count < least) return within;
    for (uint first = 0; first < count && within; first += get_local_size(0))
    {
        const uint i = first + get_local_id(0);
        if (i < count)
        {
            const uint b = culler->m_nearB[i];
            keepPair(&culler->m_group, cloth, culler->m_nearA[i], b & ((1u << DRAPE_KIND_SHIFT) - 1u),
                     b >> DRAPE_KIND_SHIFT, list);
        }
        within = simdMakeRoom(&culler->m_group, list);
    }
    if (get_local_id(0) == 0) culler->m_nearCount = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    return within;
}

// Lists the self tests of the pairs of patches in selfWalk's list. limit: see lib/work_items/simd_group.h;
// counters->m_selfTests must be zero before.
__kernel __attribute__((reqd_work_group_size(DRAPE_WALK_NODES * DRAPE_PATCH_WIDTH, 1, 1))) void selfCullPairs(
    DRAPE_SELF_CULL_PAIRS)
{
    __local SelfCuller culler;
    const uint count = min(counters->m_selfPairs, values.m_pairCapacity);
    const SelfPatches packed = selfPatchesIn(patches, &values.m_patches);
    const TestList tests = {list, values.m_capacity, values.m_limit, &counters->m_selfTests};
    const ClothView view = clothAt(nodes, cloths, &values.m_cloth, values.m_mode, 0);
    SelfCloth cloth = {view.m_triangles, view.m_edges, volumeStart(&view), view.m_end, 0.0f, 0.0f};
    uint mesh = DRAPE_NO_FEATURE;
    if (get_local_id(0) == 0) culler.m_nearCount = 0;
    simdStart(&culler.m_group);
    for (uint i = get_group_id(0); i < count; i += get_num_groups(0))
    {
        const Candidate pair = pairs[i];
        const uint next = packed.m_patches[pair.m_cloth].m_mesh;
        // Tests the noted pairs with their own cloth's radius before it changes.
        if (next != mesh && !listNear(&culler, &cloth, &tests, 1)) return;
        mesh = next;
        cloth.m_radius = radius[mesh];
        cloth.m_thickness = thickness[mesh];
        crossPatches(&culler, &cloth, &packed, pair, &tests);
        if (!listNear(&culler, &cloth, &tests, get_local_size(0))) return;
    }
    listNear(&culler, &cloth, &tests, 1);
    simdFlush(&culler.m_group, &tests);
}
