// Records of the broad phase's traversals. 32-bit scalars only, no padding.
#ifndef DRAPE_SHARED_TRAVERSAL_H
#define DRAPE_SHARED_TRAVERSAL_H

#include "../../../kernels/shared/mesh.h"

DRAPE_NAMESPACE_BEGIN

// A node of each hierarchy.
typedef struct NodePair
{
    DRAPE_UINT m_cloth;
    DRAPE_UINT m_obstacle;
} NodePair;

// A node's parent. A root is its own parent.
typedef struct BvhLink
{
    DRAPE_UINT m_parent;
    DRAPE_UINT m_depth;
} BvhLink;

// Most children of a node: hierarchies are binary or 4-wide.
#define DRAPE_MAX_CHILDREN 4

// The counters of a traversal on the device. Demands count on when a buffer is full, so the host learns the true size.
typedef struct TraversalCounters
{
    DRAPE_UINT m_candidates;
    DRAPE_UINT m_front;    // pairs of the front for the next step
    DRAPE_UINT m_spill;    // most pairs that did not fit into a local queue
    DRAPE_UINT m_entries;  // number of a grid's entries
    DRAPE_UINT m_visits;   // volume tests; only in programs built with DRAPE_COUNT_VISITS
} TraversalCounters;

DRAPE_NAMESPACE_END

#endif
