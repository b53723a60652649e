// The nodes of one cloth within a step, as the solver moves them.
//
// A node has a path: straight, from its start to its predicted end, along which contacts were found. Its current
// position is a displacement from the start: rounding is relative to the motion, not to the distance from the origin,
// so momentum is kept wherever the cloth is. Nodes are independent of each other in all functions, so threads may
// share ranges of them, with the same bits. SI units.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/lib/vec3.h"
#include "kernels/shared/solver.h"

namespace drape
{
class SolverNodes
{
public:
    std::size_t count() const { return m_nodes.size(); }
    void resize(std::size_t count)
    {
        m_nodes.resize(count);
        m_starts.resize(count);
        m_ways.resize(count);
        m_velocities.resize(count);
        m_before.resize(count);
        m_shifted.resize(count);
        m_anchored.resize(count);
    }

    // Records the node's path and puts the node at its end. start, way: m. velocity: m/s. inverseMass: 1/kg, 0 for a
    // node that constraints do not move. anchored: links and anchors alone move the node, contacts do not.
    void setPath(std::size_t node, Vec3 start, Vec3 way, Vec3 velocity, float inverseMass, bool anchored = false)
    {
        m_starts[node] = start;
        m_nodes[node].m_inverseMass = inverseMass;
        m_anchored[node] = anchored;
        setEnd(node, way, velocity);
    }
    // Records another end of the path.
    void setEnd(std::size_t node, Vec3 way, Vec3 velocity)
    {
        m_ways[node] = way;
        setCurrent(node, way, velocity);
        m_shifted[node] = 0;
    }
    // Puts the node elsewhere, with the same path.
    void setCurrent(std::size_t node, Vec3 displacement, Vec3 velocity)
    {
        m_nodes[node].m_displacement = displacement;
        m_velocities[node] = velocity;
    }

    SolverNode* nodes() { return m_nodes.data(); }
    const SolverNode* nodes() const { return m_nodes.data(); }
    Vec3 start(std::size_t node) const { return m_starts[node]; }
    // The path, from the start to the end.
    Vec3 way(std::size_t node) const { return m_ways[node]; }
    Vec3 end(std::size_t node) const { return vec3Add(m_starts[node], m_ways[node]); }
    Vec3 displacement(std::size_t node) const { return m_nodes[node].m_displacement; }
    Vec3 position(std::size_t node) const { return vec3Add(m_starts[node], displacement(node)); }
    Vec3 velocity(std::size_t node) const { return m_velocities[node]; }
    // Returns the inverse mass as contacts see it, 1/kg: 0 for a node that they do not move.
    float inverseMass(std::size_t node) const { return m_anchored[node] ? 0.0f : m_nodes[node].m_inverseMass; }

    // Moves the node and marks it as shifted.
    void shift(std::size_t node, Vec3 by)
    {
        m_nodes[node].m_displacement = vec3Add(displacement(node), by);
        m_shifted[node] = 1;
    }
    void markShifted(std::size_t node) { m_shifted[node] = 1; }
    bool isShifted(std::size_t node) const { return m_shifted[node] != 0; }
    void addVelocity(std::size_t node, Vec3 by) { m_velocities[node] = vec3Add(m_velocities[node], by); }
    void setVelocity(std::size_t node, Vec3 velocity) { m_velocities[node] = velocity; }

    // Remembers where the node is; it does not count as shifted any more.
    void remember(std::size_t node)
    {
        m_before[node] = displacement(node);
        m_shifted[node] = 0;
    }
    Vec3 remembered(std::size_t node) const { return m_before[node]; }
    // Gives a shifted node the velocity of its displacement since remember(): perSecond times as much.
    void addShift(std::size_t node, float perSecond)
    {
        if (m_shifted[node]) addVelocity(node, vec3Scale(vec3Sub(displacement(node), m_before[node]), perSecond));
    }
    // Bounds the velocity that the shift since remember() gives the node. The shift may stop the node's motion against
    // it. Beyond that it gives at most the velocity of the same shift in a whole step. perSecond: 1/s, the velocity per
    // metre of shift that is bounded. stepsPerSecond: 1/s.
    void limitShift(std::size_t node, float perSecond, float stepsPerSecond)
    {
        if (!m_shifted[node]) return;
        const Vec3 shift = vec3Sub(displacement(node), m_before[node]);
        const float length = vec3Length(shift);
        if (!(length > 0)) return;
        const float against = -vec3Dot(velocity(node), shift) / length;
        const float most = drapeMax(length * stepsPerSecond, against) / perSecond;
        if (most < length) m_before[node] = vec3AddScaled(m_before[node], shift, 1 - most / length);
    }

private:
    std::vector<SolverNode> m_nodes;
    std::vector<Vec3> m_starts, m_ways, m_velocities;
    std::vector<Vec3> m_before;  // displacements, see remember()
    std::vector<unsigned char> m_shifted, m_anchored;
};
}  // namespace drape
