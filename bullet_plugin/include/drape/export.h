// Marks what the shared libraries export: DRAPE_EXPORT for Drape::drape, DRAPE_RECORDER_EXPORT for Drape::recorder.
//
// Everything else is hidden. On Windows an app imports the marked names from the DLLs; it must define DRAPE_STATIC if
// it links the static libraries, which the CMake package and the pkg-config files do. Only the build of a DLL defines
// DRAPE_BUILDING_LIBRARY or DRAPE_BUILDING_RECORDER. DRAPE_HIDDEN hides a class that is nested in a marked one. C99,
// C++11.
#ifndef DRAPE_EXPORT_H
#define DRAPE_EXPORT_H

#if defined(_WIN32)
#define DRAPE_HIDDEN
#if defined(DRAPE_STATIC)
#define DRAPE_EXPORT
#define DRAPE_RECORDER_EXPORT
#else
#if defined(DRAPE_BUILDING_LIBRARY)
#define DRAPE_EXPORT __declspec(dllexport)
#else
#define DRAPE_EXPORT __declspec(dllimport)
#endif
#if defined(DRAPE_BUILDING_RECORDER)
#define DRAPE_RECORDER_EXPORT __declspec(dllexport)
#else
#define DRAPE_RECORDER_EXPORT __declspec(dllimport)
#endif
#endif
#else
#define DRAPE_HIDDEN __attribute__((visibility("hidden")))
#define DRAPE_EXPORT __attribute__((visibility("default")))
#define DRAPE_RECORDER_EXPORT __attribute__((visibility("default")))
#endif

#endif
