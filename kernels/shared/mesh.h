// Topology and hierarchy records that host and device share. 32-bit scalars only, no padding.
#ifndef DRAPE_SHARED_MESH_H
#define DRAPE_SHARED_MESH_H

#include "types.h"

DRAPE_NAMESPACE_BEGIN

// Bit i of Triangle::m_owned: the triangle owns its vertex i; bit 3 + i: it owns its edge i. Every vertex and edge has
// one owner, so a feature pair is tested in exactly one pair of triangles.
#define DRAPE_OWNS_VERTEX(i) (1u << (i))
#define DRAPE_OWNS_EDGE(i) (8u << (i))

typedef struct Triangle
{
    DRAPE_UINT m_vertices[3];  // over all meshes of the side
    DRAPE_UINT m_edges[3];     // edge i joins vertices i and (i + 1) % 3
    DRAPE_UINT m_owned;
    DRAPE_UINT m_mesh;  // slot of the mesh in this side's pool
} Triangle;

// An edge and the third vertices of two triangles that share it (both the same for a boundary edge).
typedef struct Edge
{
    DRAPE_UINT m_vertices[2];
    DRAPE_UINT m_opposite[2];
} Edge;

// Offsets of a mesh's vertices, triangles and edges among those of its side, per slot.
typedef struct MeshOffsets
{
    DRAPE_UINT m_vertex;
    DRAPE_UINT m_triangle;
    DRAPE_UINT m_edge;
} MeshOffsets;

// Directions in which a surface can face at a vertex or edge: all within the half-angle of the axis or of its opposite.
// A cosine of -1 admits every direction (boundary, non-manifold or degenerate surroundings). The axis leans to the
// front; zero if there is no front.
typedef struct NormalCone
{
    Vec3 m_axis;     // unit
    float m_cosine;  // cosine of the half-angle
} NormalCone;

// Half the volumes' sides: 9 by default, 3, 7 or 13 by an option of the host's build, passed on to
// the kernels' programs.
#ifndef DRAPE_DOP_DIRECTIONS
#define DRAPE_DOP_DIRECTIONS 9
#endif

// A node's volume is the interval [m_low, m_high] in each direction. Children are adjacent: m_first … m_first + m_count
// - 1. A leaf has m_count 0, and m_first is its position in the order of primitives.
typedef struct BvhNode
{
    float m_low[DRAPE_DOP_DIRECTIONS];
    float m_high[DRAPE_DOP_DIRECTIONS];
    DRAPE_UINT m_first;
    DRAPE_UINT m_count;
} BvhNode;

// Depth of the stack of a traversal of one hierarchy. Each step opens one node and leaves at most one behind, and a
// balanced hierarchy over fewer than 2^32 primitives is 32 high.
#define DRAPE_STACK_DEPTH 72

typedef struct Candidate
{
    DRAPE_UINT m_cloth;     // triangle
    DRAPE_UINT m_obstacle;  // triangle
} Candidate;

// Treatment of the cloth's motion in a step; see Settings::m_mode.
#define DRAPE_DISCRETE 0u
#define DRAPE_CONTINUOUS 1u
#define DRAPE_AUTOMATIC 2u

// Numbers that a step counts on the device. Demands count on when a buffer is full, so the host learns the true size.
typedef struct StepCounters
{
    DRAPE_UINT m_candidates;
    DRAPE_UINT m_contactsFound;   // counts on when the list is full
    DRAPE_UINT m_crowded;         // features with too many contacts for counting (ordering.cl, ordering_small.cl)
    DRAPE_UINT m_contactsStored;  // contacts in the list
    DRAPE_UINT m_invalidNodes;
    DRAPE_UINT m_swept;       // pairs of features that the continuous test decided
    DRAPE_UINT m_patchPairs;  // listed pairs of cloth triangles and patches
    DRAPE_UINT m_selfPairs;   // listed pairs of patches of cloths with themselves
    DRAPE_UINT m_selfTests;   // pairs of features of cloths with themselves
    DRAPE_UINT m_selfSwept;   // pairs in m_selfTests that the continuous test decided
} StepCounters;

DRAPE_NAMESPACE_END

#endif
