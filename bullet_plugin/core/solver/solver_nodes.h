// The nodes of one cloth within a step, as the solver moves them.
//
// A node has a path: straight, from its start to its predicted end, along which contacts were found. Its current
// position is a displacement from the start: rounding is relative to the motion, not to the distance from the origin,
// so momentum is kept wherever the cloth is. Nodes are independent of each other in all functions, so threads may
// share ranges of them, with the same bits. SI units.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/lib/solver/solver_node.h"

namespace drape
{
class SolverNodes
{
public:
    std::size_t count() const { return m_nodes.size(); }
    void resize(std::size_t count)
    {
        m_nodes.resize(count);
        m_paths.resize(count);
        m_states.resize(count);
    }

    // Records the node's path and puts the node at its end. start, vector: m. velocity: m/s. inverseMass: 1/kg, 0 for a
    // node that constraints do not move. anchored: links and anchors alone move the node, contacts do not.
    void setPath(std::size_t node, Vec3 start, Vec3 vector, Vec3 velocity, float inverseMass, bool anchored = false)
    {
        m_nodes[node].m_inverseMass = inverseMass;
        m_paths[node].m_start = start;
        m_paths[node].m_freeMass = inverseMass;
        m_paths[node].m_inverseMass = anchored ? 0.0f : inverseMass;
        setEnd(node, vector, velocity);
    }
    // Records another end of the path.
    void setEnd(std::size_t node, Vec3 vector, Vec3 velocity)
    {
        m_paths[node].m_vector = vector;
        setCurrent(node, vector, velocity);
        m_states[node].m_shifted = 0;
    }
    // Puts the node elsewhere, with the same path.
    void setCurrent(std::size_t node, Vec3 displacement, Vec3 velocity)
    {
        m_nodes[node].m_displacement = displacement;
        m_states[node].m_velocity = velocity;
    }

    SolverNode* nodes() { return m_nodes.data(); }
    const SolverNode* nodes() const { return m_nodes.data(); }
    const NodePath* paths() const { return m_paths.data(); }
    NodeState* states() { return m_states.data(); }
    const NodeState* states() const { return m_states.data(); }
    Vec3 start(std::size_t node) const { return m_paths[node].m_start; }
    // Returns the vector from the path's start to its end, m.
    Vec3 pathVector(std::size_t node) const { return m_paths[node].m_vector; }
    Vec3 end(std::size_t node) const { return vec3Add(start(node), pathVector(node)); }
    Vec3 displacement(std::size_t node) const { return m_nodes[node].m_displacement; }
    Vec3 position(std::size_t node) const { return vec3Add(start(node), displacement(node)); }
    Vec3 velocity(std::size_t node) const { return m_states[node].m_velocity; }
    // Returns the inverse mass as contacts see it, 1/kg: 0 for a node that they do not move.
    float inverseMass(std::size_t node) const { return m_paths[node].m_inverseMass; }

    // Moves the node and marks it as shifted.
    void shift(std::size_t node, Vec3 by) { nodeShift(&m_nodes[node], &m_states[node], by); }
    // Marks a node that a contact has pushed.
    void markPushed(std::size_t node) { m_states[node].m_shifted |= DRAPE_NODE_SHIFTED | DRAPE_NODE_PUSHED; }
    bool isShifted(std::size_t node) const { return (m_states[node].m_shifted & DRAPE_NODE_SHIFTED) != 0; }
    void addVelocity(std::size_t node, Vec3 by) { setVelocity(node, vec3Add(velocity(node), by)); }
    void setVelocity(std::size_t node, Vec3 velocity) { m_states[node].m_velocity = velocity; }

    // Remembers where the node is; it does not count as shifted any more.
    void remember(std::size_t node) { nodeRemember(&m_nodes[node], &m_states[node]); }
    Vec3 remembered(std::size_t node) const { return m_states[node].m_before; }
    // See solver_node.h.
    void addShift(std::size_t node, float perSecond) { nodeAddShift(&m_nodes[node], &m_states[node], perSecond); }
    void limitShift(std::size_t node, float perSecond, float stepsPerSecond)
    {
        nodeLimitShift(&m_nodes[node], &m_states[node], perSecond, stepsPerSecond);
    }

    // The share of a contact's push between cloths that counts for the velocity: below 1 where the other cloths' take
    // longer to become velocity, so that both sides get the same impulse.
    float pushShare() const { return m_pushShare; }
    void setPushShare(float share) { m_pushShare = share; }

private:
    float m_pushShare = 1;
    std::vector<SolverNode> m_nodes;
    std::vector<NodePath> m_paths;
    std::vector<NodeState> m_states;
};
}  // namespace drape
