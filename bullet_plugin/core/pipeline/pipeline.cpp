#include "pipeline.h"

#include <algorithm>
#include <cassert>

#include "back_contacts.h"
#include "bullet_plugin/core/backends/device_backend.h"
#include "bullet_plugin/core/check_settings.h"
#include "bullet_plugin/core/probe/mesh_probe.h"
#include "bullet_plugin/core/scene/check_indices.h"
#include "bullet_plugin/core/stopwatch.h"
#include "node_upload.h"
#include "step_runner.h"

namespace drape
{
struct Pipeline::Implementation
{
    explicit Implementation(const Settings& settings, std::shared_ptr<ThreadTeam> threads, MeshId firstId = 0)
        : m_settings(settings), m_threads(std::move(threads)), m_scene(firstId)
    {
    }

    // Joins the meshes, and forgets nodes that move by that.
    void join()
    {
        if (m_scene.isJoined()) return;
        m_nodes.forget();
        m_scene.join(m_backends.device());
    }

    const Settings m_settings;
    const std::shared_ptr<ThreadTeam> m_threads;
    Scene m_scene;  // before the back ends: they may still read its memory while they end
    BackendSelector m_backends{m_settings, m_threads};
    NodeUpload m_nodes;
    StepInput m_input;
    StepPairs m_pairs;
    StepRunner m_runner{m_backends, m_settings, m_scene, m_pairs};
    StepResult m_result;
    StepStatistics m_statistics;
    ContactPlace m_place = ContactPlace::Host;
    bool m_submitted = false;
};

Pipeline::Pipeline(std::unique_ptr<Implementation> implementation) : m_implementation(std::move(implementation)) {}
Pipeline::~Pipeline() = default;

std::unique_ptr<Pipeline> Pipeline::create(const Settings& settings, Error& error)
{
    error = Error();
    if (!checkSettings(settings, error)) return nullptr;
    auto threads = std::make_shared<ThreadTeam>(settings.m_threads, settings.m_parallelFor);
    auto implementation = std::make_unique<Implementation>(settings, std::move(threads));
    if (!implementation->m_backends.open(error)) return nullptr;
    return std::unique_ptr<Pipeline>(new Pipeline(std::move(implementation)));
}

void Pipeline::restart()
{
    Implementation& old = *m_implementation;
    auto fresh = std::make_unique<Implementation>(old.m_settings, old.m_threads, old.m_scene.nextId());
    fresh->m_backends.reopen(old.m_backends);
    m_implementation = std::move(fresh);
}

bool Pipeline::isStartDone() const
{
    return m_implementation->m_backends.isStartDone();
}

void Pipeline::endStart()
{
    Implementation& self = *m_implementation;
    assert(!self.m_submitted);
    if (!self.m_backends.endStart()) return;
    self.join();
    self.m_nodes.forget();
    self.m_scene.pinNodes(*self.m_backends.device());
    if (self.m_scene.m_anySelf) self.m_backends.prepareSelf();
}

const DeviceReport& Pipeline::deviceReport() const
{
    return m_implementation->m_backends.report();
}

DeviceInfo Pipeline::openDevice() const
{
    const Device* const device = m_implementation->m_backends.device();
    if (device) return device->info();
    DeviceInfo host;
    host.m_name = "host";
    return host;
}

double Pipeline::compileMs() const
{
    return m_implementation->m_backends.compileMs();
}

MeshId Pipeline::addCloth(const MeshDescription& mesh)
{
    Implementation& self = *m_implementation;
    assert(!self.m_submitted);
    if (!checkIndices(mesh, "addCloth", self.m_backends.lastError())) return kNoMesh;
    if (mesh.m_selfThickness > 0.0f) self.m_backends.prepareSelf();
    return self.m_scene.addCloth(mesh);
}

MeshId Pipeline::addObstacle(const MeshDescription& mesh)
{
    Implementation& self = *m_implementation;
    assert(!self.m_submitted);
    if (!checkIndices(mesh, "addObstacle", self.m_backends.lastError())) return kNoMesh;
    return self.m_scene.addObstacle(mesh);
}

void Pipeline::remove(MeshId mesh)
{
    Implementation& self = *m_implementation;
    assert(!self.m_submitted);
    self.m_nodes.forget();
    self.m_scene.remove(mesh);
    self.m_backends.forget(mesh);
}

void Pipeline::prepare()
{
    Implementation& self = *m_implementation;
    assert(!self.m_submitted);
    self.join();
    self.m_scene.markObstaclesUsed();
    self.m_backends.prepare(self.m_scene);
}

void Pipeline::giveBackRoom()
{
    Implementation& self = *m_implementation;
    assert(!self.m_submitted);
    self.join();
    self.m_result = StepResult();
    if (Device* device = self.m_backends.device()) device->wait();  // it may still read the scene's arrays
    self.m_backends.giveBackRoom();
    self.m_scene.giveBackRoom();
}

void Pipeline::moveObstacle(MeshId obstacle, const float* positions)
{
    assert(!m_implementation->m_submitted);
    m_implementation->join();
    m_implementation->m_scene.moveObstacle(obstacle, positions);
    m_implementation->m_backends.forgetPairs();
}

void Pipeline::placeObstacle(MeshId obstacle, const float startPose[12], const float endPose[12])
{
    assert(!m_implementation->m_submitted);
    m_implementation->join();
    m_implementation->m_scene.placeObstacle(obstacle, startPose, endPose);
}

float* Pipeline::clothStart(MeshId cloth)
{
    Scene& scene = m_implementation->m_scene;
    m_implementation->join();
    return scene.m_clothNodes.start() + 3 * std::size_t(scene.m_cloths.existing(cloth).m_firstVertex);
}

float* Pipeline::clothEnd(MeshId cloth)
{
    Scene& scene = m_implementation->m_scene;
    m_implementation->join();
    return scene.m_clothNodes.end() + 3 * std::size_t(scene.m_cloths.existing(cloth).m_firstVertex);
}

void Pipeline::nodesWritten(MeshId cloth, std::size_t count)
{
    Implementation& self = *m_implementation;
    self.join();
    self.m_nodes.declare(self.m_scene, cloth, count, self.m_backends.chosenDevice());
}

void Pipeline::writeNodes(const std::vector<MeshId>& cloths, const std::function<void(const NodeStretch&)>& write)
{
    Implementation& self = *m_implementation;
    self.join();
    self.m_nodes.write(self.m_scene, cloths, write, self.m_backends.chosenDevice(), *self.m_threads);
}

void Pipeline::copyNodes(const std::vector<MeshId>& cloths, const float* start, const float* end)
{
    std::vector<std::size_t> firsts(1, 0);
    for (const MeshId id : cloths)
        firsts.push_back(firsts.back() + m_implementation->m_scene.m_cloths.existing(id).m_positions.size());
    writeNodes(cloths,
               [&](const NodeStretch& stretch)
               {
                   const std::size_t from = firsts[stretch.m_cloth] + 3 * stretch.m_first;
                   std::copy_n(start + from, 3 * stretch.m_count, stretch.m_start);
                   std::copy_n(end + from, 3 * stretch.m_count, stretch.m_end);
               });
}

bool Pipeline::anyTriangleIn(MeshId obstacle, const float low[3], const float high[3])
{
    return drape::anyTriangleIn(m_implementation->m_scene.m_obstacles.existing(obstacle), low, high);
}

std::unique_ptr<MeshProbe> Pipeline::makeProbe(MeshId obstacle)
{
    const PooledMesh& mesh = m_implementation->m_scene.m_obstacles.existing(obstacle);
    return std::make_unique<MeshProbe>(mesh.m_topology, mesh.m_order, mesh.m_positions);
}

std::int32_t Pipeline::sourceTriangle(MeshId obstacle, std::uint32_t triangle) const
{
    const Topology& topology = m_implementation->m_scene.m_obstacles.existing(obstacle).m_topology;
    return triangle < topology.m_sourceTriangle.size() ? std::int32_t(topology.m_sourceTriangle[triangle]) : -1;
}

void Pipeline::addPair(MeshId cloth, MeshId obstacle, float thickness)
{
    m_implementation->m_input.addPair(NamedPair{cloth, obstacle, thickness});
}

void Pipeline::addSelf(MeshId cloth)
{
    m_implementation->m_input.addSelf(cloth);
}

void Pipeline::addKept(MeshId cloth, const KeptStep& step)
{
    m_implementation->m_input.addKept({cloth, step});
}

bool Pipeline::mayStay()
{
    Implementation& self = *m_implementation;
    self.join();
    self.m_backends.choose(self.m_scene, self.m_input);
    return self.m_backends.chosenDevice() && self.m_input.selfCloths().empty() && !hasOneSided(self.m_scene);
}

void Pipeline::submit(ContactPlace place)
{
    Implementation& self = *m_implementation;
    Stopwatch watch;
    self.m_statistics = StepStatistics();
    self.m_place = mayStay() ? place : ContactPlace::Host;
    self.m_input.collect(self.m_scene, self.m_settings.m_activation, self.m_pairs, self.m_statistics);
    self.m_submitted = true;
    self.m_runner.submit(self.m_place, self.m_nodes.sent());
    if (self.m_pairs.m_any && self.m_backends.chosenDevice())
        self.m_nodes.passToStep();
    else
        self.m_nodes.forget();
    self.m_statistics.m_uploadMs = watch.lapMs();
}

DeviceContacts Pipeline::contactsOnDevice()
{
    Implementation& self = *m_implementation;
    const bool stay = self.m_submitted && self.m_pairs.m_any && self.m_place == ContactPlace::Device;
    return stay ? self.m_backends.chosenDevice()->contactsOnDevice() : DeviceContacts();
}

ContactList Pipeline::finish(const Allowance& allowance)
{
    Implementation& self = *m_implementation;
    Stopwatch watch;
    StepStatistics& statistics = self.m_statistics;
    statistics.m_skipped = !self.m_pairs.m_any || !self.m_submitted;
    if (statistics.m_skipped)
        self.m_runner.skip(self.m_result);
    else
        self.m_runner.finish(allowance, self.m_result, statistics);
    self.m_submitted = false;
    removeBackContacts(self.m_scene, self.m_result);
    statistics.m_selfContacts = self.m_result.selfContacts().size();
    statistics.m_contacts =
        self.m_result.m_isOnDevice ? self.m_result.m_countOnDevice : self.m_result.contacts().size();
    if (statistics.m_invalidNodes > 0) statistics.m_status |= kStepInvalidNodes;
    if (self.m_backends.deviceFailed()) statistics.m_status |= kStepDeviceFailed;
    statistics.m_waitMs = watch.lapMs();
    return self.m_result.contacts();
}

bool Pipeline::areContactsOnDevice() const
{
    return m_implementation->m_result.m_isOnDevice;
}

bool Pipeline::ranOnce() const
{
    return !m_implementation->m_result.m_isRepeated;
}

ContactList Pipeline::bringContacts()
{
    Implementation& self = *m_implementation;
    Stopwatch watch;
    if (self.m_result.m_isOnDevice) self.m_runner.bringContacts(self.m_result, self.m_statistics);
    self.m_statistics.m_waitMs += watch.lapMs();
    return self.m_result.contacts();
}

ContactList Pipeline::selfContacts() const
{
    return m_implementation->m_result.selfContacts();
}

const std::vector<MeshId>& Pipeline::clothsLeftOut() const
{
    return m_implementation->m_runner.clothsLeftOut();
}

const StepStatistics& Pipeline::statistics() const
{
    return m_implementation->m_statistics;
}

std::vector<KernelTime> Pipeline::takeKernelTimes()
{
    Device* device = m_implementation->m_backends.device();
    if (!device || !device->profiler()) return {};
    device->wait();
    return device->profiler()->take();
}

std::vector<MemoryUse> Pipeline::deviceMemory() const
{
    Device* device = m_implementation->m_backends.device();
    return device ? device->memory().list() : std::vector<MemoryUse>();
}

const std::shared_ptr<ThreadTeam>& Pipeline::threads() const
{
    return m_implementation->m_threads;
}

SolveStage* Pipeline::solveStage(std::size_t nodes)
{
    return m_implementation->m_backends.solveStage(nodes);
}

SearchDevice Pipeline::searchDevice()
{
    return m_implementation->m_backends.searchDevice();
}

void Pipeline::prepareSearch()
{
    if (searchDevice().m_device) m_implementation->m_backends.prepareSelf();
}

bool Pipeline::waitForDevice()
{
    Device* const device = m_implementation->m_backends.device();
    if (device) device->wait();
    return device && !device->failed();
}

std::size_t Pipeline::deviceWaits() const
{
    const Device* const device = m_implementation->m_backends.device();
    return device ? device->waits() : 0;
}

bool Pipeline::deviceFailed() const
{
    return m_implementation->m_backends.deviceFailed();
}

const Error& Pipeline::lastError() const
{
    return m_implementation->m_backends.lastError();
}

ContactView Pipeline::view(const Contact& contact) const
{
    return viewContact(m_implementation->m_scene, m_implementation->m_pairs, contact);
}

SelfContactView Pipeline::viewSelf(const Contact& contact) const
{
    return viewSelfContact(m_implementation->m_scene, contact);
}

ClothFeature Pipeline::clothFeature(const Contact& contact) const
{
    return clothFeatureOf(m_implementation->m_scene.m_cloths, contact);
}

const Scene& Pipeline::scene() const
{
    return m_implementation->m_scene;
}

const StepPairs& Pipeline::pairs() const
{
    return m_implementation->m_pairs;
}
}  // namespace drape
