// Records of questions about moving features and triangles, and of their answers; see drape/queries.h.
//
// C++ and OpenCL C share these declarations, so that a device reads what the caller wrote: 32-bit scalars only, no
// padding. Lengths are metres. Needs no other header. C++11.
#ifndef DRAPE_QUERY_RECORDS_H
#define DRAPE_QUERY_RECORDS_H

#ifdef __cplusplus
namespace drape
{
#endif

// Kind of a feature pair: a vertex and a face.
#define DRAPE_VERTEX_FACE 0u
// Kind of a feature pair: two edges.
#define DRAPE_EDGES 1u

// Asks if two moving features touch: a vertex and a face, or two edges.
typedef struct CcdQuery
{
    // x y z of the four vertices at the step's start, m: the vertex and the face's corners, or edge by edge.
    float m_start[12];
    // x y z of the four vertices at the step's end, m, in the order of m_start.
    float m_end[12];
    // DRAPE_VERTEX_FACE or DRAPE_EDGES.
    unsigned int m_kind;
} CcdQuery;

// Parameters of the continuous search; defaultCcdSettings() returns working defaults.
typedef struct CcdSettings
{
    // Distance at which features count as touching, m, ≥ 0.
    float m_separation;
    // Variation of the features' offset below which they count as touching, relative to the pair's extent.
    float m_tolerance;
    // Resolution of the time of impact, as a fraction of the step. With 1 any hit ends the search and its time is 0.
    float m_timeTolerance;
    // Number of boxes after which the search ends with the safe answer, a hit.
    unsigned int m_boxLimit;
} CcdSettings;

// Answers a CcdQuery.
typedef struct CcdResult
{
    // 1 if the features touch or nearly touch (m_tolerance); 0 if they are proved apart.
    unsigned int m_hit;
    // Fraction of the step, never later than the true time of impact; 1 without a hit.
    float m_time;
    // Weight of the face's second corner, or of the first edge's second end, at the impact.
    float m_u;
    // Weight of the face's third corner, or of the second edge's second end, at the impact.
    float m_v;
    // Number of boxes that the search examined, its cost.
    unsigned int m_boxes;
} CcdResult;

// Asks if two triangles intersect.
typedef struct TriangleQuery
{
    // x y z of the first triangle's corners, m.
    float m_a[9];
    // x y z of the second triangle's corners, m.
    float m_b[9];
} TriangleQuery;

// Two triangles by index: one of each mesh, or two of the same mesh with the lower index first. Edges of
// MeshDescription::m_edges are triangles without area, numbered behind the triangles.
typedef struct NearTriangles
{
    unsigned int m_a;  // index in the first mesh
    unsigned int m_b;  // index in the second mesh
} NearTriangles;

// Two features that touch during a step.
typedef struct TouchingFeatures
{
    // DRAPE_VERTEX_FACE or DRAPE_EDGES.
    unsigned int m_kind;
    // Vertex indices in the order of CcdQuery.
    unsigned int m_vertices[4];
    // Time of impact, as a fraction of the step.
    float m_time;
} TouchingFeatures;

#ifdef __cplusplus
}
#endif

#endif
