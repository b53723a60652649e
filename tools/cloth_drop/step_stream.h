// Streams a run in a child process: its steps are lines of text that the parent reads (see capped_lines.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/cloth_drop/run_record.h"

namespace drape
{
// These run in the parent, and throw the JSON library's exceptions. Returns the contents of a line.
StepRecord stepFromLine(const std::string& line);
// Also takes positions and a frame of the recording into `record`, if the line has them.
StepRecord stepFromLine(const std::string& line, RunRecord& record);
// Takes the line before the first step: the recording at the start.
void startFromLine(const std::string& line, Recording& recording);

// Runs in the child. Writes each step's lines (capped_lines.h) and its measurements as a line of JSON, with `positions`
// and `frames` if requested. At the end it writes the result of lastLine, if given. Does not return, since Bullet's own
// clean-up could take minutes.
[[noreturn]] void streamRun(Simulation& simulation, const RunSubject& subject, int steps,
                            const std::function<std::string()>& lastLine = {}, bool positions = false,
                            bool frames = false);
}  // namespace drape
