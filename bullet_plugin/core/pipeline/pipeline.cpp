#include "implementation.h"

#include <algorithm>
#include <cassert>

#include "bullet_plugin/core/scene/check_indices.h"
#include "bullet_plugin/core/scene/reserve_room.h"
#include "bullet_plugin/core/stopwatch.h"
#include "check_settings.h"
#include "bullet_plugin/core/backend_choice/scene_work.h"

namespace drape
{
void Pipeline::Implementation::prepareSelf()
{
    if (!m_deviceBackend || m_deviceBackend->device().failed()) return;
    m_deviceBackend->prepareSelf();
    if (m_deviceBackend->device().failed()) leaveDevice();
}

void Pipeline::Implementation::leaveDevice()
{
    if (!m_deviceLeft) goOnWithoutDevice(m_deviceBackend->device().error());
    // Keeps the back end: the scene's pinned memory belongs to its context.
}

void Pipeline::Implementation::goOnWithoutDevice(const Error& error)
{
    m_error = error;
    m_deviceLeft = true;
    m_report.m_reason = hostSince(m_openClDevice, error);
    m_report.m_onHost = true;
    m_report.m_byCost = false;
    m_report.m_device = DeviceInfo();
    m_report.m_device.m_name = "host";
    m_statistics.m_status |= kStepDeviceFailed;
    m_choice.end();
}

bool Pipeline::Implementation::openDevice(Error& error)
{
    Stopwatch watch;
    std::unique_ptr<Device> device = Device::open(m_deviceIndex, error, m_settings.m_profileKernels);
    if (!device) return false;
    m_deviceBackend.reset(new DeviceBackend(std::move(device), m_settings));
    if (m_deviceBackend->device().failed())
    {
        error = m_deviceBackend->device().error();
        m_deviceBackend.reset();
        return false;
    }
    m_report.m_onHost = false;
    m_report.m_device = m_openClDevice;
    m_report.m_fromCache = m_deviceBackend->fromCache();
    m_report.m_buildMs = watch.lapMs();
    return true;
}

Pipeline::Pipeline() : m_implementation(new Implementation) {}
Pipeline::~Pipeline() = default;

std::unique_ptr<Pipeline> Pipeline::create(const Settings& settings, Error& error)
{
    error = Error();
    if (!checkSettings(settings, error)) return nullptr;
    const DeviceChoice choice = chooseDevice(settings, error);
    if (error.failed()) return nullptr;
    std::unique_ptr<Pipeline> pipeline(new Pipeline);
    Implementation& self = *pipeline->m_implementation;
    self.m_settings = settings;
    self.m_threads = std::make_shared<ThreadTeam>(settings.m_threads);
    self.m_hostBackend = std::make_unique<HostBackend>(self.m_threads);
    self.m_report.m_reason = self.m_deviceReason = choice.m_reason;
    self.m_report.m_device.m_name = "host";
    if (choice.m_onHost) return pipeline;
    self.m_openClDevice = choice.m_device;
    self.m_deviceIndex = choice.m_index;
    if (!self.openDevice(error))
    {
        if (!choice.m_byCost) return nullptr;
        self.goOnWithoutDevice(error);
        error = Error();
        return pipeline;
    }
    if (self.costDecides(choice) && !self.beginChoice(*pipeline, error)) return nullptr;
    return pipeline;
}

void Pipeline::restart()
{
    Implementation& old = *m_implementation;
    std::unique_ptr<Implementation> fresh = std::make_unique<Implementation>();
    fresh->m_settings = old.m_settings;
    fresh->m_report = old.m_report;
    fresh->m_error = old.m_error;
    fresh->m_openClDevice = old.m_openClDevice;
    fresh->m_deviceIndex = old.m_deviceIndex;
    fresh->m_deviceReason = old.m_deviceReason;
    fresh->m_nextId = old.m_nextId;
    fresh->m_deviceLeft = old.m_deviceLeft;
    fresh->m_threads = old.m_threads;
    fresh->m_hostBackend = std::make_unique<HostBackend>(fresh->m_threads);
    const bool hasDevice = old.m_deviceBackend && !old.m_deviceLeft;
    Error error;
    if (hasDevice && !fresh->openDevice(error))
    {
        fresh->goOnWithoutDevice(error);
    }
    else if (old.m_choice.active())
    {
        fresh->m_choice.begin(old.m_choice.crossover());
        fresh->useChosen();
    }
    m_implementation = std::move(fresh);
}

const DeviceReport& Pipeline::deviceReport() const
{
    return m_implementation->m_report;
}

MeshId Pipeline::addCloth(const MeshDescription& description)
{
    assert(!m_implementation->m_submitted);
    if (!checkIndices(description, "addCloth", m_implementation->m_error)) return kNoMesh;
    PooledMesh mesh = m_implementation->makeMesh(description);
    const MeshId id = mesh.m_id;
    if (description.m_selfThickness > 0.0f)
    {
        mesh.m_selfThickness = description.m_selfThickness;
        if (description.m_restPositions)
            mesh.m_rest.assign(description.m_restPositions,
                               description.m_restPositions + 3 * description.m_vertexCount);
        m_implementation->prepareSelf();
    }
    m_implementation->m_scene.m_cloths.add(std::move(mesh));
    return id;
}

MeshId Pipeline::addObstacle(const MeshDescription& description)
{
    assert(!m_implementation->m_submitted);
    if (!checkIndices(description, "addObstacle", m_implementation->m_error)) return kNoMesh;
    PooledMesh mesh = m_implementation->makeMesh(description);
    const MeshId id = mesh.m_id;
    mesh.m_oneSided = description.m_oneSided;
    m_implementation->measureObstacle(mesh);
    m_implementation->m_scene.m_obstacles.add(std::move(mesh));
    return id;
}

void Pipeline::remove(MeshId id)
{
    assert(!m_implementation->m_submitted);
    Scene& scene = m_implementation->m_scene;
    if (scene.m_cloths.remove(id))
        m_implementation->forgetNodes();
    else
        scene.m_obstacles.remove(id);
    m_implementation->m_choice.forget(id);
    m_implementation->m_notedPairs.clear();
}

void Pipeline::prepare()
{
    Implementation& self = *m_implementation;
    assert(!self.m_submitted);
    self.joinScene();
    const bool onDevice = self.m_deviceBackend && !self.m_deviceLeft;
    const bool onHost = self.mayStayOnHost();
    self.takeObstacles();
    if (onHost) self.m_hostBackend->prepare(self.m_scene);
    if (!onDevice) return;
    self.m_deviceBackend->prepare(self.m_scene);
    if (self.m_deviceBackend->device().failed()) self.leaveDevice();
}

void Pipeline::giveBackRoom()
{
    Implementation& self = *m_implementation;
    assert(!self.m_submitted);
    Scene& scene = self.m_scene;
    self.joinScene();
    self.m_result = StepResult();
    if (Device* device = self.device()) device->wait();  // it may still read the scene's arrays
    if (self.m_deviceBackend && !self.m_deviceLeft) self.m_deviceBackend->giveBackRoom();
    scene.m_cloths.giveBackRoom();
    scene.m_obstacles.giveBackRoom();
    dropRoom(scene.m_clothRest);
    dropRoom(scene.m_obstaclePositions);
    dropRoom(scene.m_vertexCones);
    dropRoom(scene.m_edgeCones);
    dropRoom(scene.m_places);
    self.m_hostBackend->giveBackRoom();
}

void Pipeline::moveObstacle(MeshId id, const float* positions)
{
    assert(!m_implementation->m_submitted);
    Scene& scene = m_implementation->m_scene;
    m_implementation->joinScene();
    const std::size_t slot = slotOf(scene.m_obstacles, id);
    PooledMesh& mesh = scene.m_obstacles.mesh(slot);
    const auto replace = [](auto& all, std::size_t first, const auto& own)
    { std::copy(own.begin(), own.end(), all.begin() + std::ptrdiff_t(first)); };
    mesh.m_positions.assign(positions, positions + mesh.m_positions.size());
    m_implementation->measureObstacle(mesh);
    mesh.m_area = surfaceArea(mesh.m_topology.m_triangles, positions);
    m_implementation->m_notedPairs.clear();
    replace(scene.m_obstaclePositions, 3 * std::size_t(mesh.m_firstVertex), mesh.m_positions);
    replace(scene.m_vertexCones, mesh.m_firstVertex, mesh.m_vertexCones);
    replace(scene.m_edgeCones, mesh.m_firstEdge, mesh.m_edgeCones);
    mesh.m_given = ++scene.m_obstacleMotion;
    mesh.m_placedAnew = true;
    m_implementation->placeMesh(slot);
}

void Pipeline::placeObstacle(MeshId id, const float startPose[12], const float endPose[12])
{
    assert(!m_implementation->m_submitted);
    Scene& scene = m_implementation->m_scene;
    m_implementation->joinScene();
    const std::size_t slot = slotOf(scene.m_obstacles, id);
    ObstaclePlacing& placing = scene.m_obstacles.mesh(slot).m_placing;
    const bool stays = placing.m_posed && std::equal(placing.m_end.begin(), placing.m_end.end(), endPose);
    placing.m_posed = true;
    std::copy(startPose, startPose + DRAPE_MAP_FLOATS, placing.m_start.begin());
    std::copy(endPose, endPose + DRAPE_MAP_FLOATS, placing.m_end.begin());
    if (stays) return;
    scene.m_obstacles.mesh(slot).m_placedAnew = true;
    m_implementation->placeMesh(slot);
    ++scene.m_obstaclePlacing;
}

const std::shared_ptr<ThreadTeam>& Pipeline::threads() const
{
    return m_implementation->m_threads;
}

void Pipeline::addPair(MeshId cloth, MeshId obstacle, float thickness)
{
    m_implementation->m_pairs.push_back(NamedPair{cloth, obstacle, thickness});
}

void Pipeline::addSelf(MeshId cloth)
{
    m_implementation->m_selfCloths.push_back(cloth);
}

void Pipeline::submit()
{
    Implementation& self = *m_implementation;
    Stopwatch watch;
    self.m_statistics = StepStatistics();
    if (self.m_deviceLeft) self.m_statistics.m_status |= kStepDeviceFailed;
    self.joinScene();
    self.chooseBackend();
    self.collectPairs();
    self.m_submitted = true;
    self.enqueue();
    if (self.m_stepPairs.m_any && !self.m_report.m_onHost) self.m_nodesSent = 0;  // finish() waits for them
    self.forgetNodes();
    self.m_statistics.m_uploadMs = watch.lapMs();
}

ContactList Pipeline::finish(const Allowance& allowance)
{
    Implementation& self = *m_implementation;
    Stopwatch watch;
    StepStatistics& statistics = self.m_statistics;
    self.m_leftOut.clear();
    if (!self.m_stepPairs.m_any || !self.m_submitted)
    {
        self.m_result.clear();
        statistics.m_skipped = true;
    }
    else
    {
        const TestLimits ordinary = self.m_stepPairs.m_limits;
        self.expectMore(allowance);
        self.complete();
        while (self.m_result.m_overLimit)
        {
            if (self.m_result.m_overTests)
                self.leaveOutStretched(allowance);
            else
                self.leaveOutCloths();
            self.enqueue();
            self.complete();
        }
        self.m_neededMore =
            self.m_result.m_candidates > ordinary.m_tests || self.m_result.m_sweptTests > ordinary.m_swept;
    }
    self.m_submitted = false;
    self.dropBackContacts();
    statistics.m_candidates += self.m_result.m_candidates;
    statistics.m_sweptTests = self.m_result.m_sweptTests;
    statistics.m_selfCandidates = self.m_result.m_selfCandidates;
    statistics.m_selfSweptTests = self.m_result.m_selfSweptTests;
    statistics.m_selfContacts = self.m_result.selfContacts().size();
    statistics.m_contacts = self.m_result.contacts().size();
    statistics.m_invalidNodes = self.m_result.m_invalidNodes;
    statistics.m_retries = self.m_result.m_retries;
    statistics.m_refitMs = self.m_result.m_refitMs;
    statistics.m_broadMs = self.m_result.m_broadMs;
    statistics.m_narrowMs = self.m_result.m_narrowMs;
    if (statistics.m_invalidNodes > 0) statistics.m_status |= kStepInvalidNodes;
    statistics.m_waitMs = watch.lapMs();
    return self.m_result.contacts();
}

ContactList Pipeline::selfContacts() const
{
    return m_implementation->m_result.selfContacts();
}

const std::vector<MeshId>& Pipeline::clothsLeftOut() const
{
    return m_implementation->m_leftOut;
}

const StepStatistics& Pipeline::statistics() const
{
    return m_implementation->m_statistics;
}
std::vector<KernelTime> Pipeline::takeKernelTimes()
{
    Device* device = m_implementation->device();
    if (!device || !device->profiler()) return {};
    device->wait();
    return device->profiler()->take();
}
std::vector<MemoryUse> Pipeline::deviceMemory() const
{
    Device* device = m_implementation->device();
    return device ? device->memory().list() : std::vector<MemoryUse>();
}
bool Pipeline::deviceFailed() const
{
    return m_implementation->m_deviceLeft;
}
const Error& Pipeline::lastError() const
{
    return m_implementation->m_error;
}
}  // namespace drape
