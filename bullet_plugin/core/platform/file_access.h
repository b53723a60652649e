// Permissions and temporary names of files, for code that the core's libraries do not contain: the recorder and tools.
#pragma once

#include <cerrno>
#include <filesystem>
#include <system_error>

#ifdef _WIN32
#include <io.h>
#include <process.h>
#else
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace drape
{
// Returns why the process may not write a file or folder; no error if it may.
inline std::error_code whyNotWritable(const std::filesystem::path& path)
{
#ifdef _WIN32
    constexpr int kWrite = 2;
    const int result = ::_waccess(path.c_str(), kWrite);
#else
    const int result = ::access(path.c_str(), W_OK);
#endif
    return result == 0 ? std::error_code() : std::error_code(errno, std::generic_category());
}

// Returns true if two existing paths name one file, pipe or device.
inline bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b)
{
#ifdef _WIN32
    std::error_code code;
    return std::filesystem::equivalent(a, b, code);
#else
    // The standard library refuses to compare two pipes.
    struct stat one, other;
    return ::stat(a.c_str(), &one) == 0 && ::stat(b.c_str(), &other) == 0 && one.st_dev == other.st_dev &&
           one.st_ino == other.st_ino;
#endif
}

// Returns the process's number, for names that no other process takes.
inline long processNumber()
{
#ifdef _WIN32
    return ::_getpid();
#else
    return ::getpid();
#endif
}
}  // namespace drape
