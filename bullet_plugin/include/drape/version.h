// The version of these headers. CMake's project version, the package files and the tools' --version come from this
// file.
//
// Versions follow semantic versioning; below 1.0 a new minor version may change the interface. C++11.
#pragma once

// The major version, an integer.
#define DRAPE_VERSION_MAJOR 0
// The minor version, an integer.
#define DRAPE_VERSION_MINOR 2
// The patch version, an integer.
#define DRAPE_VERSION_PATCH 0
// The whole version as a string: "major.minor.patch".
#define DRAPE_VERSION_STRING "0.2.0"
