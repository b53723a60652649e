// Measures how much cloth moves that should lie still, from its positions after each step.
//
// Speed: RMS over nodes and steps of a node's displacement in a step, over the step's time. Creep: RMS over nodes of
// the displacement from the first positions to the last, over the time between. Cloth that trembles on the spot has
// speed and no creep. Metres, seconds; x y z per node. Cost: linear in the nodes, a step.
#pragma once

#include <vector>

namespace drape
{
class RestMeter
{
public:
    // positions: at the start of the first step.
    explicit RestMeter(std::vector<float> positions);
    // positions: after a step of `time` seconds.
    void add(const std::vector<float>& positions, double time);

    double speed() const;                                 // m/s
    double worstStep() const { return m_worstStep; }      // m/s, RMS over the nodes in the fastest step
    double creep() const;                                 // m/s
    double farthest() const { return m_farthest; }        // m, most that a node is away from its first position
    double fastestNode() const { return m_fastestNode; }  // m/s, in any step

private:
    std::vector<float> m_first, m_last;
    double m_speed2 = 0, m_worstStep = 0, m_fastestNode = 0, m_farthest = 0, m_time = 0;
    int m_steps = 0;
};
}  // namespace drape
