#include "platform.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#ifdef __linux__
#include <sched.h>
#endif
#ifdef __APPLE__
#include <sys/sysctl.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <vector>

namespace drape
{
#ifdef __APPLE__
const char* const kOpenClLoader = "/System/Library/Frameworks/OpenCL.framework/OpenCL";
const char* const kOpenClPackage = "";
#else
const char* const kOpenClLoader = "libOpenCL.so.1";
const char* const kOpenClPackage = " (Debian: ocl-icd-libopencl1)";
#endif

void* loadedFunction(const char* name) noexcept
{
    return ::dlsym(RTLD_DEFAULT, name);
}

void* loadLibrary(const char* file) noexcept
{
    return ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
}

void* libraryFunction(void* library, const char* name) noexcept
{
    return ::dlsym(library, name);
}

#ifdef __linux__
unsigned availableCores()
{
    cpu_set_t cores;
    return ::sched_getaffinity(0, sizeof cores, &cores) == 0 ? static_cast<unsigned>(CPU_COUNT(&cores)) : 1;
}

int currentCore()
{
    return ::sched_getcpu();
}

void keepOffCore(std::thread* threads, std::size_t count, int core)
{
    cpu_set_t cores;
    if (::sched_getaffinity(0, sizeof cores, &cores) != 0 || CPU_COUNT(&cores) < 2) return;
    CPU_CLR(static_cast<std::size_t>(core), &cores);
    for (std::size_t i = 0; i < count; ++i)
        ::pthread_setaffinity_np(threads[i].native_handle(), sizeof cores, &cores);
}
#else
unsigned availableCores()
{
    return std::max(1u, std::thread::hardware_concurrency());
}

int currentCore()
{
    return -1;
}

void keepOffCore(std::thread*, std::size_t, int) {}
#endif

BlockedSignals::BlockedSignals()
{
    sigset_t all;
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &m_before);
}

BlockedSignals::~BlockedSignals()
{
    ::pthread_sigmask(SIG_SETMASK, &m_before, nullptr);
}

double processSeconds()
{
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double ticksPerSecond()
{
    return double(::sysconf(_SC_CLK_TCK));
}

std::string processorName()
{
#ifdef __APPLE__
    char name[256] = {};
    std::size_t size = sizeof name - 1;
    return ::sysctlbyname("machdep.cpu.brand_string", name, &size, nullptr, 0) == 0 ? name : "unknown";
#else
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
    {
        if (line.compare(0, 10, "model name") != 0) continue;
        const std::size_t colon = line.find(": ");
        if (colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
#endif
}

int openableFiles(int most)
{
    std::vector<int> opened;
    for (int file; int(opened.size()) < most && (file = ::open("/dev/null", O_RDONLY | O_CLOEXEC)) >= 0;)
        opened.push_back(file);
    for (const int file : opened)
        ::close(file);
    return int(opened.size());
}

bool mayMakeFiles(const std::string& folder)
{
    return ::access(folder.c_str(), W_OK | X_OK) == 0;
}

std::string userCacheFolder()
{
    const char* const cache = std::getenv("XDG_CACHE_HOME");
    if (cache && *cache) return cache;
    const char* const home = std::getenv("HOME");
    return home && *home ? std::string(home) + "/.cache" : std::string();
}
}  // namespace drape
