// The part of the operating system that Drape uses. posix.cpp and cache_files_posix.cpp define it for Linux, macOS and
// other systems of POSIX, windows.cpp and cache_files_windows.cpp for Windows. No other file of the core, the adapter
// and the recorder includes a system's headers, save file_access.h.
#pragma once

#include <cstddef>
#include <string>
#include <thread>

#ifndef _WIN32
#include <csignal>
#endif

namespace drape
{
// The file name of OpenCL's loader.
extern const char* const kOpenClLoader;
// The advice of a system that has a package of it, in brackets; else "".
extern const char* const kOpenClPackage;

// Returns a function of any library that the process has loaded; null if there is none. On Windows only OpenCL's loader
// is looked at.
void* loadedFunction(const char* name) noexcept;
// Loads a library for the rest of the process. Null if it is not there.
void* loadLibrary(const char* file) noexcept;
// Returns a function of a library; null if it has none of that name.
void* libraryFunction(void* library, const char* name) noexcept;

// Returns the number of cores that the process may use, at least 1.
unsigned availableCores();
// Returns the core on which the calling thread runs; -1 if the system does not say, as on macOS.
int currentCore();
// Moves threads to the process's other cores. Does nothing if the system has no such call, or there is one core.
void keepOffCore(std::thread* threads, std::size_t count, int core);

// Blocks signals for the calling thread while this lives, and for threads that it starts meanwhile: signal handlers
// belong to the application and run on its own threads. Windows has no such signals.
class BlockedSignals
{
public:
    BlockedSignals();
    ~BlockedSignals();
    BlockedSignals(const BlockedSignals&) = delete;
    BlockedSignals& operator=(const BlockedSignals&) = delete;

private:
#ifndef _WIN32
    sigset_t m_before;
#endif
};

// Returns the core time that the process has used, s.
double processSeconds();
// Returns the number of ticks per second in /proc/stat. 1 on systems that have no such file.
double ticksPerSecond();
// Returns the name of the host's processor, or "unknown".
std::string processorName();

// Returns how many more files the process can open, `most` at most. A system without a limit returns `most`.
int openableFiles(int most);
// Returns true if the process may make files in an existing folder.
bool mayMakeFiles(const std::string& folder);
// Returns the user's folder for caches; empty if the environment names none.
std::string userCacheFolder();
}  // namespace drape
