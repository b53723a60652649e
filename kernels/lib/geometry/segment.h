// Triangles that stand for an edge that is not a face's, or for a vertex without a triangle: the second and third
// corner are one vertex. They have no area; as faces they meet an obstacle's vertex with their one edge.
#ifndef DRAPE_LIB_SEGMENT_H
#define DRAPE_LIB_SEGMENT_H

#include "../../shared/mesh.h"

DRAPE_NAMESPACE_BEGIN

DRAPE_FUNCTION int isSegment(const DRAPE_GLOBAL Triangle* triangle)
{
    return triangle->m_vertices[1] == triangle->m_vertices[2];
}

// Adds the weight of a segment's third corner to the second, which is the same vertex.
DRAPE_FUNCTION void joinCorners(float* weights)
{
    weights[1] += weights[2];
    weights[2] = 0.0f;
}

DRAPE_NAMESPACE_END

#endif
