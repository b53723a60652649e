// Measures how busy other processes keep the machine during a measurement. Linux only; other systems never appear
// busy.
#pragma once

#include <istream>

namespace drape
{
// Seconds, summed over all cores, since the system started.
struct CoreTimes
{
    double m_busy = 0;  // including the time that a hypervisor gave to others
    double m_all = 0;
    unsigned m_cores = 0;
};

// Reads /proc/stat. Returns false, with nothing changed, if its format is unexpected.
bool readCoreTimes(std::istream& stat, double ticksPerSecond, CoreTimes& times);

// Returns whether other processes took so much time between two samples that `threads` threads did not have a core
// each. ownSeconds: core time of this process.
bool isBusyBetween(const CoreTimes& first, const CoreTimes& last, double ownSeconds, unsigned threads);

class MachineLoad
{
public:
    // Starts the measurement.
    MachineLoad();

    // Returns whether the machine was busy since then; see isBusyBetween().
    bool isBusy(unsigned threads) const;

private:
    CoreTimes m_first;
    double m_ownSeconds;
};
}  // namespace drape
