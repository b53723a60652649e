// Obstacles that move in the step. Their positions are those at the step's end, and the cloth's motion is relative to
// the obstacle: a node that starts at x starts at m_map x. The path between is a straight line in the obstacle's frame.
// This is exact for motion without rotation. Under a rotation by the angle a, a point at distance r of the axis is off
// by at most r (1 - cos(a / 2)).
#ifndef DRAPE_LIB_RIGID_MOTION_H
#define DRAPE_LIB_RIGID_MOTION_H

#include "../../shared/motion.h"
#include "dop.h"

DRAPE_NAMESPACE_BEGIN

DRAPE_FUNCTION Vec3 mapDirection(const DRAPE_GLOBAL float* m, Vec3 d)
{
    return vec3(m[0] * d.x + m[1] * d.y + m[2] * d.z, m[4] * d.x + m[5] * d.y + m[6] * d.z,
                m[8] * d.x + m[9] * d.y + m[10] * d.z);
}
DRAPE_FUNCTION Vec3 mapPoint(const DRAPE_GLOBAL float* m, Vec3 p)
{
    return vec3Add(mapDirection(m, p), vec3(m[3], m[7], m[11]));
}

// Returns a node's start relative to the obstacle; motion is null for a resting obstacle.
DRAPE_FUNCTION Vec3 startSeen(const DRAPE_GLOBAL ObstacleMotion* motion, Vec3 start)
{
    return motion ? mapPoint(motion->m_map, start) : start;
}

// Returns the motion of a slot, among `count` motions in the order of slots; null if the obstacle rests.
DRAPE_FUNCTION const DRAPE_GLOBAL ObstacleMotion* findMotion(const DRAPE_GLOBAL ObstacleMotion* motions,
                                                             DRAPE_UINT count, DRAPE_UINT mesh)
{
    DRAPE_UINT low = 0, high = count;
    while (low < high)
    {
        const DRAPE_UINT middle = low + (high - low) / 2;
        if (motions[middle].m_mesh == mesh) return motions + middle;
        if (motions[middle].m_mesh < mesh)
            low = middle + 1;
        else
            high = middle;
    }
    return 0;
}

// Returns whether a step sweeps a triangle's path from its first three corners to its last. A triangle that moves
// less than the radius meets only features within the radius of its end, so an automatic step sweeps only farther
// motion. The rest of the radius covers features that count as met while they are apart by 1e-5 of the pair's size
// (meetingDistance): the radius contains 1e-4 of the obstacle's longest edge for it. A NaN position counts as far.
DRAPE_FUNCTION int isSwept(const Vec3* p, float radius, DRAPE_UINT mode)
{
    if (mode != DRAPE_AUTOMATIC) return mode == DRAPE_CONTINUOUS;
    const float near = 0.9f * radius - 2e-5f * (vec3Norm1(vec3Sub(p[4], p[3])) + vec3Norm1(vec3Sub(p[5], p[3])));
    for (int k = 0; k < 3; ++k)
    {
        const Vec3 displacement = vec3Sub(p[3 + k], p[k]);
        if (!(vec3Dot(displacement, displacement) <= near * near)) return 1;
    }
    return !(near > 0.0f);
}

// Computes the corners of a cloth triangle at the step's start relative to the obstacle, then at its end; motion is
// null for a resting obstacle.
DRAPE_FUNCTION void cornersSeen(Vec3* p, const DRAPE_GLOBAL ObstacleMotion* motion,
                                const DRAPE_GLOBAL Triangle* triangle, const DRAPE_GLOBAL float* start,
                                const DRAPE_GLOBAL float* end)
{
    for (int k = 0; k < 3; ++k)
    {
        p[k] = startSeen(motion, vec3Load(start, triangle->m_vertices[k]));
        p[3 + k] = vec3Load(end, triangle->m_vertices[k]);
    }
}

// Returns the slot of a joined vertex or edge, from the slots' firsts (members of ObstaclePlace). Slots may be empty.
// kind: the kind of the index.
#define DRAPE_OF_VERTEX 0
#define DRAPE_OF_EDGE 1
DRAPE_FUNCTION DRAPE_UINT placeOf(const DRAPE_GLOBAL ObstaclePlace* places, DRAPE_UINT count, int kind,
                                  DRAPE_UINT index)
{
    DRAPE_UINT low = 0, high = count;  // low's first is no greater
    while (high - low > 1)
    {
        const DRAPE_UINT middle = low + (high - low) / 2;
        const DRAPE_UINT first = kind == DRAPE_OF_VERTEX ? places[middle].m_firstVertex : places[middle].m_firstEdge;
        if (first <= index)
            low = middle;
        else
            high = middle;
    }
    return low;
}

DRAPE_FUNCTION Vec3 placedPosition(const DRAPE_GLOBAL ObstaclePlace* place, Vec3 own)
{
    return place->m_posed ? mapPoint(place->m_pose, own) : own;
}

DRAPE_FUNCTION NormalCone placedCone(const DRAPE_GLOBAL ObstaclePlace* place, NormalCone own)
{
    if (place->m_posed) own.m_axis = mapDirection(place->m_pose, own.m_axis);
    return own;
}

DRAPE_NAMESPACE_END

#endif
