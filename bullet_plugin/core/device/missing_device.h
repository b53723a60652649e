// Finds out why a machine shows no OpenCL device, as far as possible.
#pragma once

#include <string>
#include <vector>

#include "drape/report.h"

namespace drape
{
// The platform that PoCL calls itself.
constexpr const char* kPoclPlatform = "Portable Computing Language";

// Does the same as deviceInfos(), and sets whyNone to the reason if there is no device.
std::vector<DeviceInfo> deviceInfos(std::string& whyNone);

// Returns PoCL's kernel cache: POCL_CACHE_DIR, else a folder in XDG_CACHE_HOME, else in ~/.cache.
std::string poclCacheFolder();

// Returns whether files can be created in the folder, or in the existing folder that would contain it.
bool canBeWritten(const std::string& folder);

// Returns how many more files this process may open, at most kEnoughDescriptors. Opens that many for a moment.
constexpr int kEnoughDescriptors = 8;
int descriptorsLeft();

// Describes the missing device in one line. seen: the platforms and devices found and why each is unusable; empty if
// there was no platform.
std::string whyNoDeviceFound(const std::string& seen, bool poclWithoutDevice);
}  // namespace drape
