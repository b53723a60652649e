// Geometry of the motion limit (core/solver/host/motion_limit.h). Metres.
#ifndef DRAPE_LIB_MOTION_LIMIT_H
#define DRAPE_LIB_MOTION_LIMIT_H

#include "solver_node.h"

DRAPE_NAMESPACE_BEGIN

typedef struct Box
{
    Vec3 m_low, m_high;
} Box;

// Returns whether the node is farther from its path's end than `sure`, and contacts may move it. NaN counts as far.
DRAPE_FUNCTION int isFarFromEnd(const DRAPE_NODE_SPACE SolverNode* node, const DRAPE_GLOBAL NodePath* path, float sure)
{
    const Vec3 off = vec3Sub(node->m_displacement, path->m_vector);
    return !(vec3Dot(off, off) <= sure * sure) && path->m_inverseMass > 0.0f;
}

// Returns the parameter, 0 to 1, of the closest position on the path from `start` to `end`.
DRAPE_FUNCTION float closestOnPath(Vec3 start, Vec3 end, Vec3 point)
{
    const Vec3 path = vec3Sub(end, start);
    const float length2 = vec3Dot(path, path);
    if (!(length2 > 0.0f)) return 1.0f;
    return drapeMin(1.0f, drapeMax(0.0f, vec3Dot(vec3Sub(point, start), path) / length2));
}

// Moves a node back to the path between the displacements `start` and `end` if it is farther off than the radius, which
// varies linearly between them. Returns whether it was moved.
DRAPE_FUNCTION int bringBack(DRAPE_NODE_SPACE SolverNode* node, DRAPE_GLOBAL NodeState* state, Vec3 start, Vec3 end,
                             float startRadius, float endRadius)
{
    const Vec3 displacement = node->m_displacement;
    const float t = closestOnPath(start, end, displacement);
    const Vec3 off = vec3Sub(displacement, vec3Mix(start, end, t));
    const float radius = startRadius + (endRadius - startRadius) * t;
    const float distance = vec3Length(off);
    if (!(distance > radius)) return 0;
    nodeShift(node, state, vec3Scale(off, radius / distance - 1.0f));
    return 1;
}

DRAPE_FUNCTION Box pointBox(Vec3 point)
{
    Box box;
    box.m_low = box.m_high = point;
    return box;
}

// Grows the box by what a node may pass between the end of its path and its current position.
DRAPE_FUNCTION void growByPassed(Box* box, const DRAPE_NODE_SPACE SolverNode* node, const DRAPE_GLOBAL NodePath* path)
{
    const Vec3 end = vec3Add(path->m_start, path->m_vector);
    const Vec3 position = vec3Add(path->m_start, node->m_displacement);
    box->m_low = vec3Least(vec3Least(box->m_low, end), position);
    box->m_high = vec3Most(vec3Most(box->m_high, end), position);
}

DRAPE_FUNCTION int boxesMeet(const Box* a, const Box* b)
{
    return a->m_low.x <= b->m_high.x && a->m_high.x >= b->m_low.x && a->m_low.y <= b->m_high.y &&
           a->m_high.y >= b->m_low.y && a->m_low.z <= b->m_high.z && a->m_high.z >= b->m_low.z;
}

DRAPE_NAMESPACE_END

#endif
