// A run in a child process: its steps as lines of text that the parent reads back (see capped_lines.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "examples/cloth_drop/run_record.h"

namespace drape
{
// In the parent: what a line says, and the cloth nodes' positions where the line has them. Throws what the JSON library
// throws.
StepRecord stepFromLine(const std::string& line);
StepRecord stepFromLine(const std::string& line, std::vector<float>& positions);

// In the child: runs, and writes a step's lines (capped_lines.h) and what was measured as a line of JSON, `positions`
// among it where asked for; at the end what lastLine returns, where it is given. Does not return: Bullet's own clean-up
// could take minutes.
[[noreturn]] void streamRun(Simulation& simulation, const DropScene& scene, int steps,
                            const std::function<std::string()>& lastLine = {}, bool positions = false);
}  // namespace drape
