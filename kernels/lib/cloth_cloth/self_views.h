// Data of cloths that collide with themselves as the kernels' functions take it.
#ifndef DRAPE_LIB_SELF_VIEWS_H
#define DRAPE_LIB_SELF_VIEWS_H

#include "self_contact.h"

DRAPE_NAMESPACE_BEGIN

// Pairs of patches that lie so smoothly that no contact is between them (core/cloth_cloth/smooth_pairs.h), on the host.
typedef struct SmoothView
{
    const DRAPE_GLOBAL DRAPE_UINT*
        m_first;  // first pair of each patch, then the number of pairs; null if none is known
    const DRAPE_GLOBAL DRAPE_UINT* m_others;       // by pair: the patch itself or a later one, ascending
    const DRAPE_GLOBAL unsigned char* m_isSmooth;  // by pair
} SmoothView;

// Returns whether a patch lies smoothly with itself or a later one.
DRAPE_FUNCTION int liesSmoothly(const SmoothView* pairs, DRAPE_UINT patch, DRAPE_UINT later)
{
    if (!pairs->m_first) return 0;
    for (DRAPE_UINT i = pairs->m_first[patch]; i < pairs->m_first[patch + 1]; ++i)
        if (pairs->m_others[i] == later) return pairs->m_isSmooth[i];
    return 0;
}

// The cloths' own patches, and their features' boxes over the step. Ids are those of the lanes' features,
// DRAPE_NO_FEATURE where there is none.
typedef struct SelfPatches
{
    const DRAPE_GLOBAL Patch* m_patches;
    DRAPE_UINT m_patchCount;
    DRAPE_UINT m_entries;  // positions in the wide tree's lowest level
    const DRAPE_GLOBAL DRAPE_UINT* m_faceIds;
    const DRAPE_GLOBAL DRAPE_UINT* m_vertexIds;
    const DRAPE_GLOBAL DRAPE_UINT* m_edgeIds;
    const DRAPE_GLOBAL DRAPE_UINT* m_faceNodes;  // on a CPU: a row of lanes for each node of a block's features
    const DRAPE_GLOBAL DRAPE_UINT* m_edgeNodes;
    const DRAPE_GLOBAL DRAPE_UINT* m_levels;  // first node of each level of the wide tree, lowest first
    DRAPE_UINT m_levelCount;
    DRAPE_GLOBAL float* m_faceBoxes;    // on a CPU
    DRAPE_GLOBAL float* m_vertexBoxes;  // on a GPU by node
    DRAPE_GLOBAL float* m_edgeBoxes;    // on a CPU
    DRAPE_GLOBAL float* m_wideNodes;
    SmoothView m_smooth;
} SelfPatches;

// Lengths per cloth, m: half the reach (negative: no self collision in the step), the thickness, the reach of the
// obstacle search.
typedef struct SelfRadii
{
    const DRAPE_GLOBAL float* m_radius;
    const DRAPE_GLOBAL float* m_thickness;
    const DRAPE_GLOBAL float* m_obstacleRadius;
} SelfRadii;

// Input of the narrow phase: the first m_count of m_tests.
typedef struct SelfInput
{
    const DRAPE_GLOBAL FeatureTest* m_tests;
    DRAPE_UINT m_count;
    SelfView m_view;
    DRAPE_UINT m_firstFeature;  // see featureCountOf()
} SelfInput;

// Returns the positions at which volumes over the step begin: those of the end in a discrete step.
DRAPE_FUNCTION const DRAPE_GLOBAL float* volumeStart(const ClothView* cloth)
{
    return cloth->m_mode == DRAPE_DISCRETE ? cloth->m_end : cloth->m_start;
}

DRAPE_NAMESPACE_END

#endif
