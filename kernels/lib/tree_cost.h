// A node's share of a hierarchy's cost: by the surface-area heuristic a query meets a node about as often as the area of its
// box is of the root's.
#ifndef DRAPE_LIB_TREE_COST_H
#define DRAPE_LIB_TREE_COST_H

#include "dop.h"

DRAPE_NAMESPACE_BEGIN

// Parts that the root's area is counted in: leaves of a million triangles still have some, and 2^32 nodes do not overflow.
#define DRAPE_AREA_PARTS 1073741824.0f  // 2^30

DRAPE_FUNCTION float nodeHalfArea(const DRAPE_GLOBAL BvhNode* node)
{
    const float x = node->m_high[0] - node->m_low[0];
    const float y = node->m_high[1] - node->m_low[1];
    const float z = node->m_high[2] - node->m_low[2];
    return x >= 0.0f && y >= 0.0f && z >= 0.0f ? x * y + y * z + z * x : 0.0f;  // empty volumes have none
}

// No more than all of the root's; none where the root has none or areas overflow.
DRAPE_FUNCTION DRAPE_UINT areaParts(const DRAPE_GLOBAL BvhNode* node, const DRAPE_GLOBAL BvhNode* root)
{
    const float parts = nodeHalfArea(node) / nodeHalfArea(root) * DRAPE_AREA_PARTS;
    return parts >= DRAPE_AREA_PARTS ? (DRAPE_UINT)DRAPE_AREA_PARTS : parts > 0.0f ? (DRAPE_UINT)parts : 0u;
}

DRAPE_NAMESPACE_END

#endif
