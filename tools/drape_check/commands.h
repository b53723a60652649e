// Runs the commands of drape_check: the core answers a question, and the answer is named numbers.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/drape_check/options.h"

namespace drape
{
// The key in the answer if there is more to test than allowed.
constexpr const char* kLimitReached = "limit_reached";

// Computes the numbers of the command, in the order of printing. On failure it returns false with one line in `error`
// and the exit code. If the answer contains kLimitReached, its numbers are valid all the same. Reads the files before
// it opens a device.
bool runCommand(const Options& options, nlohmann::ordered_json& answer, std::string& error, int& exitCode);
}  // namespace drape
