#include "tools/common/pocl_threads.h"

#include <cstdlib>

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
}  // namespace

void keepPoclThreadsApart()
{
    if (runsOnEveryCore()) ::setenv("POCL_AFFINITY", "1", 0);
}
}  // namespace drape
