#include "machine_load.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include "bullet_plugin/core/platform/platform.h"

namespace drape
{
namespace
{
// Share of a core that other processes may take: the load of an idle system.
constexpr double kMostIdleLoad = 0.25;

CoreTimes timesNow()
{
    CoreTimes times;
    std::ifstream stat("/proc/stat");
    readCoreTimes(stat, ticksPerSecond(), times);
    return times;
}
}  // namespace

bool readCoreTimes(std::istream& stat, double ticksPerSecond, CoreTimes& times)
{
    // cpu user nice system idle iowait irq softirq steal …, then a line for each core.
    constexpr int kFields = 8, kIdle = 3, kWaiting = 4;
    CoreTimes read;
    std::string line;
    while (std::getline(stat, line) && line.compare(0, 3, "cpu") == 0)
    {
        if (line.size() > 3 && line[3] != ' ')
        {
            ++read.m_cores;
            continue;
        }
        std::istringstream fields(line.substr(3));
        for (int field = 0; field < kFields; ++field)
        {
            double ticks = 0;
            if (!(fields >> ticks)) return false;
            read.m_all += ticks / ticksPerSecond;
            if (field != kIdle && field != kWaiting) read.m_busy += ticks / ticksPerSecond;
        }
    }
    if (read.m_cores == 0 || !(read.m_all > 0)) return false;
    times = read;
    return true;
}

bool isBusyBetween(const CoreTimes& first, const CoreTimes& last, double ownSeconds, unsigned threads)
{
    const double all = last.m_all - first.m_all;
    if (last.m_cores == 0 || !(all > 0)) return false;
    const double coresPerSecond = double(last.m_cores) / all;
    const double others = std::max(0.0, last.m_busy - first.m_busy - ownSeconds) * coresPerSecond;
    const double spare = std::max(0.0, double(last.m_cores) - double(threads));
    return others > spare + kMostIdleLoad;
}

MachineLoad::MachineLoad() : m_first(timesNow()), m_ownSeconds(processSeconds()) {}

bool MachineLoad::isBusy(unsigned threads) const
{
    return isBusyBetween(m_first, timesNow(), processSeconds() - m_ownSeconds, threads);
}
}  // namespace drape
