// Why a machine shows no OpenCL device, as far as it can be known.
#pragma once

#include <string>
#include <vector>

#include "drape/report.h"

namespace drape
{
// The platform that PoCL calls itself.
constexpr const char* kPoclPlatform = "Portable Computing Language";

// As deviceInfos(). whyNone: gets the reason where there is none.
std::vector<DeviceInfo> deviceInfos(std::string& whyNone);

// Folder in which PoCL keeps its kernels: POCL_CACHE_DIR, else one in XDG_CACHE_HOME, else in ~/.cache.
std::string poclCacheFolder();

// Whether files can be made in the folder, or in the one that is to have it.
bool canBeWritten(const std::string& folder);

// How many files more this process may open, kEnoughDescriptors at most. Opens that many for a moment.
constexpr int kEnoughDescriptors = 8;
int descriptorsLeft();

// One line. seen: what platforms and devices there were and why none of them will do, empty where there was no
// platform.
std::string whyNoDeviceFound(const std::string& seen, bool poclWithoutDevice);
}  // namespace drape
