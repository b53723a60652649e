// Exchanges the nodes of a soft body with the solver's.
#pragma once

#include <cstddef>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/vectors.h"
#include "bullet_plugin/core/solver/solver_nodes.h"

namespace drape
{
// Returns the inverse mass; 0 for a node that contacts may not move: one that is pinned, or anchored to a rigid body.
inline btScalar movableInverseMass(const btSoftBody::Node& node)
{
    return node.m_battach ? btScalar(0) : node.m_im;
}

// Returns the node's displacement from the start of its path.
inline Vec3 displacementOf(const btSoftBody::Node& node, const SolverNodes& nodes, std::size_t index)
{
    return vec3Of(node.m_x - vectorOf(nodes.start(index)));
}

// Records the path of a node between predictMotion() and the end of solveConstraints(), from m_q to m_x.
inline void recordPath(const btSoftBody::Node& node, std::size_t index, SolverNodes& nodes)
{
    const Vec3 start = vec3Of(node.m_q);
    nodes.setPath(index, start, vec3Of(node.m_x - vectorOf(start)), vec3Of(node.m_v), float(node.m_im), node.m_battach);
}

// Records that the path ends at the node's current position.
inline void recordEnd(const btSoftBody::Node& node, std::size_t index, SolverNodes& nodes)
{
    nodes.setEnd(index, displacementOf(node, nodes, index), vec3Of(node.m_v));
}

// Gives the node the solver's position and velocity.
inline void writeNode(const SolverNodes& nodes, std::size_t index, btSoftBody::Node& node)
{
    node.m_x = vectorOf(nodes.start(index)) + vectorOf(nodes.displacement(index));
    node.m_v = vectorOf(nodes.velocity(index));
}

// Gives shifted nodes the solver's positions and velocities.
inline void writeShifted(const SolverNodes& nodes, btSoftBody& body)
{
    for (std::size_t i = 0; i < nodes.count(); ++i)
        if (nodes.isShifted(i)) writeNode(nodes, i, body.m_nodes[int(i)]);
}
}  // namespace drape
