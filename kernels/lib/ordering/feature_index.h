// Indices of cloth features over some cloths: all nodes, then all triangles, then all edges. Contacts are in this order
// (shared/contact.h), and those of cloths with themselves have a second range of it behind the first.
#ifndef DRAPE_LIB_FEATURE_INDEX_H
#define DRAPE_LIB_FEATURE_INDEX_H

#include "../../shared/contact.h"

DRAPE_NAMESPACE_BEGIN

// Returns the index of a feature of the cloths, given that of the node, triangle or edge. kind: DRAPE_NODE_FACE,
// DRAPE_FACE_VERTEX or DRAPE_EDGE_EDGE. nodes, triangles: the numbers of them.
DRAPE_FUNCTION DRAPE_UINT featureIndexOf(DRAPE_UINT kind, DRAPE_UINT feature, DRAPE_UINT nodes, DRAPE_UINT triangles)
{
    return feature + (kind == DRAPE_NODE_FACE ? 0u : nodes) + (kind == DRAPE_EDGE_EDGE ? triangles : 0u);
}

// Returns the number of features, which is also the index of the first self contact's.
DRAPE_FUNCTION DRAPE_UINT featureCountOf(DRAPE_UINT nodes, DRAPE_UINT triangles, DRAPE_UINT edges)
{
    return featureIndexOf(DRAPE_EDGE_EDGE, edges, nodes, triangles);
}

DRAPE_NAMESPACE_END

#endif
