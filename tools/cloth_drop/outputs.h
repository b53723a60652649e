// The output files of a run. They are checked before the run, so that a mistyped folder does not cost an hour's work,
// and written after it.
#pragma once

#include <string>
#include <vector>

#include "tools/cloth_drop/options.h"
#include "tools/cloth_drop/report.h"

namespace drape
{
// Makes the frames' folder and checks that each named file could be written, and is no other's. False with one line in
// `error`.
bool prepareOutputs(const Options& options, const std::vector<std::pair<std::string, std::string>>& inputs,
                    std::string& error);

// Writes CSV (of the first run), JSON and the table. Tries all, reports the first failure in `error`.
bool writeOutputs(const Options& options, const std::vector<NamedRun>& runs, std::string& error);
}  // namespace drape
