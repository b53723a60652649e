// The name of the host's processor.
#pragma once

#include <string>

namespace drape
{
// Returns the name in /proc/cpuinfo, or "unknown".
std::string processorName();
}  // namespace drape
