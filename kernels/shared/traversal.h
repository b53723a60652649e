// Records of the broad phase's traversals. 32-bit scalars only, no padding.
#ifndef DRAPE_SHARED_TRAVERSAL_H
#define DRAPE_SHARED_TRAVERSAL_H

#include "mesh.h"

DRAPE_NAMESPACE_BEGIN

// A node of each hierarchy.
typedef struct NodePair
{
    DRAPE_UINT m_cloth;
    DRAPE_UINT m_obstacle;
} NodePair;

// Where a node hangs. A root is its own parent.
typedef struct BvhLink
{
    DRAPE_UINT m_parent;
    DRAPE_UINT m_depth;
} BvhLink;

// Most children of a node: hierarchies are binary or 4-wide.
#define DRAPE_MAX_CHILDREN 4

// Slots of a wide node: the float lanes of an AVX register, and one 32-byte sector of a GPU's memory a direction.
#define DRAPE_WIDE 8
#define DRAPE_WIDE_LEAF 0x80000000u
#define DRAPE_WIDE_NONE 0xffffffffu

// Up to eight descendants of a node, side by side, so that they are tested at once. A child is a wide node, or a
// triangle with the bit DRAPE_WIDE_LEAF, or DRAPE_WIDE_NONE with an empty volume.
typedef struct WideNode
{
    float m_low[DRAPE_DOP_DIRECTIONS][DRAPE_WIDE];
    float m_high[DRAPE_DOP_DIRECTIONS][DRAPE_WIDE];
    DRAPE_UINT m_child[DRAPE_WIDE];
} WideNode;

// Depth of a wide traversal's stack: a step takes one node and leaves at most eight, so this is enough for 25 heights. A
// wide height takes the place of three binary ones: of 48 of a mesh's tree, the highest that a builder makes, and of 27
// above it, those over 2^27 meshes. Of a study's 4-wide ones it takes the place of one; a mesh's tree has 24.
#define DRAPE_WIDE_STACK_DEPTH 176

DRAPE_NAMESPACE_END

#endif
