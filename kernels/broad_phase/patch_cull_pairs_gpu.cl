// Second launch of the broad phase over patches on a GPU: lists the feature tests of the pairs that patchWalk listed. A
// patch has some hundred features, and a cloth triangle is seldom near them all. A group therefore first finds, for
// each of its pairs, the near parts of the patch's blocks. It then tests these alone, as many side by side as it has
// lanes.
#include "../lib/broad_phase/patch_pairs.h"

// Pairs that a group takes at a time, each with a lane to prepare it.
#define DRAPE_CULL_PAIRS 32

// Ratio of the launched groups (kPairGroupsPerUnit in patch_cull.cpp) to those that a GPU runs together.
#define DRAPE_CULL_WAVES 4

// Lanes of a part of a block, and parts of a block.
#define DRAPE_PART 8
#define DRAPE_PARTS (DRAPE_PATCH_WIDTH / DRAPE_PART)

// Parts of a patch's features, a bit each: of its faces, its vertices and its edges, of which there are up to three
// blocks.
#define DRAPE_PART_BITS(blocks) ((1u << (blocks)*DRAPE_PARTS) - 1u)
#define DRAPE_FACE_PARTS 0u
#define DRAPE_VERTEX_PARTS (DRAPE_FACE_PARTS + DRAPE_PARTS)
#define DRAPE_EDGE_PARTS (DRAPE_VERTEX_PARTS + 3u * DRAPE_PARTS)

// The part of a block to which this lane's position belongs.
#define DRAPE_OWN_PART (simdLane() % DRAPE_PATCH_WIDTH / DRAPE_PART)

// Five bits of a task hold a pair's index, its parts are bits of a word, and each pair has a lane.
typedef char PairsFitTask[DRAPE_CULL_PAIRS <= 32 ? 1 : -1];
typedef char PairsFitLanes[DRAPE_CULL_PAIRS <= DRAPE_WALK_NODES * DRAPE_PATCH_WIDTH ? 1 : -1];
typedef char PartsFit[DRAPE_EDGE_PARTS + 3u * DRAPE_PARTS <= 32u ? 1 : -1];

// The current pair. m_query: index of its cloth triangle's cull query.
typedef struct CullPair
{
    FeatureTest m_pair;
    CullReach m_reach;
    uint m_query;
    uint m_own;    // the triangle's nodes and edges that it owns and that are valid, bits as in Triangle::m_owned
    uint m_all;    // so large compared with the patch that it is near most of it
    uint m_parts;  // bit per part of the patch that the triangle is near
} CullPair;

// A current group of tests: of a pair, one of its triangle's nodes or edges or (0) its face, and a part of the
// patch's features.
#define DRAPE_TASK(pair, feature, part) ((ushort)((pair) | (feature) << 5 | (part) << 7))
#define DRAPE_TASK_PAIR(task) ((task)&31u)
#define DRAPE_TASK_FEATURE(task) ((task) >> 5 & 3u)
#define DRAPE_TASK_PART(task) ((task) >> 7)

typedef struct Culler
{
    SimdGroup m_group;
    CullQuery m_queries[DRAPE_CULL_PAIRS];  // one per run of pairs with the same triangle and motion
    CullPair m_pairs[DRAPE_CULL_PAIRS];
    ushort m_nodes[DRAPE_CULL_PAIRS * 3 * DRAPE_PARTS];
    ushort m_faces[DRAPE_CULL_PAIRS * 3 * DRAPE_PARTS];
    ushort m_edges[DRAPE_CULL_PAIRS * 9 * DRAPE_PARTS];
    uint m_counts[3];  // counts of m_nodes, m_faces and m_edges
} Culler;

// Returns whether a cloth triangle is so large compared with a patch of that size that most of the patch's features
// are near it.
static int reachesAll(__local const CullTriangle* cull, const CullReach reach, const float size)
{
    return cull->m_radius + reach.m_near > 0.5f * size;
}

// Loads the pairs from first up to last, one per lane.
static void takePairs(__local Culler* culler, const StepCloths* cloths, const PackedPatches* patches,
                      __global const FeatureTest* pairs, const uint first, const uint last)
{
    const uint lane = simdLane();
    const int takes = first + lane < last;
    FeatureTest pair;
    int leads = 0;
    if (takes)
    {
        pair = pairs[first + lane];
        leads = lane == 0 || pairs[first + lane - 1].m_cloth != pair.m_cloth ||
                pairs[first + lane - 1].m_motion != pair.m_motion;
        culler->m_pairs[lane].m_query = leads ? lane : DRAPE_CULL_PAIRS;
    }
    if (leads)
    {
        CullQuery own;
        makeQuery(&own, cloths, pair.m_cloth, pair.m_motion);
        culler->m_queries[lane] = own;
    }
    if (lane < 3) culler->m_counts[lane] = 0;
    simdSync();
    uint query = lane;
    while (takes && culler->m_pairs[query].m_query == DRAPE_CULL_PAIRS)
        --query;
    simdSync();
    if (takes)
    {
        __local const CullQuery* own = culler->m_queries + query;
        CullPair taken;
        taken.m_pair = pair;
        taken.m_reach = cullReach(&own->m_cull, pair.m_reach, patches->m_sizes[pair.m_lane], cloths->m_cloth.m_mode);
        taken.m_query = query;
        taken.m_own = own->m_owned & own->m_valid;
        taken.m_all = reachesAll(&own->m_cull, taken.m_reach, patches->m_sizes[pair.m_lane]);
        taken.m_parts = 0;
        culler->m_pairs[lane] = taken;
    }
    simdSync();
}

// Marks the parts that contain this lane's face and the features that it owns, if the pair's cloth triangle may be near
// the face.
static void markParts(__local CullPair* pair, __local const CullTriangle* cull, const PackedPatches* patches)
{
    const uint patch = pair->m_pair.m_lane;
    const uint face = patches->m_faceFeatures[patch * DRAPE_PATCH_WIDTH + simdLane() % DRAPE_PATCH_WIDTH];
    __global const float* faces = patches->m_faces + patch * DRAPE_FACE_FLOATS * DRAPE_PATCH_WIDTH;
    if (!pair->m_all && !cullFaces(cull, pair->m_reach, faces)) return;
    uint parts = 1u << (DRAPE_FACE_PARTS + DRAPE_OWN_PART);
    const uint vertices = popcount(DRAPE_FEATURES_OWNED(face) & 7u), edges = popcount(DRAPE_FEATURES_OWNED(face) >> 3);
    const uint vertex = DRAPE_FEATURES_VERTEX(face), edge = DRAPE_FEATURES_EDGE(face);
    if (vertices > 0)
        parts |= (1u << vertex / DRAPE_PART | 1u << (vertex + vertices - 1) / DRAPE_PART) << DRAPE_VERTEX_PARTS;
    if (edges > 0) parts |= (1u << edge / DRAPE_PART | 1u << (edge + edges - 1) / DRAPE_PART) << DRAPE_EDGE_PARTS;
    if ((pair->m_parts & parts) != parts) atomic_or(&pair->m_parts, parts);
}

// Lists the tests of each bit of `own` with each bit of `parts`.
static void listTasks(__local ushort* tasks, volatile __local uint* count, const uint pair, const uint own,
                      const uint parts)
{
    uint index = atomic_add(count, popcount(own) * popcount(parts));
    for (uint ofOwn = own; ofOwn != 0; ofOwn &= ofOwn - 1)
    {
        const uint feature = 31 - clz(ofOwn & -ofOwn);
        for (uint left = parts; left != 0; left &= left - 1)
            tasks[index++] = DRAPE_TASK(pair, feature, 31 - clz(left & -left));
    }
}

// Lists the tests of all current pairs, one lane for each pair and kind.
static void listAllTasks(__local Culler* culler, const uint count)
{
    for (uint i = simdLane(); i < 3 * DRAPE_CULL_PAIRS; i += simdWidth())
    {
        const uint index = i % DRAPE_CULL_PAIRS, kind = i / DRAPE_CULL_PAIRS;
        if (index >= count) continue;
        __local const CullPair* pair = culler->m_pairs + index;
        const uint own = pair->m_own, parts = pair->m_parts;
        if (kind == 0)
            listTasks(culler->m_nodes, culler->m_counts, index, own & 7u,
                      parts >> DRAPE_FACE_PARTS & DRAPE_PART_BITS(1));
        else if (kind == 1)
            listTasks(culler->m_faces, culler->m_counts + 1, index,
                      culler->m_queries[pair->m_query].m_valid == DRAPE_ALL_FEATURES,
                      parts >> DRAPE_VERTEX_PARTS & DRAPE_PART_BITS(3));
        else
            listTasks(culler->m_edges, culler->m_counts + 2, index, own >> 3 & 7u,
                      parts >> DRAPE_EDGE_PARTS & DRAPE_PART_BITS(3));
    }
}

// Returns the shift from this lane's position in a block (lanesLoad()) to its position in the part: only their sum is
// read.
static int partShift(const uint part)
{
    return ((int)(part % DRAPE_PARTS) - (int)DRAPE_OWN_PART) * DRAPE_PART;
}

// Tests a listed node against a part of faces.
static void cullNode(__local Culler* culler, const PackedPatches* patches, const uint task, const TestList* list)
{
    const uint node = DRAPE_TASK_FEATURE(task), part = DRAPE_TASK_PART(task);
    __local const CullPair* pair = culler->m_pairs + DRAPE_TASK_PAIR(task);
    const uint block = pair->m_pair.m_lane;
    const int shift = partShift(part);
    const LaneMask mask = cullNodeFace(&culler->m_queries[pair->m_query].m_cull, node, pair->m_reach,
                                       patches->m_faces + block * DRAPE_FACE_FLOATS * DRAPE_PATCH_WIDTH + shift);
    keepLanes(&culler->m_group, mask, pair->m_pair, DRAPE_TEST_NODE + node, block * DRAPE_PATCH_WIDTH + shift, list);
}

// Tests a listed cloth face against a part of vertices.
static void cullFace(__local Culler* culler, const PackedPatches* patches, const uint task, const TestList* list)
{
    const uint part = DRAPE_TASK_PART(task);
    __local const CullPair* pair = culler->m_pairs + DRAPE_TASK_PAIR(task);
    const uint block = patches->m_patches[pair->m_pair.m_lane].m_vertexBlock + part / DRAPE_PARTS;
    const int shift = partShift(part);
    const LaneMask mask = cullFaceVertex(&culler->m_queries[pair->m_query].m_cull, pair->m_reach,
                                         patches->m_vertices + block * DRAPE_VERTEX_FLOATS * DRAPE_PATCH_WIDTH + shift);
    keepLanes(&culler->m_group, mask, pair->m_pair, DRAPE_TEST_FACE, block * DRAPE_PATCH_WIDTH + shift, list);
}

// Tests a listed edge against a part of edges.
static void cullEdge(__local Culler* culler, const PackedPatches* patches, const uint task, const TestList* list)
{
    const uint edge = DRAPE_TASK_FEATURE(task), part = DRAPE_TASK_PART(task);
    __local const CullPair* pair = culler->m_pairs + DRAPE_TASK_PAIR(task);
    __local const CullTriangle* cull = &culler->m_queries[pair->m_query].m_cull;
    const uint block = patches->m_patches[pair->m_pair.m_lane].m_edgeBlock + part / DRAPE_PARTS;
    const int shift = partShift(part);
    const CullEdges edges =
        loadCullEdges(cull, patches->m_edges + block * DRAPE_EDGE_FLOATS * DRAPE_PATCH_WIDTH + shift);
    keepLanes(&culler->m_group, cullEdgeEdge(cull, edge, pair->m_reach, &edges), pair->m_pair, DRAPE_TEST_EDGE + edge,
              block * DRAPE_PATCH_WIDTH + shift, list);
}

// Runs all listed tests, each on as many lanes as a part has.
static void cullTasks(__local Culler* culler, const PackedPatches* patches, const TestList* list)
{
    const uint first = simdLane() / DRAPE_PART, stride = simdWidth() / DRAPE_PART;
    for (uint i = first; i < culler->m_counts[0]; i += stride)
        cullNode(culler, patches, culler->m_nodes[i], list);
    for (uint i = first; i < culler->m_counts[1]; i += stride)
        cullFace(culler, patches, culler->m_faces[i], list);
    for (uint i = first; i < culler->m_counts[2]; i += stride)
        cullEdge(culler, patches, culler->m_edges[i], list);
}

// Returns the number of pairs that a group takes at a time. If one wave, the groups that the device runs together,
// can take all pairs, each group of it takes equally many. Otherwise all groups take as many turns as necessary.
static uint pairsOfGroup(const uint count, const uint groups, const uint turns)
{
    const uint wave = max(groups / DRAPE_CULL_WAVES, 1u);
    const uint inWave = ((count + wave - 1) / wave + turns - 1) / turns * turns;
    const uint rounds = max((count + groups * DRAPE_CULL_PAIRS - 1) / (groups * DRAPE_CULL_PAIRS), 1u);
    return inWave <= DRAPE_CULL_PAIRS ? max(inWave, turns) : (count + groups * rounds - 1) / (groups * rounds);
}

// Lists the feature tests of the pairs in patchWalk's list; most adjacent pairs are of one cloth triangle. A group
// takes up to DRAPE_CULL_PAIRS at a time. Their number and the end of the loop are equal for all its lanes, so that all
// reach its barriers. counters->m_candidates must be zero before.
#include "broad_phase_views.h"

__kernel __attribute__((reqd_work_group_size(DRAPE_WALK_NODES * DRAPE_PATCH_WIDTH, 1, 1))) void patchCullPairs(
    DRAPE_PATCH_CULL_PAIRS)
{
    const uint count = min(counters->m_patchPairs, values.m_pairCapacity);
    const uint groups = get_num_groups(0);
    const uint turn = simdLane() / DRAPE_PATCH_WIDTH, turns = simdWidth() / DRAPE_PATCH_WIDTH;
    const uint share = pairsOfGroup(count, groups, turns);
    const StepCloths step = stepCloths(&values, nodes, cloths, 0, 0, motions);
    const PackedPatches packed = patchesAt(patches, &values.m_patches);
    const TestList tests = {list, values.m_capacity, values.m_limit, &counters->m_candidates};
    __local Culler culler;
    simdStart(&culler.m_group);
    for (uint first = get_group_id(0) * share; first < count; first += groups * share)
    {
        const uint taken = min(first + share, count) - first;
        takePairs(&culler, &step, &packed, pairs, first, first + taken);
        for (uint i = turn; i < taken; i += turns)
            markParts(culler.m_pairs + i, &culler.m_queries[culler.m_pairs[i].m_query].m_cull, &packed);
        simdSync();
        listAllTasks(&culler, taken);
        simdSync();
        cullTasks(&culler, &packed, &tests);
        if (!simdFlush(&culler.m_group, &tests)) break;
    }
}
