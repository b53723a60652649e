// Interprets the lines that a child process prints about its steps, and decides when its time limit ends them (see
// capped_child.h).
//
// The child writes stepLine() before a step, steppedLine() after it, and measuredLine() after measuring it. Each line
// contains the time of the call. All other lines go to the caller. The times in the lines decide which steps are kept,
// since several steps may be read at once.
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

// Functions for the child, which shares the clock.
std::string stepLine();
std::string steppedLine();
std::string measuredLine();

class CappedLines
{
public:
    using Clock = std::chrono::steady_clock;
    using OnLine = std::function<void(int step, const std::string& line)>;

    CappedLines(const ChildCap& cap, const OnLine& onLine) : m_cap(cap), m_onLine(onLine) {}

    // Takes the next part of the text, which may end within a line. Returns false once the time limit is exceeded.
    // Passes on exceptions of onLine, and throws std::exception for invalid times.
    bool take(const char* text, std::size_t size);
    // Returns true while the clock of the limit runs: between a step's two lines, or from the first step on.
    bool running() const { return m_running; }
    // Returns the seconds that are left at `time` while the clock runs.
    double secondsLeft(Clock::time_point time) const;
    // Returns the last step that began, from 1, or 0 if there is none.
    int step() const { return m_step; }

private:
    bool takeLine(const std::string& line);

    ChildCap m_cap;
    OnLine m_onLine;
    std::string m_text;  // text of a line that has not ended
    bool m_running = false;
    Clock::time_point m_start;
    double m_spent = 0;
    int m_step = 0;
};
}  // namespace drape
