// Transforms obstacles from their own frames to the world's.
#include "../lib/rigid_motion.h"

// Places a given vertex, then a given edge, per work-item. Reads a feature's position and cone in its own frame and
// writes those in the world; exactly one work-item writes each.
__kernel void placeObstacles(__global const ObstaclePlace* restrict places, const uint placeCount,
                             const uint firstVertex, const uint vertexCount, const uint firstEdge, const uint edgeCount,
                             __global const float* restrict ownPositions,
                             __global const NormalCone* restrict ownVertexCones,
                             __global const NormalCone* restrict ownEdgeCones, __global float* restrict positions,
                             __global NormalCone* restrict vertexCones, __global NormalCone* restrict edgeCones)
{
    const uint i = get_global_id(0);
    if (i >= vertexCount + edgeCount) return;
    if (i >= vertexCount)
    {
        const uint edge = firstEdge + i - vertexCount;
        edgeCones[edge] = placedCone(places + placeOf(places, placeCount, DRAPE_OF_EDGE, edge), ownEdgeCones[edge]);
        return;
    }
    const uint vertex = firstVertex + i;
    __global const ObstaclePlace* place = places + placeOf(places, placeCount, DRAPE_OF_VERTEX, vertex);
    const Vec3 p = placedPosition(place, vec3Load(ownPositions, vertex));
    positions[3 * vertex] = p.x;
    positions[3 * vertex + 1] = p.y;
    positions[3 * vertex + 2] = p.z;
    vertexCones[vertex] = placedCone(place, ownVertexCones[vertex]);
}
