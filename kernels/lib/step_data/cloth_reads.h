// Reads of a cloth's nodes and neighbours, for the narrow phase.
#ifndef DRAPE_LIB_CLOTH_READS_H
#define DRAPE_LIB_CLOTH_READS_H

#include "../geometry/rigid_motion.h"
#include "step_views.h"

DRAPE_NAMESPACE_BEGIN

// A node at the step's start, relative to the current obstacle.
DRAPE_FUNCTION Vec3 nodeStart(const ClothView* cloth, DRAPE_UINT node)
{
    return startSeen(cloth->m_motion, vec3Load(cloth->m_start, node));
}

// Returns the third vertex of the triangle on the other side of edge i; the triangle's own at a boundary.
DRAPE_FUNCTION DRAPE_UINT vertexBeyond(const ClothView* cloth, const DRAPE_GLOBAL Triangle* triangle, int i)
{
    const DRAPE_UINT own = triangle->m_vertices[i == 0 ? 2 : i - 1];
    const DRAPE_GLOBAL Edge* edge = cloth->m_edges + triangle->m_edges[i];
    return edge->m_opposite[0] == own ? edge->m_opposite[1] : edge->m_opposite[0];
}

DRAPE_NAMESPACE_END

#endif
