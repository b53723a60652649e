#include "device_start.h"

#include <limits>

#include "bullet_plugin/core/backends/host_backend.h"
#include "bullet_plugin/core/stopwatch.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "crossover_ladder.h"

namespace drape
{
namespace
{
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Measures on back ends of its own, which are closed afterwards; the cache has the kernels by then. Returns null, or
// why the device cannot be used.
const char* measureCrossover(const DeviceChoice& choice, const Settings& settings, const StopFlag& stop,
                             Crossover& crossover, bool& busy, Error& error)
{
    const std::unique_ptr<DeviceBackend> device = openBackend(choice, settings, error, stop);
    if (!device) return "it failed";
    const auto threads = std::make_shared<ThreadTeam>(settings.m_threads);
    HostBackend host(settings, threads);
    const char* const why = measureLadder({host, *device, settings, threads->size()}, crossover.m_rungs, busy);
    error = device->device().error();
    return why;
}

// Reads the crossover from the cache, or measures it.
void findCrossover(StartedDevice& started, const Settings& settings, const StopFlag& stop)
{
    const DeviceInfo& info = started.m_wanted.m_device;
    const CrossoverCache cache(settings, info, started.m_backend->device().computeUnits());
    const char* const onBusy = ", on a busy machine";
    Crossover before, crossover;
    if (cache.load(before) && !isProvisional(before))
    {
        started.m_crossoverSource = std::string("measured before") + (before.m_busyStarts > 0 ? onBusy : "");
        started.m_crossover = before.m_pairs;
        return;
    }
    Stopwatch watch;
    bool busy = false;
    const char* const why = measureCrossover(started.m_wanted, settings, stop, crossover, busy, started.m_error);
    started.m_measureMs = watch.lapMs();
    started.m_crossover = kInfinity;
    if (started.m_error.failed() || started.m_backend->device().failed()) return;
    if (why)
    {
        started.m_crossoverSource = why;
        started.m_remark = info.m_name + " is not used: " + why;
        return;
    }
    if (busy) crossover.m_rungs = leastTimes(crossover.m_rungs, before.m_rungs);
    crossover.m_busyStarts = busy ? before.m_busyStarts + 1 : 0;
    crossover.m_pairs = bestCrossover(crossover.m_rungs);
    started.m_crossoverSource = std::string("measured now") + (busy ? onBusy : "");
    started.m_crossover = crossover.m_pairs;
    cache.store(crossover);
}
}  // namespace

std::unique_ptr<DeviceBackend> openBackend(const DeviceChoice& choice, const Settings& settings, Error& error,
                                           const StopFlag& stop)
{
    std::unique_ptr<Device> device = Device::open(choice.m_index, error, settings.m_profileKernels, stop);
    if (!device) return nullptr;
    auto backend = std::make_unique<DeviceBackend>(std::move(device), settings);
    if (!backend->device().failed()) return backend;
    error = backend->device().error();
    return nullptr;
}

StartedDevice startDevice(const Settings& settings, const StopFlag& stop)
{
    StartedDevice started;
    started.m_wanted = chooseDevice(settings, started.m_error);
    const bool wantsCrossover = started.m_wanted.m_byCost && !settings.m_profileKernels;
    started.m_crossoverSource = "set";
    started.m_crossover = -1;
    if (wantsCrossover) wantedCrossover(settings, started.m_crossover, started.m_error);
    if (started.m_error.failed() || started.m_wanted.m_onHost) return started;
    Stopwatch watch;
    started.m_backend = openBackend(started.m_wanted, settings, started.m_error, stop);
    started.m_buildMs = watch.lapMs();
    if (started.m_backend && wantsCrossover && started.m_crossover < 0) findCrossover(started, settings, stop);
    return started;
}
}  // namespace drape
