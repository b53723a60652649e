// Transforms obstacles from their own frames to the world's.
#include "../lib/geometry/rigid_motion.h"
#include "scene_bindings.h"

// Places a given vertex, then a given edge, per work-item. Reads a feature's position and cone in its own frame and
// writes those in the world; exactly one work-item writes each.
__kernel void placeObstacles(DRAPE_PLACE_OBSTACLES)
{
    const uint i = get_global_id(0);
    if (i >= values.m_vertexCount + values.m_edgeCount) return;
    if (i >= values.m_vertexCount)
    {
        const uint edge = values.m_firstEdge + i - values.m_vertexCount;
        __global const NormalCone* from = (__global const NormalCone*)(own + values.m_own.m_edgeCones);
        __global NormalCone* to = (__global NormalCone*)(world + values.m_world.m_edgeCones);
        to[edge] = placedCone(places + placeOf(places, values.m_placeCount, DRAPE_OF_EDGE, edge), from[edge]);
        return;
    }
    const uint vertex = values.m_firstVertex + i;
    __global const ObstaclePlace* place = places + placeOf(places, values.m_placeCount, DRAPE_OF_VERTEX, vertex);
    __global const NormalCone* from = (__global const NormalCone*)(own + values.m_own.m_vertexCones);
    __global NormalCone* to = (__global NormalCone*)(world + values.m_world.m_vertexCones);
    __global float* positions = (__global float*)(world + values.m_world.m_positions);
    const Vec3 p = placedPosition(place, vec3Load((__global const float*)(own + values.m_own.m_positions), vertex));
    positions[3 * vertex] = p.x;
    positions[3 * vertex + 1] = p.y;
    positions[3 * vertex + 2] = p.z;
    to[vertex] = placedCone(place, from[vertex]);
}
