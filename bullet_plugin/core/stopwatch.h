// Wall time in laps.
#pragma once

#include <chrono>

namespace drape
{
class Stopwatch
{
public:
    // Returns the milliseconds since the last call or the start.
    double lapMs()
    {
        const Clock::time_point now = Clock::now();
        const double ms = std::chrono::duration<double, std::milli>(now - m_last).count();
        m_last = now;
        return ms;
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point m_last = Clock::now();
};
}  // namespace drape
