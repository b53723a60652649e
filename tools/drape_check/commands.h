// What drape_check does: a question answered by the core, and the answer as named numbers.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/drape_check/options.h"

namespace drape
{
// The numbers of the command, in the order to print. False: `error` holds one line and `exitCode` what it comes to.
// Reads the files before it opens a device.
bool runCommand(const Options& options, nlohmann::ordered_json& answer, std::string& error, int& exitCode);
}  // namespace drape
