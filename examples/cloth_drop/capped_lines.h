// What a child process says of its steps, and when its cap ends them (see capped_child.h).
//
// Before a step the child writes stepLine(), after it steppedLine(), and when it has measured it measuredLine(), each
// with the time of the call; all other lines go to the caller. What is kept goes by these times, not by when they are
// read: several steps may come at once.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace drape
{
struct ChildCap
{
    double m_seconds;
    bool m_measuring = false;  // counts what is done between steps, too
};

// In the child, which shares the clock.
std::string stepLine();
std::string steppedLine();
std::string measuredLine();

class CappedLines
{
public:
    using Clock = std::chrono::steady_clock;
    using OnLine = std::function<void(int step, const std::string& line)>;

    CappedLines(const ChildCap& cap, const OnLine& onLine) : m_cap(cap), m_onLine(onLine) {}

    // The next part of the text, which may end within a line. False from the first time beyond the cap on. Passes on
    // what onLine throws, and std::exception for times that are none.
    bool take(const char* text, std::size_t size);
    // Whether the cap's clock runs: between a step's two lines, or from the first step's on.
    bool running() const { return m_running; }
    // Of the cap at `time`, while it runs.
    double secondsLeft(Clock::time_point time) const;
    // The last step that began, from 1; 0: none.
    int step() const { return m_step; }

private:
    bool takeLine(const std::string& line);

    ChildCap m_cap;
    OnLine m_onLine;
    std::string m_text;  // of a line that has not ended
    bool m_running = false;
    Clock::time_point m_start;
    double m_spent = 0;
    int m_step = 0;
};
}  // namespace drape
