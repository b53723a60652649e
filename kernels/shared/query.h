// Questions about features and triangles outside a cloth's step, and about a mesh against itself, with their answers.
// The same declarations serve C++ and OpenCL C: 32-bit scalars only, no padding.
#ifndef DRAPE_SHARED_QUERY_H
#define DRAPE_SHARED_QUERY_H

#include "types.h"

DRAPE_NAMESPACE_BEGIN

// Kinds of feature pairs.
#define DRAPE_VERTEX_FACE 0u
#define DRAPE_EDGES 1u

// Do four moving vertices touch: a vertex and a face, or two edges?
typedef struct CcdQuery
{
    float m_start[12];  // m, x y z of the four at the step's start
    float m_end[12];
    DRAPE_UINT m_kind;
} CcdQuery;

// How continuous collision searches; see kernels/lib/ccd.h for the defaults.
typedef struct CcdSettings
{
    float m_separation;     // m, ≥ 0: features this near count as touching
    float m_tolerance;      // of the offset relative to the pair's extent: what varies less is not halved
    float m_timeTolerance;  // of the step: the time is searched to this; 1: any hit will do and its time is 0
    DRAPE_UINT m_boxLimit;  // boxes looked at before a search ends with the safe answer, a hit
} CcdSettings;

typedef struct CcdResult
{
    DRAPE_UINT m_hit;
    float m_time;        // part of the step, ≤ the true time of impact; 1 without a hit
    float m_u, m_v;      // where on the features: see ccdVectors
    DRAPE_UINT m_boxes;  // looked at, the cost
} CcdResult;

typedef struct TriangleQuery
{
    float m_a[9];  // m, x y z of three corners
    float m_b[9];
} TriangleQuery;

// Which test answers a TriangleQuery on the device.
#define DRAPE_TEST_CERTIFIED 0u
#define DRAPE_TEST_MOLLER 1u

// A vertex and a face, or two edges, of a mesh against itself.
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
    float m_time;  // of impact, part of the step
} FeatureHit;

// A pair of triangles that meets or is near, as bits of kernels/lib/triangle_pair.h.
typedef struct PairAnswer
{
    DRAPE_UINT m_a;
    DRAPE_UINT m_b;
    DRAPE_UINT m_bits;
} PairAnswer;

// Demands: they count on when a list is full, up to DRAPE_DEMAND_LIMIT, beyond which they only say "too many".
typedef struct SelfCounters
{
    DRAPE_UINT m_pairs;
    DRAPE_UINT m_vertexFace;
    DRAPE_UINT m_edgeEdge;
    DRAPE_UINT m_hits;
    DRAPE_UINT m_tooDeep;  // hierarchies too deep for the traversal's stack
} SelfCounters;

// Far above what a list holds, and so far below 2^32 that additions under way cannot wrap around.
#define DRAPE_DEMAND_LIMIT 0x80000000u

DRAPE_NAMESPACE_END

#endif
