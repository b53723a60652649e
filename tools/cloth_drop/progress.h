// Shows how far a run or a picture is, on standard error: a bar when that is a terminal, else a line every tenth of the
// way.
#pragma once

#include <chrono>
#include <string>

namespace drape
{
class Progress
{
public:
    // Prints nothing when `quiet`. `unit` names what is counted.
    Progress(std::string title, int steps, bool quiet, std::string unit = "step");
    ~Progress();
    // Must not be called from two threads at a time.
    void show(int step);

private:
    void drawBar(int step) const;

    std::string m_title, m_unit;
    int m_steps;
    bool m_quiet;
    bool m_terminal;
    int m_tenths = 0;
    bool m_lineOpen = false;
    std::chrono::steady_clock::time_point m_start, m_drawn;
};
}  // namespace drape
