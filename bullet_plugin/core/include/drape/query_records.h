// Questions about moving features and single triangles, with their answers: the records of drape/queries.h.
//
// The same declarations serve C++ and OpenCL C, so that a device reads what a caller wrote: 32-bit scalars only, no
// padding. Lengths in metres. Needs no other header. C++11.
#ifndef DRAPE_QUERY_RECORDS_H
#define DRAPE_QUERY_RECORDS_H

#ifdef __cplusplus
namespace drape
{
#endif

// Kinds of feature pairs.
#define DRAPE_VERTEX_FACE 0u
#define DRAPE_EDGES 1u

// Do four moving vertices touch: a vertex and a face, or two edges?
typedef struct CcdQuery
{
    float m_start[12];  // m, x y z of the four at the step's start: the vertex and the face's, or edge by edge
    float m_end[12];
    unsigned int m_kind;  // DRAPE_VERTEX_FACE or DRAPE_EDGES
} CcdQuery;

// How continuous collision searches; defaultCcdSettings() has the working defaults.
typedef struct CcdSettings
{
    float m_separation;       // m, ≥ 0: features this near count as touching
    float m_tolerance;        // of the pair's extent: where the features' offset varies by less, they touch
    float m_timeTolerance;    // of the step: the time is searched to this; 1: any hit will do and its time is 0
    unsigned int m_boxLimit;  // boxes looked at before a search ends with the safe answer, a hit
} CcdSettings;

typedef struct CcdResult
{
    unsigned int m_hit;  // 1: they touch, or nearly (m_tolerance); 0: proved apart
    float m_time;        // part of the step, ≤ the true time of impact; 1 without a hit
    float m_u, m_v;  // where they touch: weights of the face's second and third corner, or of the edges' second ends
    unsigned int m_boxes;  // looked at, the cost
} CcdResult;

typedef struct TriangleQuery
{
    float m_a[9];  // m, x y z of three corners
    float m_b[9];
} TriangleQuery;

#ifdef __cplusplus
}
#endif

#endif
