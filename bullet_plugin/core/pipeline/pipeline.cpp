#include "implementation.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>

#include "bullet_plugin/core/bvh/morton_order.h"
#include "bullet_plugin/core/mesh/check_indices.h"
#include "bullet_plugin/core/mesh/normal_cones.h"
#include "bullet_plugin/core/mesh/reserve_room.h"
#include "check_settings.h"
#include "scene_work.h"

namespace drape
{
namespace
{
using Clock = std::chrono::steady_clock;

// Volumes reach a little further than the feature tests, by more than those round, so that which pairs were candidates
// never decides whether a pair is a contact.
constexpr float kReachPad = 1.001f;
// Share of the longest edge of an obstacle by which candidates are looked for farther than contacts reach: the search
// for meetings takes features for met that are apart by a share of their size (isSwept in kernels/lib/rigid_motion.h).
constexpr float kEdgePad = 1e-4f;
// Nodes that go to the device before all are written: 0.4 MB each of start and end, so that a transfer takes longer
// than it takes to ask for it.
constexpr std::size_t kNodesTogether = 1 << 15;
// Nodes that one thread writes before it looks for others, and from how many on it is worth waking threads.
constexpr std::size_t kNodesAlone = 1 << 11;
constexpr std::size_t kLeastShared = 1 << 14;

double millisecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}
}  // namespace

PooledMesh Pipeline::Implementation::makeMesh(const MeshDescription& description)
{
    PooledMesh mesh;
    mesh.m_id = m_nextId++;
    mesh.m_topology = buildTopology(description.m_triangles, description.m_triangleCount, description.m_vertexCount);
    mesh.m_positions.assign(description.m_positions, description.m_positions + 3 * description.m_vertexCount);
    mesh.m_area = surfaceArea(mesh.m_topology.m_triangles, mesh.m_positions.data());
    mesh.m_order = mortonOrderOnHost(mesh.m_topology.m_triangles, mesh.m_positions.data());
    return mesh;
}

void Pipeline::Implementation::measureObstacle(PooledMesh& mesh)
{
    computeNormalCones(mesh.m_topology, mesh.m_positions.data(), mesh.m_vertexCones, mesh.m_edgeCones);
    const float infinity = std::numeric_limits<float>::infinity();
    mesh.m_box = MeshBox{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (std::size_t i = 0; i < mesh.m_positions.size(); ++i)
    {
        const float coordinate = mesh.m_positions[i];
        if (!std::isfinite(coordinate)) continue;
        mesh.m_box.m_low[i % 3] = std::min(mesh.m_box.m_low[i % 3], coordinate);
        mesh.m_box.m_high[i % 3] = std::max(mesh.m_box.m_high[i % 3], coordinate);
    }
    mesh.m_longestEdge = 0;
    for (const Edge& edge : mesh.m_topology.m_edges)
    {
        const Vec3 a = vec3Load(mesh.m_positions.data(), edge.m_vertices[0]);
        const float length = vec3Length(vec3Sub(vec3Load(mesh.m_positions.data(), edge.m_vertices[1]), a));
        if (std::isfinite(length)) mesh.m_longestEdge = std::max(mesh.m_longestEdge, length);
    }
}

void Pipeline::Implementation::placeMesh(std::size_t slot)
{
    PooledMesh& mesh = m_scene.m_obstacles.mesh(slot);
    const ObstaclePlacing& placing = mesh.m_placing;
    ObstaclePlace& place = m_scene.m_places[slot];
    std::copy(placing.m_end.begin(), placing.m_end.end(), place.m_pose);
    place.m_posed = placing.m_posed;
    place.m_firstVertex = mesh.m_firstVertex;
    place.m_firstEdge = mesh.m_firstEdge;
    m_scene.m_anyPosed = m_scene.m_anyPosed || placing.m_posed;
    const MeshBox box = placing.m_posed ? placedBox(placing.m_end, mesh.m_box) : mesh.m_box;
    float farthest = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        for (float bound : {box.m_low[axis], box.m_high[axis]})
            if (std::isfinite(bound)) farthest = std::max(farthest, std::fabs(bound));
    }
    mesh.m_coordinateStep = std::nextafter(farthest, std::numeric_limits<float>::infinity()) - farthest;
}

void Pipeline::Implementation::joinCloths(std::size_t first)
{
    const MeshPool& cloths = m_scene.m_cloths;
    forgetNodes();
    const std::size_t coordinates = 3 * cloths.vertexCount();
    if (m_scene.m_clothStart.capacity() < coordinates)
    {
        // Their contents are lost; a quarter more where it is not the first time.
        const std::size_t room = coordinates + (first > 0 ? coordinates / 4 : 0);
        m_scene.m_clothStart.reserve(device(), room);
        m_scene.m_clothEnd.reserve(device(), room);
        first = 0;
    }
    for (std::size_t slot = first; slot < cloths.meshCount(); ++slot)
    {
        const PooledMesh& mesh = cloths.mesh(slot);
        for (float* target : {m_scene.m_clothStart.data(), m_scene.m_clothEnd.data()})
        {
            std::copy(mesh.m_positions.begin(), mesh.m_positions.end(), target + 3 * std::size_t(mesh.m_firstVertex));
        }
    }
    joinRest();
}

void Pipeline::Implementation::joinRest()
{
    const MeshPool& cloths = m_scene.m_cloths;
    m_scene.m_anySelf = false;
    for (std::size_t slot = 0; slot < cloths.meshCount(); ++slot)
        m_scene.m_anySelf |= cloths.mesh(slot).m_selfThickness > 0.0f && !cloths.mesh(slot).m_vacant;
    m_scene.m_clothRest.clear();
    for (std::size_t slot = 0; slot < cloths.meshCount() && m_scene.m_anySelf; ++slot)
    {
        const PooledMesh& mesh = cloths.mesh(slot);
        const std::vector<float>& rest = mesh.m_rest.empty() ? mesh.m_positions : mesh.m_rest;
        m_scene.m_clothRest.insert(m_scene.m_clothRest.end(), rest.begin(), rest.end());
    }
}

void Pipeline::Implementation::forgetNodes()
{
    if (m_nodesSent > 0) m_deviceBackend->device().wait();
    m_nodesWritten = m_nodesSent = 0;
}

// Nobody writes those.
void Pipeline::Implementation::passVacantNodes(std::size_t last)
{
    const MeshPool& cloths = m_scene.m_cloths;
    while (m_nodesWritten < last)
    {
        const std::size_t slot = cloths.slotOfVertex(std::uint32_t(m_nodesWritten));
        if (!cloths.mesh(slot).m_vacant) return;
        m_nodesWritten = cloths.begin(slot + 1).m_vertex;
    }
}

std::vector<NodeStretch> Pipeline::Implementation::stretchesOf(const std::vector<MeshId>& ids)
{
    std::vector<NodeStretch> stretches;
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
        const PooledMesh& mesh = m_scene.m_cloths.mesh(m_scene.m_cloths.slot(ids[i]));
        const std::size_t nodes = mesh.m_positions.size() / 3;
        for (std::size_t first = 0; first < nodes; first += kNodesAlone)
        {
            const std::size_t at = 3 * (mesh.m_firstVertex + first);
            stretches.push_back(NodeStretch{i, first, std::min(kNodesAlone, nodes - first),
                                            m_scene.m_clothStart.data() + at, m_scene.m_clothEnd.data() + at});
        }
    }
    return stretches;
}

void Pipeline::Implementation::joinObstacles(std::size_t first)
{
    MeshPool& pool = m_scene.m_obstacles;
    const MeshFirsts kept = pool.begin(first);
    m_scene.m_obstaclePositions.resize(3 * std::size_t(kept.m_vertex));
    m_scene.m_vertexCones.resize(kept.m_vertex);
    m_scene.m_edgeCones.resize(kept.m_edge);
    m_scene.m_places.resize(pool.meshCount());
    if (pool.meshCount() == 0) m_scene.m_anyPosed = false;
    const MeshFirsts end = pool.begin(pool.meshCount());
    reserveRoom(m_scene.m_obstaclePositions, 3 * std::size_t(end.m_vertex));
    reserveRoom(m_scene.m_vertexCones, end.m_vertex);
    reserveRoom(m_scene.m_edgeCones, end.m_edge);
    const auto append = [](auto& all, const auto& own) { all.insert(all.end(), own.begin(), own.end()); };
    for (std::size_t slot = first; slot < pool.meshCount(); ++slot)
    {
        PooledMesh& mesh = pool.mesh(slot);
        append(m_scene.m_obstaclePositions, mesh.m_positions);
        append(m_scene.m_vertexCones, mesh.m_vertexCones);
        append(m_scene.m_edgeCones, mesh.m_edgeCones);
        mesh.m_placedAnew = true;
        placeMesh(slot);
    }
}

void Pipeline::Implementation::joinScene()
{
    MeshPool& cloths = m_scene.m_cloths;
    MeshPool& obstacles = m_scene.m_obstacles;
    cloths.update();
    obstacles.update();
    if (m_clothRevision != cloths.revision())
    {
        joinCloths(cloths.firstSince(m_clothRevision));
        m_clothHierarchy.begin(cloths);
        m_clothRevision = cloths.revision();
        m_treeWatch.begin();
    }
    if (m_obstacleRevision != obstacles.revision())
    {
        joinObstacles(obstacles.firstSince(m_obstacleRevision));
        m_obstacleHierarchy.begin(obstacles);
        m_obstacleRevision = obstacles.revision();
    }
}

void Pipeline::Implementation::collectPairs()
{
    const std::size_t obstacleMeshes = m_scene.m_obstacles.meshCount();
    m_stepPairs.m_thickness.assign(m_scene.m_cloths.meshCount() * obstacleMeshes, -1.0f);
    m_stepPairs.m_clothRadius.assign(m_scene.m_cloths.meshCount(), -1.0f);
    m_stepPairs.m_anyPair = false;
    m_paired.assign(obstacleMeshes, false);
    for (const NamedPair& pair : m_pairs)
    {
        const std::size_t cloth = m_scene.m_cloths.slot(pair.m_cloth);
        const std::size_t obstacle = m_scene.m_obstacles.slot(pair.m_obstacle);
        assert(cloth < m_scene.m_cloths.meshCount() && obstacle < obstacleMeshes && pair.m_thickness > 0.0f);
        m_stepPairs.m_thickness[cloth * obstacleMeshes + obstacle] = pair.m_thickness;
        m_paired[obstacle] = true;
        if (m_scene.m_obstacles.mesh(obstacle).m_coordinateStep > pair.m_thickness)
            m_statistics.m_status |= kStepCoarsePositions;
        float& radius = m_stepPairs.m_clothRadius[cloth];
        radius = std::max(radius, pair.m_thickness * (1.0f + m_settings.m_activation) * kReachPad +
                                      kEdgePad * m_scene.m_obstacles.mesh(obstacle).m_longestEdge);
        m_stepPairs.m_anyPair = true;
    }
    m_stepPairs.m_measureTree =
        m_stepPairs.m_anyPair && watchesClothTree(m_settings, m_report.m_onHost) && m_treeWatch.isDue();
    collectMotions();
    if (m_stepPairs.m_anyPair) m_statistics.m_obstaclesKept = countKept();
    collectTubes();
    m_pairs.clear();
    const std::size_t clothTriangles = m_scene.m_cloths.triangles().size();
    const std::size_t obstacleTriangles = m_scene.m_obstacles.triangles().size();
    m_statistics.m_clothTriangles = m_scene.m_cloths.presentTriangles();
    m_statistics.m_obstacleTriangles = m_scene.m_obstacles.presentTriangles();
    if (clothTriangles == 0 || obstacleTriangles == 0) m_stepPairs.m_anyPair = false;
    collectSelf();
    m_stepPairs.m_any = m_stepPairs.m_anyPair || m_stepPairs.m_anySelf;
}

void Pipeline::Implementation::collectSelf()
{
    const MeshPool& cloths = m_scene.m_cloths;
    m_stepPairs.m_self.m_thickness.assign(cloths.meshCount(), -1.0f);
    m_stepPairs.m_self.m_radius.assign(cloths.meshCount(), -1.0f);
    m_stepPairs.m_anySelf = false;
    for (MeshId id : m_selfCloths)
    {
        const std::size_t slot = cloths.slot(id);
        assert(slot < cloths.meshCount() && cloths.mesh(slot).m_selfThickness > 0.0f);
        const float thickness = cloths.mesh(slot).m_selfThickness;
        m_stepPairs.m_self.m_thickness[slot] = thickness;
        m_stepPairs.m_self.m_radius[slot] = selfGrowth(thickness * (1.0f + m_settings.m_activation));
        m_stepPairs.m_anySelf = m_stepPairs.m_anySelf || !cloths.mesh(slot).m_topology.m_triangles.empty();
    }
    m_selfCloths.clear();
}

void Pipeline::Implementation::collectMotions()
{
    const MeshPool& obstacles = m_scene.m_obstacles;
    m_stepPairs.m_motions.clear();
    for (std::size_t slot = 0; slot < obstacles.meshCount(); ++slot)
    {
        const PooledMesh& mesh = obstacles.mesh(slot);
        if (m_paired[slot] && mesh.m_placing.moves())
            m_stepPairs.m_motions.push_back(makeMotion(mesh.m_placing, mesh.m_box, std::uint32_t(slot)));
    }
}

std::size_t Pipeline::Implementation::countKept()
{
    MeshPool& obstacles = m_scene.m_obstacles;
    // On a device that walks it the obstacles' hierarchy is made or refitted with new ones and those that move, on the
    // host where it is not joined out of the obstacles' own. Patches are an obstacle's own.
    const bool onTree = !m_report.m_onHost && !goesOverPatches(m_settings);
    const bool asOne = onTree || (m_report.m_onHost && !m_scene.m_obstacleLayout.joined());
    bool allAnew = asOne && m_stepRevision != m_obstacleRevision;
    m_stepRevision = m_obstacleRevision;
    std::size_t kept = 0;
    for (std::size_t slot = 0; slot < obstacles.meshCount(); ++slot)
    {
        PooledMesh& mesh = obstacles.mesh(slot);
        allAnew = allAnew || (asOne && mesh.m_placedAnew);
        if (m_paired[slot] && !mesh.m_placedAnew) ++kept;
        mesh.m_placedAnew = false;
    }
    return allAnew ? 0 : kept;
}

// A cloth's contacts are reduced where all its obstacles rest and are two-sided: the solver keeps a node near its way
// as each moving obstacle sees it, and contacts on the back of a one-sided one are not held.
void Pipeline::Implementation::collectTubes()
{
    const MeshPool& obstacles = m_scene.m_obstacles;
    m_stepPairs.m_tube.assign(m_stepPairs.m_thickness.size(), -1.0f);
    m_stepPairs.m_anyTube = false;
    if (!m_settings.m_reduceContacts) return;
    std::vector<bool> exempt(m_scene.m_cloths.meshCount(), false);
    for (const NamedPair& pair : m_pairs)
    {
        const PooledMesh& obstacle = obstacles.mesh(obstacles.slot(pair.m_obstacle));
        if (obstacle.m_placing.moves() || obstacle.m_oneSided || !(pair.m_tube >= 0.0f))
            exempt[m_scene.m_cloths.slot(pair.m_cloth)] = true;
    }
    for (const NamedPair& pair : m_pairs)
    {
        const std::size_t cloth = m_scene.m_cloths.slot(pair.m_cloth);
        if (exempt[cloth]) continue;
        m_stepPairs.m_tube[cloth * obstacles.meshCount() + obstacles.slot(pair.m_obstacle)] = pair.m_tube;
        m_stepPairs.m_anyTube = true;
    }
}

void Pipeline::Implementation::prepareSelf()
{
    if (!m_deviceBackend || m_deviceBackend->device().failed()) return;
    m_deviceBackend->prepareSelf();
    if (m_deviceBackend->device().failed()) leaveDevice();
}

void Pipeline::Implementation::leaveDevice()
{
    if (!m_deviceLeft) goOnWithoutDevice(m_deviceBackend->device().error());
    // The backend stays: the scene's pinned memory is its context's.
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

bool Pipeline::Implementation::openDevice(const DeviceChoice& choice, Error& error)
{
    const Clock::time_point start = Clock::now();
    m_openClDevice = choice.m_device;
    std::unique_ptr<Device> device = Device::open(choice.m_index, error, m_settings.m_profileKernels);
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
    m_report.m_buildMs = millisecondsSince(start);
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
    self.m_hostBackend = HostBackend(settings.m_methods);
    self.m_report.m_reason = self.m_deviceReason = choice.m_reason;
    self.m_report.m_device.m_name = "host";
    if (choice.m_onHost) return pipeline;
    if (!self.openDevice(choice, error))
    {
        if (!choice.m_byCost) return nullptr;
        self.goOnWithoutDevice(error);
        error = Error();
        return pipeline;
    }
    if (self.costDecides(choice) && !self.beginChoice(*pipeline, error)) return nullptr;
    return pipeline;
}

const DeviceReport& Pipeline::deviceReport() const
{
    return m_implementation->m_report;
}

MeshId Pipeline::addCloth(const MeshDescription& description)
{
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
    {
        m_implementation->forgetNodes();
        m_implementation->m_treeWatch.begin();
    }
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
    if (onHost || !goesOverPatches(self.m_settings)) self.buildHierarchies();
    self.m_stepRevision = self.m_obstacleRevision;
    for (std::size_t slot = 0; slot < self.m_scene.m_obstacles.meshCount(); ++slot)
        self.m_scene.m_obstacles.mesh(slot).m_placedAnew = false;
    if (onHost) self.m_hostBackend.prepare(self.m_scene);
    if (!onDevice) return;
    self.m_deviceBackend->prepare(self.m_scene);
    if (self.m_deviceBackend->device().failed()) self.leaveDevice();
}

void Pipeline::moveObstacle(MeshId id, const float* positions)
{
    Scene& scene = m_implementation->m_scene;
    m_implementation->joinScene();
    const std::size_t slot = scene.m_obstacles.slot(id);
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
    Scene& scene = m_implementation->m_scene;
    m_implementation->joinScene();
    const std::size_t slot = scene.m_obstacles.slot(id);
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

float* Pipeline::clothStart(MeshId id)
{
    m_implementation->joinScene();
    Scene& scene = m_implementation->m_scene;
    return scene.m_clothStart.data() + 3 * std::size_t(scene.m_cloths.mesh(scene.m_cloths.slot(id)).m_firstVertex);
}

float* Pipeline::clothEnd(MeshId id)
{
    m_implementation->joinScene();
    Scene& scene = m_implementation->m_scene;
    return scene.m_clothEnd.data() + 3 * std::size_t(scene.m_cloths.mesh(scene.m_cloths.slot(id)).m_firstVertex);
}

void Pipeline::nodesWritten(MeshId id, std::size_t count)
{
    Implementation& self = *m_implementation;
    if (self.m_report.m_onHost) return;
    self.joinScene();
    const MeshPool& cloths = self.m_scene.m_cloths;
    const std::size_t first = cloths.mesh(cloths.slot(id)).m_firstVertex;
    assert(first + count <= cloths.vertexCount());
    self.passVacantNodes(first);
    if (first > self.m_nodesWritten) return;
    self.m_nodesWritten = std::max(self.m_nodesWritten, first + count);
    const std::size_t unsent = self.m_nodesWritten - self.m_nodesSent;
    if (unsent >= kNodesTogether && self.m_deviceBackend->sendNodes(self.m_scene, self.m_nodesSent, unsent))
        self.m_nodesSent = self.m_nodesWritten;
}

void Pipeline::writeNodes(const std::vector<MeshId>& ids, const std::function<void(const NodeStretch&)>& write)
{
    Implementation& self = *m_implementation;
    self.joinScene();
    const std::vector<NodeStretch> stretches = self.stretchesOf(ids);
    for (std::size_t first = 0, last; first < stretches.size(); first = last)
    {
        std::size_t nodes = 0;
        for (last = first; last < stretches.size() && nodes < kNodesTogether; ++last)
            nodes += stretches[last].m_count;
        const auto writeOne = [&](std::size_t i) { write(stretches[first + i]); };
        if (nodes >= kLeastShared && self.runsOnGpu())
            self.m_threads->run(last - first, writeOne);
        else
            for (std::size_t i = 0; i < last - first; ++i)
                writeOne(i);
        for (std::size_t i = first; i < last; ++i)
            nodesWritten(ids[stretches[i].m_cloth], stretches[i].m_first + stretches[i].m_count);
    }
}

void Pipeline::copyNodes(const std::vector<MeshId>& ids, const float* start, const float* end)
{
    const MeshPool& cloths = m_implementation->m_scene.m_cloths;
    m_implementation->joinScene();
    std::vector<std::size_t> firsts(1, 0);
    for (const MeshId id : ids)
        firsts.push_back(firsts.back() + cloths.mesh(cloths.slot(id)).m_positions.size());
    writeNodes(ids,
               [&](const NodeStretch& stretch)
               {
                   const std::size_t from = firsts[stretch.m_cloth] + 3 * stretch.m_first;
                   std::copy_n(start + from, 3 * stretch.m_count, stretch.m_start);
                   std::copy_n(end + from, 3 * stretch.m_count, stretch.m_end);
               });
}

const std::shared_ptr<ThreadTeam>& Pipeline::threads() const
{
    return m_implementation->m_threads;
}

void Pipeline::addPair(MeshId cloth, MeshId obstacle, float thickness, float tube)
{
    m_implementation->m_pairs.push_back(NamedPair{cloth, obstacle, thickness, tube});
}

void Pipeline::addSelf(MeshId cloth)
{
    m_implementation->m_selfCloths.push_back(cloth);
}

void Pipeline::submit()
{
    Implementation& self = *m_implementation;
    const Clock::time_point start = Clock::now();
    self.m_statistics = StepStatistics();
    if (self.m_deviceLeft) self.m_statistics.m_status |= kStepDeviceFailed;
    self.joinScene();
    self.chooseBackend();
    if (self.walksHierarchies())
        self.buildHierarchies();
    else if (!self.m_report.m_onHost && !goesOverPatches(self.m_settings))
        self.layOut();
    self.takeRebuilt();
    self.collectPairs();
    self.m_submitted = true;
    self.enqueue();
    if (self.m_stepPairs.m_any && !self.m_report.m_onHost) self.m_nodesSent = 0;  // finish() waits for them
    self.forgetNodes();
    self.m_statistics.m_uploadMs = millisecondsSince(start);
}

ContactList Pipeline::finish()
{
    Implementation& self = *m_implementation;
    const Clock::time_point start = Clock::now();
    StepStatistics& statistics = self.m_statistics;
    if (!self.m_stepPairs.m_any || !self.m_submitted)
    {
        self.m_result = StepResult();
        statistics.m_skipped = true;
    }
    else
    {
        self.complete();
        while (self.m_result.m_overLimit)
        {
            self.leaveOutCloths();
            self.enqueue();
            self.complete();
        }
    }
    self.m_submitted = false;
    self.dropBackContacts();
    self.watchTree();
    statistics.m_candidates += self.m_result.m_candidates;
    statistics.m_volumeTests = self.m_result.m_volumeTests;
    statistics.m_sweptTests = self.m_result.m_sweptTests;
    statistics.m_selfCandidates = self.m_result.m_selfCandidates;
    statistics.m_selfSweptTests = self.m_result.m_selfSweptTests;
    statistics.m_selfContacts = self.m_result.selfContacts().size();
    statistics.m_reduced = self.m_result.m_reduced;
    statistics.m_contacts = self.m_result.contacts().size();
    statistics.m_intersections = self.m_result.m_intersectionCount;
    statistics.m_invalidNodes = self.m_result.m_invalidNodes;
    statistics.m_retries = self.m_result.m_retries;
    statistics.m_refitMs = self.m_result.m_refitMs;
    statistics.m_broadMs = self.m_result.m_broadMs;
    statistics.m_narrowMs = self.m_result.m_narrowMs;
    if (statistics.m_invalidNodes > 0) statistics.m_status |= kStepInvalidNodes;
    statistics.m_waitMs = millisecondsSince(start);
    return self.m_result.contacts();
}

void Pipeline::waitForRebuild()
{
    assert(!m_implementation->m_submitted);
    m_implementation->m_treeWatch.wait();
}

ContactList Pipeline::selfContacts() const
{
    return m_implementation->m_result.selfContacts();
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
