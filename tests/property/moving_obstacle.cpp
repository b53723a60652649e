#include "tests/property/moving_obstacle.h"

#include <cmath>

namespace drape::test
{
Motion motionOf(double angle, const std::array<double, 3>& shift, Random& random)
{
    double axis[3], length = 0;
    for (double& a : axis)
    {
        a = random.uniform(-1.0f, 1.0f);
        length += a * a;
    }
    const double c = std::cos(angle), s = std::sin(angle);
    Motion motion;
    for (int i = 0; i < 3; ++i)
    {
        axis[i] /= std::sqrt(length);
        motion.m_rows[i][3] = shift[std::size_t(i)];
    }
    const double cross[3][3] = {{0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            motion.m_rows[i][k] = (i == k ? c : 0) + (1 - c) * axis[i] * axis[k] + s * cross[i][k];
    return motion;
}

std::vector<float> mapped(const Motion& motion, const std::vector<float>& positions)
{
    std::vector<float> result;
    for (std::size_t i = 0; i < positions.size(); i += 3)
    {
        const double p[3] = {positions[i], positions[i + 1], positions[i + 2]};
        for (double coordinate : motion.at(p))
            result.push_back(float(coordinate));
    }
    return result;
}

MovingCase movingCase(const std::string& shape, double angle, const std::array<double, 3>& shift, std::uint32_t seed)
{
    Random random(seed);
    MovingCase moving = {fallingCase(shape, 20, 0.03f, seed), {}, motionOf(0, kNoShift, random)};
    moving.m_start = motionOf(angle, shift, random);
    return moving;
}

std::vector<Contact> runMoving(Pipeline& pipeline, const MovingCase& moving)
{
    const StepCase& step = moving.m_step;
    const MeshId cloth = addCloth(pipeline, step.m_cloth), obstacle = addObstacle(pipeline, step.m_obstacle);
    pipeline.placeObstacle(obstacle, moving.m_start.pose().data(), moving.m_end.pose().data());
    setMotion(pipeline, cloth, step.m_cloth.m_positions, step.m_end);
    pipeline.addPair(cloth, obstacle, step.m_thickness);
    return runStep(pipeline);
}
}  // namespace drape::test
