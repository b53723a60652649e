// Runs this program again as a child process whose steps may take only so long together, and follows what it writes.
//
// Why: Bullet's built-in collision can stall for minutes in one step. The child writes a line to its standard output
// before every step and one after it (see step_stream.h), each with the time; the cap counts the time between them only,
// or all since the first step began, but no loading. All other lines go to the caller, up to the first of these two whose
// time is beyond the cap: what is kept does not depend on when this process gets to read. The child is always gone when
// the function returns.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace drape
{
// In the child: the lines before and after a step, at the time of the call.
std::string stepLine();
std::string steppedLine();

struct ChildCap
{
    double m_seconds;
    bool m_measuring = false;  // counts what is done between steps, too
};

struct ChildEnd
{
    int m_step = 0;         // the last step that began, from 1; 0: none
    bool m_capped = false;  // the cap ended it, in that step
    std::string m_error;    // one line when the child could not be started or failed, else empty
};

// arguments: the first one names the program. onLine gets the number of the last step and the line; an exception of its
// own ends the child and becomes the error.
ChildEnd runCappedChild(std::vector<std::string> arguments, const ChildCap& cap,
                        const std::function<void(int step, const std::string& line)>& onLine);
}  // namespace drape
