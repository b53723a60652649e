// The options --backend, --device and --list-devices of Drape's programs.
#pragma once

#include <string>

#include "drape/settings.h"

namespace drape
{
// backend: auto, opencl or host. device: part of a name, or empty. Where nothing fits: false and one line in `error`
// that lists the devices there are.
bool deviceSettings(const std::string& backend, const std::string& device, Settings& settings, std::string& error);

// One line a device on standard output. False, with a line in `error`, when it could not be written.
bool printDevices(std::string& error);
}  // namespace drape
