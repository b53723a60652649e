#include "tools/common/pocl_threads.h"

#include <cstdlib>
#include <initializer_list>

#include <sched.h>
#include <unistd.h>

namespace drape
{
namespace
{
bool runsOnEveryCore()
{
    cpu_set_t allowed;
    const long cores = ::sysconf(_SC_NPROCESSORS_CONF);
    return ::sched_getaffinity(0, sizeof allowed, &allowed) == 0 && CPU_COUNT(&allowed) == cores;
}

// PoCL then makes this number of threads, even if it is larger than the number of cores.
bool threadsAreSet()
{
    for (const char* name : {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT", "POCL_MAX_COMPUTE_UNITS"})
        if (std::getenv(name)) return true;
    return false;
}
}  // namespace

void keepPoclThreadsApart()
{
    if (runsOnEveryCore() && !threadsAreSet()) ::setenv("POCL_AFFINITY", "1", 0);
}
}  // namespace drape
