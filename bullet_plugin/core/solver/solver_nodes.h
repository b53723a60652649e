// The nodes of one cloth within a step, as the solver moves them: in substeps of equal length.
//
// A node's path through the step is the parabola from its start to its end under constant acceleration. A substep
// moves every node along its velocity; then constraints correct the positions; endSubstep() derives the velocity from
// the corrected motion (Macklin et al. 2019, Small Steps in Physics Simulation). Nodes are independent of each other in
// all functions, so threads may share ranges of them, with the same bits. SI units. Cost: linear in the nodes.
#pragma once

#include <cstddef>
#include <vector>

namespace drape
{
// A position and the inverse mass, read and written as one vector.
struct SolverNode
{
    float m_position[3];  // m
    float m_inverseMass;  // 1/kg; 0 for a node that constraints do not move
};

class SolverNodes
{
public:
    std::size_t count() const { return m_nodes.size(); }
    SolverNode* nodes() { return m_nodes.data(); }
    const SolverNode* nodes() const { return m_nodes.data(); }
    // m/s, after endSubstep().
    const float* velocity(std::size_t node) const { return m_velocities[node].m_values; }

    void resize(std::size_t count)
    {
        m_nodes.resize(count);
        m_previous.resize(count);
        m_velocities.resize(count);
        m_accelerations.resize(count);
    }
    // Begins a step of `time` seconds (> 0) in `substeps` parts.
    void begin(float time, int substeps)
    {
        m_time = time;
        m_substeps = substeps;
    }
    // Sets the path of a node. acceleration: m/s². Returns nothing else than the path's end as it stands: a later
    // change of the end changes the velocity at the start.
    void setPath(std::size_t node, const float start[3], const float end[3], const float acceleration[3],
                 float inverseMass)
    {
        // The substeps of a free node add up to start + time · velocity + pathShare() · time² · acceleration.
        const float share = pathShare(m_substeps) * m_time;
        for (int axis = 0; axis < 3; ++axis)
        {
            m_nodes[node].m_position[axis] = start[axis];
            m_velocities[node].m_values[axis] = (end[axis] - start[axis]) / m_time - share * acceleration[axis];
            m_accelerations[node].m_values[axis] = acceleration[axis];
        }
        m_nodes[node].m_inverseMass = inverseMass;
    }
    // Returns how much of acceleration · time² a free node moves in a step of so many substeps.
    static float pathShare(int substeps) { return 0.5f * (1.0f + 1.0f / float(substeps)); }

    // Moves nodes by a substep, without constraints.
    void advance(std::size_t first, std::size_t last)
    {
        const float h = m_time / float(m_substeps);
        for (std::size_t i = first; i < last; ++i)
        {
            m_previous[i] = m_nodes[i];
            for (int axis = 0; axis < 3; ++axis)
            {
                m_velocities[i].m_values[axis] += m_accelerations[i].m_values[axis] * h;
                m_nodes[i].m_position[axis] += m_velocities[i].m_values[axis] * h;
            }
        }
    }
    // Derives the velocities from the motion of the substep. kept: the share of a velocity that damping leaves.
    void endSubstep(std::size_t first, std::size_t last, float kept)
    {
        const float scale = kept * float(m_substeps) / m_time;
        for (std::size_t i = first; i < last; ++i)
            for (int axis = 0; axis < 3; ++axis)
                m_velocities[i].m_values[axis] = (m_nodes[i].m_position[axis] - m_previous[i].m_position[axis]) * scale;
    }

private:
    struct Vector
    {
        float m_values[3];
    };

    std::vector<SolverNode> m_nodes, m_previous;  // now, and at the substep's start
    std::vector<Vector> m_velocities, m_accelerations;
    float m_time = 0;
    int m_substeps = 1;
};
}  // namespace drape
