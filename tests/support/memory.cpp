#include "tests/support/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace drape::test
{
std::size_t residentBytes()
{
    std::ifstream file("/proc/self/statm");
    std::size_t total = 0, resident = 0;
    file >> total >> resident;
    return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

std::size_t peakResidentBytes()
{
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return std::size_t(usage.ru_maxrss) * 1024;
}
}  // namespace drape::test
