#include "backend_selector.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <system_error>

#include "bullet_plugin/core/backends/device_backend.h"
#include "bullet_plugin/core/backends/host_backend.h"
#include "device_start.h"
#include "expected_pairs.h"

namespace drape
{
namespace
{
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

struct BackendSelector::Start
{
    explicit Start(Settings settings)
        : m_work([this, settings = std::move(settings)](const StopFlag& stop)
                 { m_started = startDevice(settings, stop); })
    {
    }

    StartedDevice m_started;
    BackgroundWork m_work;  // last: ends before the result does
};

BackendSelector::BackendSelector(const Settings& settings, std::shared_ptr<ThreadTeam> threads)
    : m_settings(settings), m_threads(std::move(threads)), m_host(std::make_unique<HostBackend>(m_settings, m_threads))
{
    m_report.m_device = hostInfo();
}

BackendSelector::~BackendSelector() = default;

bool BackendSelector::open(Error& error)
{
    // Kernels are profiled on the device alone.
    if (decidesByCost(m_settings) && !m_settings.m_profileKernels) return beginStart(error);
    StartedDevice started = startDevice(m_settings);
    if (started.m_error.failed() && !started.m_wanted.m_byCost)
    {
        error = started.m_error;
        return false;
    }
    take(std::move(started));
    return true;
}

bool BackendSelector::beginStart(Error& error)
{
    double pairs = -1;
    if (!wantedCrossover(m_settings, pairs, error)) return false;
    m_report.m_reason = whyNoDriver(m_settings);
    if (!m_report.m_reason.empty()) return true;
    try
    {
        Settings settings = m_settings;
        settings.m_log = nullptr;  // the app's functions stay on the app's threads
        settings.m_parallelFor = nullptr;
        m_start = std::make_unique<Start>(std::move(settings));
        m_report.m_isStarting = true;
        m_report.m_reason = "the host, while a device is being prepared";
    }
    catch (const std::system_error& failure)
    {
        m_error.m_call = std::string("starting a thread failed: ") + failure.what();
        m_report.m_reason = "the host, since " + m_error.m_call;
    }
    return true;
}

bool BackendSelector::isStartDone() const
{
    return m_start && m_start->m_work.isDone();
}

bool BackendSelector::endStart()
{
    if (!m_start) return false;
    const std::unique_ptr<Start> start = std::move(m_start);
    m_report.m_isStarting = false;
    try
    {
        start->m_work.wait();
        take(std::move(start->m_started));
    }
    catch (const std::exception& failure)  // nobody requested the device: the host goes on
    {
        m_device.reset();
        m_wanted.m_device.m_name = "OpenCL";
        Error error;
        error.m_call = failure.what();
        leaveDevice(error);
    }
    return m_device != nullptr;
}

void BackendSelector::take(StartedDevice started)
{
    m_wanted = started.m_wanted;
    m_report.m_reason = m_wanted.m_reason;
    m_report.m_buildMs = started.m_buildMs;
    m_report.m_measureMs = started.m_measureMs;
    if (started.m_error.failed()) return leaveDevice(started.m_error);
    if (!started.m_backend) return;
    useDevice(std::move(started.m_backend));
    if (!m_wanted.m_byCost || m_settings.m_profileKernels) return;
    m_error.m_call = started.m_remark;
    m_report.m_byCost = true;
    m_report.m_crossover = started.m_crossover;
    m_report.m_crossoverSource = started.m_crossoverSource;
    m_choice.begin(started.m_crossover);
    forgetPairs();
    selectByWork();
}

void BackendSelector::useDevice(std::unique_ptr<DeviceBackend> device)
{
    m_device = std::move(device);
    m_report.m_onHost = false;
    m_report.m_device = m_wanted.m_device;
    m_report.m_fromCache = m_device->fromCache();
}

void BackendSelector::reopen(BackendSelector& other)
{
    m_wanted = other.m_wanted;
    m_report = other.m_report;
    m_error = other.m_error;
    m_deviceFailed = other.m_deviceFailed;
    Error error;
    if (other.m_device && !m_deviceFailed)
    {
        std::unique_ptr<DeviceBackend> device = openBackend(m_wanted, m_settings, error);
        if (device) useDevice(std::move(device));
    }
    if (error.failed())
    {
        leaveDevice(error);
    }
    else if (other.m_choice.active())
    {
        m_choice.begin(other.m_choice.crossover());
        selectByWork();
    }
    m_start = std::move(other.m_start);
}

double BackendSelector::compileMs() const
{
    return m_device ? m_device->compileMs() : 0;
}

Device* BackendSelector::device()
{
    return m_device ? &m_device->device() : nullptr;
}

SearchDevice BackendSelector::searchDevice()
{
    if (m_device && m_device->device().failed()) leaveDevice();
    if (!m_device || m_deviceFailed) return {};
    const bool searches = m_device->device().isGpu() || m_settings.m_solverPlace == SolverPlace::Device;
    return searches ? m_device->searchDevice() : SearchDevice();
}

SolveStage* BackendSelector::solveStage(std::size_t nodes)
{
    if (!m_device || m_device->device().failed() || !m_device->solveStage().created()) return nullptr;
    const bool pays = nodes >= kLeastDeviceNodes * m_threads->size() || m_settings.m_solverPlace == SolverPlace::Device;
    return pays ? &m_device->solveStage() : nullptr;
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
