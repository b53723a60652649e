// Self collision of a moving mesh: volumes of its vertices, pairs of its triangles, pairs of features, and the pairs
// that touch during the step. Lists are filled in no particular order. Their demands must be zero before, and count on
// when a list is full (see SelfCounters).
#include "../lib/broad_phase/leaf_walk.h"
#include "../lib/work_items/item_runs.h"
#include "queries_bindings.h"

// Pairs that a work-item gathers before it reserves room for them with one atomic.
#define DRAPE_SELF_GATHER 16

// Reserves room for count entries of a list. Returns false if the demand has reached `enough`, beyond which nothing is
// counted.
static int reserveEntries(__global volatile uint* demand, const uint count, const uint enough, uint* index)
{
    if (*demand >= enough) return 0;
    *index = atomic_add(demand, count);
    return 1;
}

static int flushPairs(__global Candidate* restrict pairs, const uint capacity, const uint enough,
                      __global SelfCounters* restrict counters, const Candidate* gathered, const uint count)
{
    uint index;
    if (!reserveEntries(&counters->m_pairs, count, enough, &index)) return 0;
    for (uint i = 0; i < count; ++i)
    {
        if (index + i < capacity) pairs[index + i] = gathered[i];
    }
    return 1;
}

// Writes the volume of a vertex over the step, one per work-item.
__kernel void selfVolumes(DRAPE_SELF_VOLUMES)
{
    const uint i = get_global_id(0);
    if (i >= values.m_vertexCount) return;
    Dop dop;
    vertexVolume(&dop, start, end, i, values.m_radius);
    volumes[i] = dop;
}

static WalkSide walkSide(__global const BvhNode* nodes, __global const uint* order, __global const Triangle* triangles)
{
    WalkSide side;
    side.m_nodes = nodes;
    side.m_order = order;
    side.m_triangles = triangles;
    return side;
}

// Lists the pairs of a leaf's triangle with the leaves of tree b whose volumes overlap. A work-item takes one of the
// leaves of side a. a and b are equal for a mesh with itself. Work-items stop once enough pairs are counted.
__kernel void leafTraverse(DRAPE_LEAF_TRAVERSE)
{
    if (get_global_id(0) >= values.m_leafCount) return;
    const WalkSide a = walkSide(nodesA, orderA, trianglesA), b = walkSide(nodesB, orderB, trianglesB);
    const uint capacity = values.m_capacity, enough = values.m_enough;
    Candidate gathered[DRAPE_SELF_GATHER];
    uint count = 0;
    LeafWalk walk;
    leafWalkStart(&walk, values.m_firstLeaf + get_global_id(0), values.m_root);
    while (leafWalkNext(&walk, &a, &b, values.m_kind, lastLeaf, gathered + count))
    {
        if (++count < DRAPE_SELF_GATHER) continue;
        if (!flushPairs(pairs, capacity, enough, counters, gathered, count)) return;
        count = 0;
    }
    if (count > 0) flushPairs(pairs, capacity, enough, counters, gathered, count);
    if (walk.m_tooDeep) atomic_inc(&counters->m_tooDeep);
}

static void storePairs(__global FeaturePair* restrict list, const uint capacity, __global volatile uint* demand,
                       const FeaturePair* pairs, const uint count)
{
    uint index;
    if (count == 0 || !reserveEntries(demand, count, DRAPE_DEMAND_LIMIT, &index)) return;
    for (uint i = 0; i < count; ++i)
    {
        if (index + i < capacity) list[index + i] = pairs[i];
    }
}

// Lists the overlapping pairs of features that the pairs of triangles own. A work-item processes its part of the pairs
// of triangles.
__kernel void selfFeatures(DRAPE_SELF_FEATURES)
{
    const uint count = min(counters->m_pairs, values.m_pairCapacity);
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        FeaturePairs found;
        collectFeaturePairs(&found, triangles, pairs[runs.m_item], volumes);
        storePairs(vertexFace, values.m_vertexFaceCapacity, &counters->m_vertexFace, found.m_vertexFace,
                   found.m_vertexFaceCount);
        storePairs(edges, values.m_edgeCapacity, &counters->m_edgeEdge, found.m_edges, found.m_edgesCount);
    }
}

// Tests the pairs of one kind, each work-item its part, and lists those that touch during the step.
__kernel void selfTest(DRAPE_SELF_TEST)
{
    const uint demand = values.m_kind == DRAPE_VERTEX_FACE ? counters->m_vertexFace : counters->m_edgeEdge;
    const uint count = min(demand, values.m_pairCapacity);
    for (ItemRuns runs = itemRuns(count, 1); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        FeatureHit hit;
        if (!featurePairHit(values.m_kind, pairs[i], triangles, edges, start, end, values.m_settings, &hit)) continue;
        const uint index = atomic_inc(&counters->m_hits);
        if (index < values.m_hitCapacity) hits[index] = hit;
    }
}
