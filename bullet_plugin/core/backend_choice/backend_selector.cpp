#include "backend_selector.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "bullet_plugin/core/backends/device_backend.h"
#include "bullet_plugin/core/backends/host_backend.h"
#include "bullet_plugin/core/stopwatch.h"
#include "crossover_ladder.h"
#include "expected_pairs.h"

namespace drape
{
namespace
{
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Minimum nodes for each thread of the host, in all cloths, for solving them on a GPU. A step takes it long however few
// nodes there are (docs/decisions/, 021).
constexpr std::size_t kLeastDeviceNodes = 8192;

std::string rounded(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.0f", value);
    return text;
}

Surface surfaceOf(const PooledMesh& mesh)
{
    return mesh.m_vacant ? Surface() : Surface{mesh.m_topology.m_triangles.size(), mesh.m_area};
}

DeviceInfo hostInfo()
{
    DeviceInfo info;
    info.m_name = "host";
    return info;
}

// Returns the numbers that decide between the host and the device.
std::string reasonByCost(const DeviceReport& report, const std::string& device)
{
    const std::string text = rounded(report.m_expectedPairs) + " expected triangle pairs; ";
    const std::string source = " (" + report.m_crossoverSource + ")";
    if (report.m_crossover == 0) return text + device + " for any number" + source;
    if (!std::isinf(report.m_crossover)) return text + device + " above " + rounded(report.m_crossover) + source;
    const bool isMeasured = report.m_crossoverSource.rfind("measured", 0) == 0;
    return text + "the host " + (isMeasured ? "is faster than " + device + " " : "") + "for any number" + source;
}
}  // namespace

BackendSelector::BackendSelector(const Settings& settings, std::shared_ptr<ThreadTeam> threads)
    : m_settings(settings), m_threads(std::move(threads)), m_host(std::make_unique<HostBackend>(m_settings, m_threads))
{
    m_report.m_device = hostInfo();
}

BackendSelector::~BackendSelector() = default;

bool BackendSelector::open(Error& error)
{
    m_wanted = chooseDevice(m_settings, error);
    if (error.failed()) return false;
    m_report.m_reason = m_wanted.m_reason;
    if (m_wanted.m_onHost) return true;
    if (!openDevice(error))
    {
        if (!m_wanted.m_byCost) return false;
        leaveDevice(error);
        error = Error();
        return true;
    }
    // Kernels are profiled on the device alone.
    return !m_wanted.m_byCost || m_settings.m_profileKernels || decideByCost(error);
}

void BackendSelector::reopen(const BackendSelector& other)
{
    m_wanted = other.m_wanted;
    m_report = other.m_report;
    m_error = other.m_error;
    m_deviceFailed = other.m_deviceFailed;
    Error error;
    if (other.m_device && !m_deviceFailed && !openDevice(error))
    {
        leaveDevice(error);
    }
    else if (other.m_choice.active())
    {
        m_choice.begin(other.m_choice.crossover());
        selectByWork();
    }
}

Device* BackendSelector::device()
{
    return m_device ? &m_device->device() : nullptr;
}

SolveStage* BackendSelector::solveStage(std::size_t nodes)
{
    if (!m_device || m_device->device().failed() || !m_device->solveStage().created()) return nullptr;
    const bool pays = nodes >= kLeastDeviceNodes * m_threads->size() || m_settings.m_solverPlace == SolverPlace::Device;
    return pays ? &m_device->solveStage() : nullptr;
}

std::unique_ptr<DeviceBackend> BackendSelector::makeDeviceBackend(Error& error) const
{
    std::unique_ptr<Device> device = Device::open(m_wanted.m_index, error, m_settings.m_profileKernels);
    if (!device) return nullptr;
    auto backend = std::make_unique<DeviceBackend>(std::move(device), m_settings);
    if (!backend->device().failed()) return backend;
    error = backend->device().error();
    return nullptr;
}

bool BackendSelector::openDevice(Error& error)
{
    Stopwatch watch;
    m_device = makeDeviceBackend(error);
    if (!m_device) return false;
    m_report.m_onHost = false;
    m_report.m_device = m_wanted.m_device;
    m_report.m_fromCache = m_device->fromCache();
    m_report.m_buildMs = watch.lapMs();
    return true;
}

void BackendSelector::leaveDevice()
{
    // Keeps the back end: the scene's pinned memory belongs to its context.
    if (!m_deviceFailed) leaveDevice(m_device->device().error());
}

void BackendSelector::leaveDevice(const Error& error)
{
    m_error = error;
    m_deviceFailed = true;
    m_report.m_reason = hostSince(m_wanted.m_device, error);
    m_report.m_onHost = true;
    m_report.m_byCost = false;
    m_report.m_device = hostInfo();
    m_choice.end();
}

void BackendSelector::prepareSelf()
{
    if (!m_device || m_device->device().failed()) return;
    m_device->prepareSelf();
    if (m_device->device().failed()) leaveDevice();
}

void BackendSelector::prepare(const Scene& scene)
{
    if (mayUseHost(scene)) m_host->prepare(scene);
    if (!m_device || m_deviceFailed) return;
    m_device->prepare(scene);
    if (m_device->device().failed()) leaveDevice();
}

void BackendSelector::giveBackRoom()
{
    if (m_device && !m_deviceFailed) m_device->giveBackRoom();
    m_host->giveBackRoom();
}

bool BackendSelector::decideByCost(Error& error)
{
    double pairs = -1;
    if (!wantedCrossover(m_settings, pairs, error)) return false;
    m_report.m_crossoverSource = "set";
    if (pairs < 0) pairs = findCrossover();
    if (m_deviceFailed) return true;
    m_report.m_byCost = true;
    m_report.m_crossover = pairs;
    m_choice.begin(pairs);
    selectByWork();
    return true;
}

const char* BackendSelector::measureCrossover(Crossover& crossover, bool& busy, Error& error) const
{
    const std::unique_ptr<DeviceBackend> device = makeDeviceBackend(error);
    if (!device) return "it failed";
    HostBackend host(m_settings, m_threads);
    const char* const why = measureLadder({host, *device, m_settings, m_threads->size()}, crossover.m_rungs, busy);
    error = device->device().error();
    return why;
}

double BackendSelector::findCrossover()
{
    const CrossoverCache cache(m_settings, m_wanted.m_device, device()->computeUnits());
    const char* const onBusy = ", on a busy machine";
    Crossover before, crossover;
    if (cache.load(before) && !isProvisional(before))
    {
        m_report.m_crossoverSource = std::string("measured before") + (before.m_busyStarts > 0 ? onBusy : "");
        return before.m_pairs;
    }
    Stopwatch watch;
    bool busy = false;
    Error error;
    const char* const why = measureCrossover(crossover, busy, error);
    m_report.m_measureMs = watch.lapMs();
    if (error.failed())
    {
        m_report.m_crossoverSource.clear();
        leaveDevice(error);
        return kInfinity;
    }
    if (why)
    {
        m_report.m_crossoverSource = why;
        m_error.m_call = m_wanted.m_device.m_name + " is not used: " + why;
        return kInfinity;
    }
    if (busy) crossover.m_rungs = leastTimes(crossover.m_rungs, before.m_rungs);
    crossover.m_busyStarts = busy ? before.m_busyStarts + 1 : 0;
    crossover.m_pairs = bestCrossover(crossover.m_rungs);
    m_report.m_crossoverSource = std::string("measured now") + (busy ? onBusy : "");
    cache.store(crossover);
    return crossover.m_pairs;
}

void BackendSelector::selectByWork()
{
    m_report.m_onHost = m_choice.chooseHost();
    m_report.m_expectedPairs = m_choice.work();
    m_report.m_device = m_report.m_onHost ? hostInfo() : m_wanted.m_device;
    m_report.m_reason = reasonByCost(m_report, m_wanted.m_device.m_name);
}

void BackendSelector::choose(const Scene& scene, const StepInput& input)
{
    if (!m_choice.active() || input.empty()) return;
    if (input.pairs() == m_countedPairs && input.selfCloths() == m_countedSelf) return;
    m_countedPairs = input.pairs();
    m_countedSelf = input.selfCloths();
    const double reachOfThickness = 1 + double(m_settings.m_activation);
    for (const NamedPair& pair : m_countedPairs)
        m_choice.setWork(pair.m_cloth, pair.m_obstacle,
                         expectedPairs(surfaceOf(scene.m_cloths.existing(pair.m_cloth)),
                                       surfaceOf(scene.m_obstacles.existing(pair.m_obstacle)),
                                       double(pair.m_thickness) * reachOfThickness));
    for (const MeshId id : m_countedSelf)
    {
        const PooledMesh& cloth = scene.m_cloths.existing(id);
        const Surface own = surfaceOf(cloth);
        m_choice.setWork(id, id,
                         kSelfPairWeight * expectedPairs(own, own, double(cloth.m_selfThickness) * reachOfThickness));
    }
    selectByWork();
}

void BackendSelector::forget(MeshId mesh)
{
    m_choice.forget(mesh);
    forgetPairs();
}

bool BackendSelector::mayUseHost(const Scene& scene) const
{
    const bool always = !m_choice.active() || std::isinf(m_report.m_crossover);
    if (!m_report.m_onHost || always) return m_report.m_onHost;
    const MeshPool &cloths = scene.m_cloths, &obstacles = scene.m_obstacles;
    double least = 0;
    for (std::size_t cloth = 0; cloth < cloths.meshCount() && least <= m_report.m_crossover; ++cloth)
    {
        const Surface own = surfaceOf(cloths.mesh(cloth));
        double most = cloths.mesh(cloth).m_selfThickness > 0.0f ? kSelfPairWeight * expectedPairs(own, own, 0) : 0;
        for (std::size_t obstacle = 0; obstacle < obstacles.meshCount(); ++obstacle)
            most = std::max(most, expectedPairs(own, surfaceOf(obstacles.mesh(obstacle)), 0));
        least += most;
    }
    return least <= m_report.m_crossover;
}
}  // namespace drape
