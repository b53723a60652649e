// Layouts of the device's arenas. An arena is one allocation that holds all arrays of a subject, so that a kernel takes
// the subject as one argument. A layout gives the position of each array, in words of 32 bits from the arena's begin.
// Each arena has a word type of its own: a kernel cannot take one arena for another.
#ifndef DRAPE_SHARED_ARENAS_H
#define DRAPE_SHARED_ARENAS_H

#include "types.h"

DRAPE_NAMESPACE_BEGIN

typedef struct ClothWord
{
    DRAPE_UINT m_bits;
} ClothWord;
typedef struct ObstacleWord
{
    DRAPE_UINT m_bits;
} ObstacleWord;
typedef struct PatchWord
{
    DRAPE_UINT m_bits;
} PatchWord;

// The cloths' topology, and the nodes that lie in a buffer of their own: x y z at the step's start, then from m_end on
// at its end.
typedef struct ClothLayout
{
    DRAPE_UINT m_triangles;  // Triangle
    DRAPE_UINT m_edges;      // Edge
    DRAPE_UINT m_order;      // uint: triangles, patch by patch
    DRAPE_UINT m_end;        // floats
    DRAPE_UINT m_nodeCount;
    DRAPE_UINT m_triangleCount;
    DRAPE_UINT m_edgeCount;
} ClothLayout;

// The obstacles' geometry in world coordinates, or in their own frames, which has no triangles.
typedef struct ObstacleLayout
{
    DRAPE_UINT m_positions;    // float: x y z
    DRAPE_UINT m_vertexCones;  // NormalCone
    DRAPE_UINT m_edgeCones;    // NormalCone
    DRAPE_UINT m_triangles;    // Triangle
} ObstacleLayout;

// The obstacles' patches and the wide tree over them (shared/patch.h).
typedef struct PatchLayout
{
    DRAPE_UINT m_patches;    // Patch
    DRAPE_UINT m_sizes;      // float: m, of each patch
    DRAPE_UINT m_volumes;    // float: volumes of the patches, side by side; on a CPU
    DRAPE_UINT m_wideNodes;  // float
    DRAPE_UINT m_levels;     // uint: first node of each level, lowest first
    DRAPE_UINT m_levelCount;
    DRAPE_UINT m_faces;         // float: blocks
    DRAPE_UINT m_vertices;      // float
    DRAPE_UINT m_edges;         // float
    DRAPE_UINT m_faceIds;       // uint: triangle of each lane
    DRAPE_UINT m_vertexIds;     // uint
    DRAPE_UINT m_edgeIds;       // uint
    DRAPE_UINT m_faceFeatures;  // uint: see DRAPE_FEATURES_OWNED; on a GPU
} PatchLayout;

// The patches of cloths that collide with themselves, and their features' boxes over the step.
typedef struct SelfPatchLayout
{
    DRAPE_UINT m_patches;  // Patch
    DRAPE_UINT m_patchCount;
    DRAPE_UINT m_entries;    // number of positions in the wide tree's lowest level
    DRAPE_UINT m_faceIds;    // uint
    DRAPE_UINT m_vertexIds;  // uint
    DRAPE_UINT m_edgeIds;    // uint
    DRAPE_UINT m_faceNodes;  // uint: see faceNodesOf(); on a CPU
    DRAPE_UINT m_edgeNodes;  // uint
    DRAPE_UINT m_levels;     // uint
    DRAPE_UINT m_levelCount;
    DRAPE_UINT m_faceBoxes;    // float: on a CPU
    DRAPE_UINT m_vertexBoxes;  // float: on a GPU by node
    DRAPE_UINT m_edgeBoxes;    // float: on a CPU
    DRAPE_UINT m_wideNodes;    // float
} SelfPatchLayout;

DRAPE_NAMESPACE_END

#endif
