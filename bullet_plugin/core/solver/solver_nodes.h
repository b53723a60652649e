// The nodes of one cloth within a step, as the solver moves them: in substeps of equal length.
//
// A node's path through the step is the parabola from its start to its end under constant acceleration. A substep
// moves every node along its velocity; then constraints correct the positions, and the velocities follow (Macklin et
// al. 2019, Small Steps in Physics Simulation). Positions are displacements from the
// step's start: rounding is relative to the motion, not to the distance from the origin, so momentum is kept wherever
// the cloth is. Nodes are independent of each other in all functions, so threads may share ranges of them, with the
// same bits. SI units. Cost: linear in the nodes.
#pragma once

#include <cstddef>
#include <vector>

namespace drape
{
// A displacement and the inverse mass, read and written as one vector.
struct SolverNode
{
    float m_displacement[3];  // m, from the step's start
    float m_inverseMass;      // 1/kg; 0 for a node that constraints do not move
};

class SolverNodes
{
public:
    std::size_t count() const { return m_nodes.size(); }
    SolverNode* nodes() { return m_nodes.data(); }
    const float* start(std::size_t node) const { return m_starts[node].m_values; }
    // Returns a coordinate of the current position, m.
    float position(std::size_t node, int axis) const
    {
        return m_starts[node].m_values[axis] + m_nodes[node].m_displacement[axis];
    }
    // Returns the velocity after endSubstep(), m/s.
    const float* velocity(std::size_t node) const { return m_velocities[node].m_values; }

    void resize(std::size_t count)
    {
        m_nodes.resize(count);
        m_free.resize(count);
        m_starts.resize(count);
        m_velocities.resize(count);
        m_accelerations.resize(count);
    }
    // Begins a step of `time` seconds (> 0) in `substeps` parts. setPath() for every node follows.
    void begin(float time, int substeps)
    {
        m_time = time;
        m_substeps = substeps;
    }
    // Sets the path of a node. start: m. way: m, from the start to the end. acceleration: m/s².
    void setPath(std::size_t node, const float start[3], const float way[3], const float acceleration[3],
                 float inverseMass)
    {
        const float share = pathShare(m_substeps) * m_time;
        for (int axis = 0; axis < 3; ++axis)
        {
            m_starts[node].m_values[axis] = start[axis];
            m_nodes[node].m_displacement[axis] = 0;
            m_velocities[node].m_values[axis] = way[axis] / m_time - share * acceleration[axis];
            m_accelerations[node].m_values[axis] = acceleration[axis];
        }
        m_nodes[node].m_inverseMass = inverseMass;
    }
    // Returns the share s in the motion of a free node in a step: time · velocity + s · time² · acceleration.
    static float pathShare(int substeps) { return 0.5f * (1.0f + 1.0f / float(substeps)); }

    // Moves nodes by a substep, without constraints.
    void advance(std::size_t first, std::size_t last)
    {
        const float h = m_time / float(m_substeps);
        for (std::size_t i = first; i < last; ++i)
        {
            for (int axis = 0; axis < 3; ++axis)
            {
                m_velocities[i].m_values[axis] += m_accelerations[i].m_values[axis] * h;
                m_nodes[i].m_displacement[axis] += m_velocities[i].m_values[axis] * h;
                m_free[i].m_values[axis] = m_nodes[i].m_displacement[axis];
            }
        }
    }
    // Adds the constraints' corrections to the velocities: a node without any keeps its velocity exactly. kept: the
    // share of a velocity that damping leaves.
    void endSubstep(std::size_t first, std::size_t last, float kept)
    {
        const float perSecond = float(m_substeps) / m_time;
        for (std::size_t i = first; i < last; ++i)
        {
            for (int axis = 0; axis < 3; ++axis)
            {
                const float correction = m_nodes[i].m_displacement[axis] - m_free[i].m_values[axis];
                float& velocity = m_velocities[i].m_values[axis];
                velocity = (velocity + correction * perSecond) * kept;
            }
        }
    }

private:
    struct Vector
    {
        float m_values[3];
    };

    std::vector<SolverNode> m_nodes;
    std::vector<Vector> m_free;  // displacements of the substep without constraints
    std::vector<Vector> m_starts, m_velocities, m_accelerations;
    float m_time = 0;
    int m_substeps = 1;
};
}  // namespace drape
