// The options --backend, --device and --list-devices of Drape's programs.
#pragma once

#include <string>

#include "drape/settings.h"

namespace drape
{
// Sets the back end. `backend` is auto, opencl or host; `device` is part of a name, or empty. If no device fits,
// returns false and one line in `error` that lists the devices.
bool deviceSettings(const std::string& backend, const std::string& device, Settings& settings, std::string& error);

// Prints one line for each device on standard output. Returns false, with a line in `error`, if it could not be
// written.
bool printDevices(std::string& error);
}  // namespace drape
