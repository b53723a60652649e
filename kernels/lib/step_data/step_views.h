// A step's data as the kernels' functions take it: on a device parts of the arenas (arena_views.h), on the host its
// own arrays.
#ifndef DRAPE_LIB_STEP_VIEWS_H
#define DRAPE_LIB_STEP_VIEWS_H

#include "../../shared/contact.h"
#include "../../shared/motion.h"
#include "../../shared/patch.h"

DRAPE_NAMESPACE_BEGIN

typedef struct ClothView
{
    const DRAPE_GLOBAL float* m_start;  // m, x y z per node
    const DRAPE_GLOBAL float* m_end;
    const DRAPE_GLOBAL Triangle* m_triangles;
    const DRAPE_GLOBAL Edge* m_edges;
    DRAPE_UINT m_nodeCount;
    DRAPE_UINT m_triangleCount;
    DRAPE_UINT m_mode;                            // DRAPE_DISCRETE …
    DRAPE_UINT* m_searches;                       // see PairBounds
    const DRAPE_GLOBAL ObstacleMotion* m_motion;  // motion of the current obstacle; null if it rests
} ClothView;

typedef struct ObstacleView
{
    const DRAPE_GLOBAL float* m_positions;  // m, x y z per vertex
    const DRAPE_GLOBAL Triangle* m_triangles;
    const DRAPE_GLOBAL NormalCone* m_vertexCones;
    const DRAPE_GLOBAL NormalCone* m_edgeCones;
} ObstacleView;

DRAPE_FUNCTION ClothView clothView(const DRAPE_GLOBAL float* start, const DRAPE_GLOBAL float* end,
                                   const DRAPE_GLOBAL Triangle* triangles, const DRAPE_GLOBAL Edge* edges,
                                   DRAPE_UINT nodeCount, DRAPE_UINT triangleCount, DRAPE_UINT mode,
                                   DRAPE_UINT* searches)
{
    ClothView view;
    view.m_start = start;
    view.m_end = end;
    view.m_triangles = triangles;
    view.m_edges = edges;
    view.m_nodeCount = nodeCount;
    view.m_triangleCount = triangleCount;
    view.m_mode = mode;
    view.m_searches = searches;
    view.m_motion = 0;
    return view;
}

DRAPE_FUNCTION ObstacleView obstacleView(const DRAPE_GLOBAL float* positions, const DRAPE_GLOBAL Triangle* triangles,
                                         const DRAPE_GLOBAL NormalCone* vertexCones,
                                         const DRAPE_GLOBAL NormalCone* edgeCones)
{
    ObstacleView view;
    view.m_positions = positions;
    view.m_triangles = triangles;
    view.m_vertexCones = vertexCones;
    view.m_edgeCones = edgeCones;
    return view;
}

// The cloths of a step and their pairs.
typedef struct StepCloths
{
    ClothView m_cloth;
    const DRAPE_GLOBAL DRAPE_UINT* m_order;  // triangles, patch by patch
    DRAPE_UINT m_count;                      // number of them in the step
    const DRAPE_GLOBAL float* m_radius;      // m, per cloth, negative for cloths outside the step
    const DRAPE_GLOBAL float* m_thickness;   // m, cloths × obstacles, negative for untested pairs
    DRAPE_UINT m_obstacleMeshes;
    float m_reachScale;
    const DRAPE_GLOBAL ObstacleMotion* m_motions;  // motions of the moving obstacles
    DRAPE_UINT m_motionCount;
} StepCloths;

// The obstacles' patches, packed (shared/patch.h), and the wide tree over them.
typedef struct PackedPatches
{
    const DRAPE_GLOBAL Patch* m_patches;
    const DRAPE_GLOBAL DRAPE_UINT* m_levels;  // first node of each of m_levelCount levels, lowest first
    DRAPE_UINT m_levelCount;
    const DRAPE_GLOBAL float* m_wideNodes;
    const DRAPE_GLOBAL float* m_sizes;    // m
    const DRAPE_GLOBAL float* m_volumes;  // on a CPU
    const DRAPE_GLOBAL float* m_faces;
    const DRAPE_GLOBAL float* m_vertices;
    const DRAPE_GLOBAL float* m_edges;
    const DRAPE_GLOBAL DRAPE_UINT* m_faceIds;  // the triangle, vertex or edge of each lane
    const DRAPE_GLOBAL DRAPE_UINT* m_vertexIds;
    const DRAPE_GLOBAL DRAPE_UINT* m_edgeIds;
    const DRAPE_GLOBAL DRAPE_UINT* m_faceFeatures;  // on a GPU
} PackedPatches;

// A list of feature tests that a cull fills. m_count counts on when the list is full, up to about m_limit.
typedef struct TestList
{
    DRAPE_GLOBAL FeatureTest* m_tests;
    DRAPE_UINT m_capacity, m_limit;
    volatile DRAPE_GLOBAL DRAPE_UINT* m_count;
} TestList;

// A step's list of unsorted contacts; ordering sorts it into canonical order. m_found counts on when the list is full.
// All numbers must be zero before the step's first kernel that lists contacts. Where features are few on a GPU the
// sums of the numbers are kept, too, and for each contact the number of its feature's contacts before it; elsewhere
// m_ranks and m_sums are null.
typedef struct ContactSink
{
    DRAPE_GLOBAL Contact* m_contacts;
    DRAPE_UINT m_capacity;
    DRAPE_GLOBAL DRAPE_UINT* m_ranks;
    volatile DRAPE_GLOBAL DRAPE_UINT* m_featureCounts;  // contacts listed of each cloth feature
    volatile DRAPE_GLOBAL DRAPE_UINT* m_sums;           // DRAPE_FEATURE_SUMS
    volatile DRAPE_GLOBAL DRAPE_UINT* m_found;
} ContactSink;

// Input of the narrow phase: the first m_count of m_tests.
typedef struct FeatureInput
{
    const DRAPE_GLOBAL FeatureTest* m_tests;
    DRAPE_UINT m_count;
    ClothView m_cloth;
    ObstacleView m_obstacle;
    PackedPatches m_patches;
    const DRAPE_GLOBAL ObstacleMotion* m_motions;
} FeatureInput;

DRAPE_NAMESPACE_END

#endif
