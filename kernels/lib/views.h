// The meshes of both sides as the narrow phase reads them.
#ifndef DRAPE_LIB_VIEWS_H
#define DRAPE_LIB_VIEWS_H

#include "../shared/mesh.h"
#include "rigid_motion.h"

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
