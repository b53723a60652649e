// The version of these headers, and that of the library that the app runs with. CMake's project version, the package
// files and the tools' --version come from this file.
//
// Versions follow semantic versioning; below 1.0 a new minor version may change the interface. Compare the headers'
// version with `#if DRAPE_VERSION_NUMBER >= DRAPE_MAKE_VERSION(0, 3, 0)`. C++11; the macros also C99.
#ifndef DRAPE_VERSION_H
#define DRAPE_VERSION_H

#include "drape/export.h"

// The major version, an integer.
#define DRAPE_VERSION_MAJOR 0
// The minor version, an integer.
#define DRAPE_VERSION_MINOR 3
// The patch version, an integer.
#define DRAPE_VERSION_PATCH 0
// The whole version as a string: "major.minor.patch".
#define DRAPE_VERSION_STRING "0.3.0"

// Returns a version as one integer; a later version has a larger one. minor, patch: 0 to 999.
#define DRAPE_MAKE_VERSION(major, minor, patch) ((major)*1000000 + (minor)*1000 + (patch))
// The whole version as one integer.
#define DRAPE_VERSION_NUMBER DRAPE_MAKE_VERSION(DRAPE_VERSION_MAJOR, DRAPE_VERSION_MINOR, DRAPE_VERSION_PATCH)

#ifdef __cplusplus
namespace drape
{
// Returns DRAPE_VERSION_STRING as the library has it. An app whose headers differ from its library sees another one.
DRAPE_EXPORT const char* libraryVersion() noexcept;
// Returns DRAPE_VERSION_NUMBER as the library has it.
DRAPE_EXPORT int libraryVersionNumber() noexcept;
}  // namespace drape
#endif

#endif
