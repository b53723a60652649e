#include "platform.h"

#ifndef NOMINMAX
#define NOMINMAX
#endif
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace drape
{
const char* const kOpenClLoader = "OpenCL.dll";
const char* const kOpenClPackage = "";

void* loadedFunction(const char* name) noexcept
{
    const HMODULE loader = ::GetModuleHandleA(kOpenClLoader);
    return loader ? libraryFunction(loader, name) : nullptr;
}

// Looks in the system's folder alone: a library in the current folder must not stand in for it.
void* loadLibrary(const char* file) noexcept
{
    return ::LoadLibraryExA(file, nullptr, LOAD_LIBRARY_SEARCH_SYSTEM32);
}

void* libraryFunction(void* library, const char* name) noexcept
{
    const FARPROC function = ::GetProcAddress(static_cast<HMODULE>(library), name);
    return reinterpret_cast<void*>(function);
}

// The process's cores of the first group, which has 64 at most: more than Drape uses by default.
unsigned availableCores()
{
    DWORD_PTR own = 0, all = 0;
    if (!::GetProcessAffinityMask(::GetCurrentProcess(), &own, &all)) return 1;
    unsigned count = 0;
    for (; own != 0; own &= own - 1)
        ++count;
    return std::max(count, 1u);
}

int currentCore()
{
    return int(::GetCurrentProcessorNumber());
}

// Threads of winpthreads, which MinGW has, are not handles of Windows: the system's scheduler is left alone there.
void keepOffCore(std::thread* threads, std::size_t count, int core)
{
#ifdef _MSC_VER
    DWORD_PTR own = 0, all = 0;
    if (!::GetProcessAffinityMask(::GetCurrentProcess(), &own, &all)) return;
    const DWORD_PTR others = own & ~(DWORD_PTR(1) << core);
    for (std::size_t i = 0; others != 0 && i < count; ++i)
        ::SetThreadAffinityMask(threads[i].native_handle(), others);
#else
    static_cast<void>(threads), static_cast<void>(count), static_cast<void>(core);
#endif
}

BlockedSignals::BlockedSignals() {}
BlockedSignals::~BlockedSignals() {}

double processSeconds()
{
    FILETIME start, end, kernel, user;
    if (!::GetProcessTimes(::GetCurrentProcess(), &start, &end, &kernel, &user)) return 0;
    const auto seconds = [](const FILETIME& time)
    { return 1e-7 * double(std::uint64_t(time.dwHighDateTime) << 32 | time.dwLowDateTime); };
    return seconds(kernel) + seconds(user);
}

double ticksPerSecond()
{
    return 1;
}

std::string processorName()
{
    const char* const name = std::getenv("PROCESSOR_IDENTIFIER");
    return name && *name ? name : "unknown";
}

int openableFiles(int most)
{
    return most;
}

bool mayMakeFiles(const std::string& folder)
{
    std::error_code ignored;
    return std::filesystem::is_directory(folder, ignored);
}

std::string userCacheFolder()
{
    for (const char* name : {"XDG_CACHE_HOME", "LOCALAPPDATA"})
        if (const char* const folder = std::getenv(name); folder && *folder) return folder;
    return std::string();
}
}  // namespace drape
