// Conversions between the records of drape/c_api.h and those of the C++ interface.
#pragma once

#include <string>
#include <type_traits>

#include "bullet_plugin/adapter/c_api/field_lists.h"
#include "drape/c_api.h"
#include "drape/mesh_description.h"
#include "drape/report.h"
#include "drape/settings.h"

namespace drape
{
// Texts of the C record point into `from`.
inline void copyField(const std::string& from, const char*& to)
{
    to = from.c_str();
}

inline void copyField(const char* from, std::string& to)
{
    to = from ? from : "";
}

// Numbers, enumerations and flags.
template <class From, class To>
void copyField(From from, To& to)
{
    to = static_cast<To>(from);
}

// Null means the defaults.
Settings settingsOf(const DrapeSettings* settings);
DrapeSettings defaultCSettings();
DrapeDeviceInfo infoOf(const DeviceInfo& device);
DrapeDeviceReport reportOf(const DeviceReport& report);
DrapeStatistics statisticsOf(const StepStatistics& statistics);
MeshDescription descriptionOf(const DrapeMesh& mesh);
}  // namespace drape
