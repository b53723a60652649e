// The name of the host's processor.
#pragma once

#include <string>

namespace drape
{
// As /proc/cpuinfo has it; "unknown" where it says none.
std::string processorName();
}  // namespace drape
