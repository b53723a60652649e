// Obstacles that turn and shift within a step, and the contacts of such a step, for the tests of moving obstacles.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bullet_plugin/core/scene/obstacle_poses.h"
#include "tests/support/backends.h"
#include "tests/support/cases.h"
#include "tests/support/pipeline_driver.h"

namespace drape::test
{
// A rotation by `angle` about a random axis through `centre`, then a shift, in double.
struct Motion
{
    double m_rows[3][4];

    std::array<double, 3> at(const double* p) const
    {
        std::array<double, 3> q;
        for (std::size_t i = 0; i < 3; ++i)
            q[i] = m_rows[i][0] * p[0] + m_rows[i][1] * p[1] + m_rows[i][2] * p[2] + m_rows[i][3];
        return q;
    }
    Pose pose() const
    {
        Pose pose;
        for (std::size_t i = 0; i < pose.size(); ++i)
            pose[i] = float(m_rows[i / 4][i % 4]);
        return pose;
    }
};

Motion motionOf(double angle, const std::array<double, 3>& shift, Random& random);

std::vector<float> mapped(const Motion& motion, const std::vector<float>& positions);

constexpr std::array<double, 3> kNoShift = {0, 0, 0};
constexpr double kAngles[] = {0.0, 0.05, 0.7, 2.5};

// A moving case: a cloth at rest or falling over an obstacle that rotates and shifts within the step.
struct MovingCase
{
    StepCase m_step;
    Motion m_start, m_end;
};

// Makes the obstacle end in the case's pose, so that the cloth passes it.
MovingCase movingCase(const std::string& shape, double angle, const std::array<double, 3>& shift, std::uint32_t seed);

std::vector<Contact> runMoving(Pipeline& pipeline, const MovingCase& moving);

class MovingObstacleTest : public BackendTest
{
protected:
    std::unique_ptr<Pipeline> make() { return makePipeline(GetParam().m_settings); }
};
}  // namespace drape::test
