// Arguments of the kernels of the queries (shared/bindings.h).
//
// nodes, order, triangles: a hierarchy and its triangles; lastLeaf: see leafWalkNext(). start, end: m, x y z per
// vertex. counters of traversals: demands count on when a list is full (see SelfCounters).
#ifndef DRAPE_QUERIES_BINDINGS_H
#define DRAPE_QUERIES_BINDINGS_H

#include "../lib/geometry/dop.h"
#include "../shared/bindings.h"
#include "../shared/mesh.h"
#include "../shared/query.h"

DRAPE_NAMESPACE_BEGIN

typedef struct MotionValues
{
    CcdSettings m_settings;
    DRAPE_UINT m_count;  // queries
} MotionValues;

typedef struct PairQueryValues
{
    DRAPE_UINT m_count;  // pairs
    float m_radius;      // m; pairs within it count, too; none if negative
    DRAPE_UINT m_capacity;
} PairQueryValues;

typedef struct TraverseValues
{
    DRAPE_UINT m_firstLeaf, m_leafCount;  // leaves of side a
    DRAPE_UINT m_root;                    // root of side b
    DRAPE_UINT m_kind;                    // DRAPE_WALK_…
    DRAPE_UINT m_capacity;
    DRAPE_UINT m_enough;  // pairs at which the traversal ends, at most DRAPE_DEMAND_LIMIT
} TraverseValues;

typedef struct SelfFeaturesValues
{
    DRAPE_UINT m_pairCapacity;
    DRAPE_UINT m_vertexFaceCapacity;
    DRAPE_UINT m_edgeCapacity;
} SelfFeaturesValues;

typedef struct SelfTestValues
{
    CcdSettings m_settings;
    DRAPE_UINT m_kind;
    DRAPE_UINT m_pairCapacity;
    DRAPE_UINT m_hitCapacity;
} SelfTestValues;

typedef struct VolumeValues
{
    DRAPE_UINT m_vertexCount;
    float m_radius;  // m
} VolumeValues;

// A run of nodes or leaves.
typedef struct NodeRange
{
    DRAPE_UINT m_first, m_count;
} NodeRange;

DRAPE_NAMESPACE_END

#define DRAPE_QUERY_MOTION \
    DRAPE_VALUE(MotionValues, values), DRAPE_READS(CcdQuery, queries), DRAPE_WRITES(CcdResult, results)
#define DRAPE_QUERY_TRIANGLES \
    DRAPE_VALUE(DRAPE_UINT, count), DRAPE_READS(TriangleQuery, queries), DRAPE_WRITES(DRAPE_UINT, results)
#define DRAPE_QUERY_PAIRS                                                                                     \
    DRAPE_VALUE(PairQueryValues, values), DRAPE_READS(Candidate, pairs), DRAPE_READS(float, positionsA),      \
        DRAPE_READS(Triangle, trianglesA), DRAPE_READS(float, positionsB), DRAPE_READS(Triangle, trianglesB), \
        DRAPE_WRITES(PairAnswer, answers), DRAPE_UPDATES(DRAPE_UINT, demand)
#define DRAPE_REFIT_LEAVES                                                                        \
    DRAPE_VALUE(NodeRange, leaves), DRAPE_WRITES(BvhNode, nodes), DRAPE_READS(DRAPE_UINT, order), \
        DRAPE_READS(Triangle, triangles), DRAPE_READS(float, start), DRAPE_READS(float, end),     \
        DRAPE_READS(float, meshRadius), DRAPE_UPDATES(StepCounters, counters)
#define DRAPE_REFIT_LEVEL DRAPE_VALUE(NodeRange, range), DRAPE_WRITES(BvhNode, nodes)
#define DRAPE_REFIT_TOP \
    DRAPE_VALUE(DRAPE_UINT, levelCount), DRAPE_UPDATES(BvhNode, nodes), DRAPE_READS(NodeRange, levels)
#define DRAPE_SELF_VOLUMES \
    DRAPE_VALUE(VolumeValues, values), DRAPE_READS(float, start), DRAPE_READS(float, end), DRAPE_WRITES(Dop, volumes)
#define DRAPE_LEAF_TRAVERSE                                                                                   \
    DRAPE_VALUE(TraverseValues, values), DRAPE_READS(BvhNode, nodesA), DRAPE_READS(DRAPE_UINT, orderA),       \
        DRAPE_READS(Triangle, trianglesA), DRAPE_READS(BvhNode, nodesB), DRAPE_READS(DRAPE_UINT, orderB),     \
        DRAPE_READS(Triangle, trianglesB), DRAPE_READS(DRAPE_UINT, lastLeaf), DRAPE_WRITES(Candidate, pairs), \
        DRAPE_UPDATES(SelfCounters, counters)
#define DRAPE_SELF_FEATURES                                                                                   \
    DRAPE_VALUE(SelfFeaturesValues, values), DRAPE_READS(Candidate, pairs), DRAPE_READS(Triangle, triangles), \
        DRAPE_READS(Dop, volumes), DRAPE_WRITES(FeaturePair, vertexFace), DRAPE_WRITES(FeaturePair, edges),   \
        DRAPE_UPDATES(SelfCounters, counters)
#define DRAPE_SELF_TEST                                                                                               \
    DRAPE_VALUE(SelfTestValues, values), DRAPE_READS(FeaturePair, pairs), DRAPE_READS(Triangle, triangles),           \
        DRAPE_READS(Edge, edges), DRAPE_READS(float, start), DRAPE_READS(float, end), DRAPE_WRITES(FeatureHit, hits), \
        DRAPE_UPDATES(SelfCounters, counters)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(queryMotion, DRAPE_QUERY_MOTION)
DRAPE_BIND(queryTriangles, DRAPE_QUERY_TRIANGLES)
DRAPE_BIND(queryPairs, DRAPE_QUERY_PAIRS)
DRAPE_BIND(refitLeaves, DRAPE_REFIT_LEAVES)
DRAPE_BIND(refitLevel, DRAPE_REFIT_LEVEL)
DRAPE_BIND(refitTop, DRAPE_REFIT_TOP)
DRAPE_BIND(selfVolumes, DRAPE_SELF_VOLUMES)
DRAPE_BIND(leafTraverse, DRAPE_LEAF_TRAVERSE)
DRAPE_BIND(selfFeatures, DRAPE_SELF_FEATURES)
DRAPE_BIND(selfTest, DRAPE_SELF_TEST)
}  // namespace drape::kernels
#endif

#endif
