// Patches: runs of neighbouring obstacle triangles, with their features packed side by side, and the wide tree over the
// patches. All lists come in blocks of DRAPE_PATCH_WIDTH lanes, component by component, so that a work-group's lanes,
// or a vector's, read adjacent words.
#ifndef DRAPE_SHARED_PATCH_H
#define DRAPE_SHARED_PATCH_H

#include "mesh.h"

DRAPE_NAMESPACE_BEGIN

// Triangles in a patch, lanes in a block and children of a wide node: a vector of a CPU. GPUs build with a warp's 32.
#ifndef DRAPE_PATCH_WIDTH
#define DRAPE_PATCH_WIDTH 16
#endif

typedef struct Patch
{
    DRAPE_UINT m_vertexBlock;  // first of m_vertexBlocks blocks of vertices owned by the patch's triangles
    DRAPE_UINT m_vertexBlocks;
    DRAPE_UINT m_edgeBlock;
    DRAPE_UINT m_edgeBlocks;
    DRAPE_UINT m_mesh;  // slot of the obstacle: a patch belongs to one
} Patch;

// Floats per lane of a block.
// Face: corners a, b, c (x y z each), spread. Vertex: position, cone axis, cone cosine. Edge: ends a, b, cone axis,
// cosine.
#define DRAPE_FACE_FLOATS 10
#define DRAPE_VERTEX_FLOATS 7
#define DRAPE_EDGE_FLOATS 10
// Spread of a face: largest ratio of a node's distance beside the face to its height above it that a cone of the
// face's edges or corners admits. DRAPE_ANY_SPREAD: no bound; cones admit directions in or near the face's plane.
#define DRAPE_ANY_SPREAD 1e18f
// Size of a child of a wide node: for every direction low, high, and the reach of a contact as a share of the full
// reach (lib/broad_phase/cone_reach.h).
#define DRAPE_WIDE_NODE_FLOATS (3 * DRAPE_DOP_DIRECTIONS)

// Size of a feature's box over the step, low then high, of a cloth that collides with itself.
#define DRAPE_BOX_FLOATS 6

// A lane's owner: a triangle that owns its feature in the low bits, the feature's index in that triangle above.
// Unused lanes hold DRAPE_NO_FEATURE and NaN positions, which no test keeps.
#define DRAPE_CORNER_SHIFT 30
#define DRAPE_NO_FEATURE 0xffffffffu

// Features that a face's triangle owns, in one word: its bits as in Triangle::m_owned, above them the lanes of its
// first vertex and of its first edge, counted from the patch's first of each. Further ones follow these.
#define DRAPE_FEATURES_OWNED(features) ((features)&0x3fu)
#define DRAPE_FEATURES_VERTEX(features) (((features) >> 8) & 0xffu)
#define DRAPE_FEATURES_EDGE(features) (((features) >> 16) & 0xffu)

// A feature test that the cull could not drop: a cloth triangle with the test in its upper bits, and an obstacle
// lane. Lanes are of faces (tests 0 to 2: corner of the cloth triangle), vertices (3) or edges (4 to 6: edge of the
// cloth triangle).
//
// The record also stores a pair of a cloth triangle and a patch: m_lane is the patch then. In a self test
// (lib/cloth_cloth/self_contact.h) m_cloth and m_lane are the features, m_reach is the cloth's thickness, and m_motion
// is the test's kind (DRAPE_SELF_TEST_NODE …).
typedef struct FeatureTest
{
    DRAPE_UINT m_cloth;
    DRAPE_UINT m_lane;
    float m_reach;        // m
    DRAPE_UINT m_motion;  // 1 + index of the obstacle's motion in the step's list; 0 where it rests
} FeatureTest;
#define DRAPE_TEST_SHIFT 29
#define DRAPE_TEST_NODE 0u
#define DRAPE_TEST_FACE 3u
#define DRAPE_TEST_EDGE 4u

DRAPE_NAMESPACE_END

#endif
