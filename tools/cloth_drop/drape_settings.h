// Drape's settings by the options of cloth_drop.
#pragma once

#include <string>

#include "drape/settings.h"
#include "tools/cloth_drop/options.h"

namespace drape
{
class Plugin;

// Returns false, with one line in `error`, if no device fits.
bool drapeSettings(const Options& options, Settings& settings, std::string& error);

// Returns true if the plugin can run; a device that failed is named on standard error, and the host goes on. Else sets
// `error` to one line and the exit code.
bool isReady(const Plugin& plugin, std::string& error, int& exitCode);
}  // namespace drape
