// Streams a run in a child process: its steps are lines of text that the parent reads (see capped_lines.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/cloth_drop/run_record.h"

namespace drape
{
// Runs in the parent. Returns the contents of a line, with the cloth nodes' positions if the line has them. Throws the
// JSON library's exceptions.
StepRecord stepFromLine(const std::string& line);
StepRecord stepFromLine(const std::string& line, std::vector<float>& positions);

// Runs in the child. Writes each step's lines (capped_lines.h) and its measurements as a line of JSON, with `positions`
// if requested. At the end it writes the result of lastLine, if given. Does not return, since Bullet's own clean-up
// could take minutes.
[[noreturn]] void streamRun(Simulation& simulation, const DropScene& scene, int steps,
                            const std::function<std::string()>& lastLine = {}, bool positions = false);
}  // namespace drape
