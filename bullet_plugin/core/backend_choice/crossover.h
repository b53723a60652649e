// The work from which a device is faster than the host back end: measured once for a machine, a device, a driver and a
// version of Drape, and kept beside the compiled kernels.
//
// The file is text, one line for each measured rung of the ladder of scenes. A file that is damaged, or names another
// device, driver, host, version or settings, counts as missing; the crossover is measured again and the file replaced.
// Delete crossover-*.txt to measure again. A crossover measured on a busy machine is provisional: later starts measure
// again.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bullet_plugin/core/device/device.h"
#include "drape/settings.h"

namespace drape
{
// One scene, timed on both: the least of some steps, host to host.
struct CrossoverRung
{
    double m_pairs = 0;  // expected, see expected_pairs.h
    double m_hostMs = 0;
    double m_deviceMs = 0;
};

struct Crossover
{
    double m_pairs = 0;  // 0: the device was faster in all scenes; infinite: the host was
    std::vector<CrossoverRung> m_rungs;
    int m_busyStarts = 0;  // starts that measured it, all on a busy machine; 0: the machine was idle
};

// Maximum starts that measure a busy machine. The last result is then kept, for want of a better one.
constexpr int kMostBusyStarts = 4;

// Returns whether a stored crossover must be measured again.
inline bool isProvisional(const Crossover& crossover)
{
    return crossover.m_busyStarts > 0 && crossover.m_busyStarts < kMostBusyStarts;
}

// Returns the least times of both measurements, by rung; disturbances only add to times.
std::vector<CrossoverRung> leastTimes(std::vector<CrossoverRung> rungs, const std::vector<CrossoverRung>& others);

// Returns the best division of the rungs: steps below run on the host, those above on the device. It minimises the
// sum of the logarithms of the time ratios to the faster back end, over the ends and the middles between neighbours.
double bestCrossover(std::vector<CrossoverRung> rungs);

// Stores the crossover of one device with these settings on disk.
class CrossoverCache
{
public:
    CrossoverCache(const Settings& settings, const DeviceInfo& device, std::size_t computeUnits);

    bool load(Crossover& crossover) const;
    void store(const Crossover& crossover) const;
    std::string fileName() const;

private:
    std::string m_folder;
    std::string m_machine;  // lines that name what is measured
    std::string m_state;    // lines that may change; a change makes the stored crossover stale
};
}  // namespace drape
