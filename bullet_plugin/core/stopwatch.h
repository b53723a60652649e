// Wall time in laps. Cost: reads the clock once a lap; nothing if it does not run.
#pragma once

#include <chrono>

namespace drape
{
class Stopwatch
{
public:
    // runs: false for a watch whose laps all take no time.
    explicit Stopwatch(bool runs = true) : m_runs(runs), m_last(runs ? Clock::now() : Clock::time_point()) {}

    // Returns the milliseconds since the last call or the start.
    double lapMs()
    {
        if (!m_runs) return 0;
        const Clock::time_point now = Clock::now();
        const double ms = std::chrono::duration<double, std::milli>(now - m_last).count();
        m_last = now;
        return ms;
    }

private:
    using Clock = std::chrono::steady_clock;
    bool m_runs;
    Clock::time_point m_last;
};
}  // namespace drape
