// Times Bullet's calls of the solver, so that the rest of a step is known.
#pragma once

#include <drape/drape.h>

#include <chrono>

namespace drape
{
// Measures how long Bullet's step spends in the solver.
class TimedSolver : public SoftBodySolver
{
public:
    // Adds the time of its life to a sum, ms.
    class Timer
    {
    public:
        explicit Timer(double& sum) : m_sum(sum) {}
        ~Timer() { m_sum += std::chrono::duration<double, std::milli>(Clock::now() - m_start).count(); }

    private:
        using Clock = std::chrono::steady_clock;
        double& m_sum;
        const Clock::time_point m_start = Clock::now();
    };

    using SoftBodySolver::SoftBodySolver;
    void predictMotion(btScalar dt) override
    {
        m_ms = 0;
        const Timer timer(m_ms);
        SoftBodySolver::predictMotion(dt);
    }
    void solveConstraints(btScalar dt) override
    {
        const Timer timer(m_ms);
        SoftBodySolver::solveConstraints(dt);
    }
    void updateSoftBodies() override
    {
        const Timer timer(m_ms);
        SoftBodySolver::updateSoftBodies();
    }
    // Returns the time of the last step's calls, ms.
    double ms() const { return m_ms; }

private:
    double m_ms = 0;
};
}  // namespace drape
