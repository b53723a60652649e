// Tests that answer triangle queries, and collisions of a mesh with itself. A public header declares the queries that
// a caller may make. The same declarations serve C++ and OpenCL C: 32-bit scalars only, no padding.
#ifndef DRAPE_SHARED_QUERY_H
#define DRAPE_SHARED_QUERY_H

#include "../../bullet_plugin/include/drape/query_records.h"
#include "types.h"

DRAPE_NAMESPACE_BEGIN

// A vertex and a face, or two edges, of one mesh.
typedef struct FeaturePair
{
    DRAPE_UINT m_a;
    DRAPE_UINT m_b;
} FeaturePair;

typedef struct FeatureHit
{
    DRAPE_UINT m_kind;
    DRAPE_UINT m_a;
    DRAPE_UINT m_b;
    float m_time;  // time of impact, fraction of the step
} FeatureHit;

// A pair of triangles that meets or is near, as bits of kernels/lib/queries/triangle_pair.h.
typedef struct PairAnswer
{
    DRAPE_UINT m_a;
    DRAPE_UINT m_b;
    DRAPE_UINT m_bits;
} PairAnswer;

// Demands count on when a list is full, up to DRAPE_DEMAND_LIMIT, beyond which they only say "too many".
typedef struct SelfCounters
{
    DRAPE_UINT m_pairs;
    DRAPE_UINT m_vertexFace;
    DRAPE_UINT m_edgeEdge;
    DRAPE_UINT m_hits;
    DRAPE_UINT m_tooDeep;  // hierarchies too deep for the traversal's stack
} SelfCounters;

// Count far above any list's length, and so far below 2^32 that concurrent additions cannot wrap around.
#define DRAPE_DEMAND_LIMIT 0x80000000u

DRAPE_NAMESPACE_END

#endif
