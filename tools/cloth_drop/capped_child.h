// Runs this program again as a child process whose steps may take only so long together, and follows what it writes.
//
// Why: Bullet's own collision can stall for minutes in one step. The child says when its steps begin and end
// (capped_lines.h, step_stream.h); the cap counts the time between, or all since the first step began, but no loading.
// All other lines go to the caller. The child is always gone when the function returns.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/cloth_drop/capped_lines.h"

namespace drape
{
struct ChildEnd
{
    int m_step = 0;         // the last step that began, from 1; 0: none
    bool m_capped = false;  // the cap, or the caller, ended it, in that step
    std::string m_error;    // one line when the child could not be started or failed, else empty
};

// Runs a child. The first of `arguments` names the program. `onLine` gets the number of the last step and the line; its
// exceptions end the child and become the error. `goesOn`, if given, is called several times a second. If it returns
// false, the child is ended like at its time limit.
ChildEnd runCappedChild(std::vector<std::string> arguments, const ChildCap& cap, const CappedLines::OnLine& onLine,
                        const std::function<bool()>& goesOn = {});
}  // namespace drape
