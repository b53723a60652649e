#include "device_backend.h"

#include <algorithm>
#include <cstring>

namespace drape
{
namespace
{
// First guesses; they grow to what scenes need.
constexpr std::size_t kFirstCandidates = 1 << 16;
constexpr std::size_t kFirstContacts = 1 << 13;
constexpr std::size_t kPlaceGroup = 64;
// Triangles of obstacles between two that changed which are brought up to date with them: no more than what the
// launches of a run cost, 0.1 ms, of which a triangle takes 0.2 us on two cores.
constexpr std::size_t kTrianglesBetweenCpu = 1 << 8;
constexpr std::size_t kTrianglesBetweenGpu = 1 << 14;
// For so many steps after one in which slots had many hits they are put in order; without it such a step runs twice.
constexpr int kStepsToOrder = 64;

// What a CPU has as one program: the files of every step over patches, or over trees but for the traversal's own, and
// what cloths need beside them that collide with themselves.
std::vector<ProgramSet::Names> filesTogether(bool patches, bool reduces)
{
    ProgramSet::Names step = {"compaction", "place_obstacles"};
    if (patches)
        step.insert(step.end(), {"patch_cull", "patch_pack", "narrow_phase", "narrow_phase_lanes"});
    else
        step.insert(step.end(), {"refit", "narrow_phase_pairs"});
    if (reduces) step.push_back("contact_reduction");
    return {step, {"self_cull", "self_pack", "self_contact", "self_contact_lanes"}};
}

std::size_t withHeadroom(std::size_t count)
{
    return count + count / 4 + 1024;
}
}  // namespace

DeviceBackend::DeviceBackend(std::unique_ptr<Device> device, const Settings& settings)
    : m_device(std::move(device)),
      m_settings(settings),
      m_programs(
          *m_device, settings.m_cacheFolder, filesTogether(patches(), settings.m_reduceContacts),
          PatchCullStage::defines(*m_device) + (settings.m_methods.m_countTests ? "#define DRAPE_COUNT_VISITS\n" : ""))
{
    const ProgramLoader load = m_programs.loader();
    if (patches())
    {
        m_patchCull.create(*m_device, load);
    }
    else
    {
        m_refit.create(*m_device, load("refit"));
        m_broadPhase.create(*m_device, m_settings.m_methods.m_traversal, load);
        if (watchesClothTree(m_settings, false)) m_treeCost.create(*m_device, load);
    }
    m_narrowPhase.create(*m_device, load, patches(), m_settings.m_reduceContacts);
    m_place.create(*m_device, load("place_obstacles"), "placeObstacles");
    m_motions.reserve(*m_device, 1);
    m_candidates.reserve(*m_device, 1);
    m_patchCull.reserveTests(*m_device, kFirstCandidates);
    m_narrowPhase.reserveHits(*m_device, kFirstContacts);
    m_narrowPhase.reserveIntersections(*m_device, 1);
    for (Buffer<StepCounters>& counters : m_counters)
    {
        counters.reserve(*m_device, 1);
        counters.fill(*m_device, 0, 1);
    }
    m_refitCounters.reserve(*m_device, 1);
    m_contactsRead.reserve(m_device.get(), DRAPE_CONTACT_HEAD + kFirstContacts);
    warmUp();
}

DeviceBackend::~DeviceBackend()
{
    // Transfers into host memory that is about to go must have ended.
    m_device->wait();
}

// A step of one triangle over another: some drivers compile a kernel again at its first launch with a group size.
void DeviceBackend::warmUp(float selfThickness)
{
    forgetScene();
    const std::int32_t indices[3] = {0, 1, 2};
    const std::vector<float> above = {0, 0, 0.5f, 1, 0, 0.5f, 0, 1, 0.5f}, below = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    Scene scene;
    for (MeshPool* pool : {&scene.m_cloths, &scene.m_obstacles})
    {
        PooledMesh mesh;
        mesh.m_id = 0;
        mesh.m_topology = buildTopology(indices, 1, 3);
        mesh.m_order = {0};
        mesh.m_positions = below;
        pool->add(std::move(mesh));
        pool->update();
    }
    scene.m_clothLayout = makeBvhLayout(1);
    scene.m_obstacleLayout = makeBvhLayout(1);
    scene.m_clothStart.reserve(nullptr, 9);
    scene.m_clothEnd.reserve(nullptr, 9);
    std::copy(above.begin(), above.end(), scene.m_clothStart.data());
    std::copy(below.begin(), below.end(), scene.m_clothEnd.data());
    scene.m_obstaclePositions = below;
    scene.m_vertexCones.assign(3, NormalCone{{0, 0, 1}, -1});
    scene.m_edgeCones.assign(3, NormalCone{{0, 0, 1}, -1});
    ObstaclePlacing placing;
    placing.m_posed = true;
    placing.m_start = placing.m_end = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    scene.m_places = {ObstaclePlace{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, 1, 0, 0}};
    scene.m_anyPosed = true;
    StepPairs pairs;
    pairs.m_motions = {makeMotion(placing, MeshBox{{0, 0, 0}, {1, 1, 0}}, 0)};
    pairs.m_thickness = {0.1f};
    pairs.m_clothRadius = {0.1f};
    pairs.m_anyPair = pairs.m_any = true;
    if (selfThickness > 0.0f)
    {
        scene.m_anySelf = pairs.m_anySelf = true;
        scene.m_clothRest = below;
        pairs.m_self = SelfReach{{selfThickness}, {selfGrowth(selfThickness)}};
    }
    pairs.m_measureTree = watchesClothTree(m_settings, false);
    StepResult result;
    submit(scene, pairs);
    finish(scene, pairs, result);
    if (m_settings.m_reduceContacts)
    {
        pairs.m_tube = {0.1f};
        pairs.m_anyTube = true;
        submit(scene, pairs);
        finish(scene, pairs, result);
    }
    if (!patches()) m_refit.warmUp(*m_device, m_cloth.m_nodes);
    m_device->wait();
    forgetScene();
    m_sentThickness.clear();
    m_sentTube.clear();
    m_sentRadius.clear();
    m_testsBefore = m_hitsBefore = SIZE_MAX;
}

void DeviceBackend::forgetScene()
{
    m_cloth.m_revision = m_obstacle.m_revision = 0;
    m_changes.forget();
    m_anyPosed = false;
}

void DeviceBackend::prepareSelf()
{
    if (m_self.created() || m_device->failed()) return;
    m_self.create(*m_device, m_programs.loader());
    warmUp(0.1f);
}

std::size_t DeviceBackend::firstNew(const MeshPool& pool, const Side& side) const
{
    return patches() ? pool.firstSince(side.m_revision) : 0;
}

void DeviceBackend::uploadSide(const MeshPool& pool, const BvhLayout& layout, Side& side)
{
    const std::size_t first = firstNew(pool, side);
    side.m_revision = pool.revision();
    side.m_triangles.append(*m_device, pool.triangles(), pool.begin(first).m_triangle);
    if (m_settings.m_reduceContacts) side.m_firsts.assign(*m_device, pool.firsts());
    // The cull over patches needs no hierarchy of triangles.
    std::vector<BvhNode> nodes;
    if (!patches())
    {
        side.m_order.assign(*m_device, pool.order());
        side.m_layout = layoutByHeights(layout);
        nodes = makeBvhNodes(side.m_layout);
        side.m_nodes.assign(*m_device, nodes);
        m_refit.makeLevels(*m_device, side.m_layout, side.m_levels);
    }
    if (!nodes.empty()) m_device->wait();  // they are a local
}

// The cull over patches needs an order of the cloths alone: that of their own patches, since it walks for packets.
void DeviceBackend::clusterCloths(const MeshPool& cloths, std::size_t firstSlot)
{
    m_clustered.resize(cloths.begin(firstSlot).m_triangle);
    for (std::size_t slot = firstSlot; slot < cloths.meshCount(); ++slot)
    {
        const PooledMesh& mesh = cloths.mesh(slot);
        for (std::uint32_t own : clusteredOrder(mesh, mesh.m_positions.data(), PatchCullStage::width(*m_device)))
            m_clustered.push_back(own + mesh.m_firstTriangle);
    }
    m_cloth.m_order.append(*m_device, m_clustered, cloths.begin(firstSlot).m_triangle);
}

void DeviceBackend::updateCloths(const Scene& scene)
{
    const std::size_t first = firstNew(scene.m_cloths, m_cloth);
    if (patches()) clusterCloths(scene.m_cloths, first);
    m_clothEdges.append(*m_device, scene.m_cloths.edges(), scene.m_cloths.begin(first).m_edge);
    uploadSide(scene.m_cloths, scene.m_clothLayout, m_cloth);
    m_clothStart.reserve(*m_device, scene.m_clothStart.capacity());
    m_clothEnd.reserve(*m_device, scene.m_clothEnd.capacity());
    m_narrowPhase.resizeSlots(*m_device, scene.allSlotCount());
    if (scene.m_anySelf) m_self.setTopology(*m_device, scene.m_cloths, scene.m_clothRest);
}

void DeviceBackend::updateTopology(const Scene& scene)
{
    const bool newCloths = m_cloth.m_revision != scene.m_cloths.revision();
    const bool newObstacles = m_obstacle.m_revision != scene.m_obstacles.revision();
    const std::size_t fresh = newObstacles ? firstNew(scene.m_obstacles, m_obstacle) : scene.m_obstacles.meshCount();
    if (newCloths) updateCloths(scene);
    if (newObstacles)
    {
        uploadSide(scene.m_obstacles, scene.m_obstacleLayout, m_obstacle);
        if (patches()) m_patchCull.setTopology(*m_device, scene.m_obstacles, fresh);
    }
    if (!patches() && (newCloths || newObstacles)) updateTraversal(scene, newObstacles);
    if (newObstacles || m_changes.any(scene)) updateObstacles(scene, fresh);
    // What only packing reads goes when obstacles that rest are packed; those whose positions are given anew later keep
    // it from then on.
    if (newObstacles && !scene.m_anyPosed) m_patchCull.releasePacking();
}

void DeviceBackend::updateTraversal(const Scene& scene, bool newObstacles)
{
    const std::vector<BvhNode> clothNodes = makeBvhNodes(m_cloth.m_layout);
    const std::vector<BvhNode> obstacleNodes = makeBvhNodes(m_obstacle.m_layout);
    const Hierarchy cloth = {clothNodes, m_cloth.m_layout.root(), scene.m_cloths.order()};
    const Hierarchy obstacle = {obstacleNodes, m_obstacle.m_layout.root(), scene.m_obstacles.order()};
    if (newObstacles) m_broadPhase.setObstacles(*m_device, obstacle);
    m_broadPhase.setTopology(*m_device, cloth, obstacle);
}

// Runs of the obstacles that changed. Some that did not go along where they are between two that did, as many as cost
// less than launches of their own.
template <typename Changed>
std::vector<PatchCullStage::Slots> DeviceBackend::runsOf(const MeshPool& obstacles, const Changed& changed) const
{
    const std::size_t between = m_device->isGpu() ? kTrianglesBetweenGpu : kTrianglesBetweenCpu;
    std::vector<PatchCullStage::Slots> runs;
    for (std::size_t slot = 0; slot < obstacles.meshCount(); ++slot)
    {
        if (!changed(slot)) continue;
        const bool near = !runs.empty() &&
                          obstacles.begin(slot).m_triangle - obstacles.begin(runs.back().m_last).m_triangle <= between;
        if (near)
            runs.back().m_last = slot + 1;
        else
            runs.push_back({slot, slot + 1});
    }
    return runs;
}

void DeviceBackend::uploadObstacles(const Scene& scene, PatchCullStage::Slots slots)
{
    const bool own = scene.m_anyPosed;
    const MeshFirsts first = scene.m_obstacles.begin(slots.m_first), last = scene.m_obstacles.begin(slots.m_last);
    (own ? m_ownPositions : m_obstaclePositions)
        .write(*m_device, scene.m_obstaclePositions.data() + 3 * std::size_t(first.m_vertex),
               3 * std::size_t(last.m_vertex - first.m_vertex), 3 * std::size_t(first.m_vertex));
    (own ? m_ownVertexCones : m_vertexCones)
        .write(*m_device, scene.m_vertexCones.data() + first.m_vertex, last.m_vertex - first.m_vertex, first.m_vertex);
    (own ? m_ownEdgeCones : m_edgeCones)
        .write(*m_device, scene.m_edgeCones.data() + first.m_edge, last.m_edge - first.m_edge, first.m_edge);
}

void DeviceBackend::enqueuePlacing(const Scene& scene, PatchCullStage::Slots slots)
{
    const MeshFirsts first = scene.m_obstacles.begin(slots.m_first), last = scene.m_obstacles.begin(slots.m_last);
    m_place.launch(*m_device, last.m_vertex - first.m_vertex + last.m_edge - first.m_edge, kPlaceGroup,
                   m_places.handle(), cl_uint(scene.m_places.size()), first.m_vertex, last.m_vertex - first.m_vertex,
                   first.m_edge, last.m_edge - first.m_edge, m_ownPositions.handle(), m_ownVertexCones.handle(),
                   m_ownEdgeCones.handle(), m_obstaclePositions.handle(), m_vertexCones.handle(), m_edgeCones.handle());
}

void DeviceBackend::reserveObstacles(const Scene& scene, std::size_t fresh)
{
    const MeshFirsts end = scene.m_obstacles.begin(scene.m_obstacles.meshCount());
    const MeshFirsts kept = scene.m_obstacles.begin(fresh);
    const bool begins = scene.m_anyPosed && !m_anyPosed;
    m_anyPosed = scene.m_anyPosed;
    const auto extend = [&](auto& world, auto& own, std::size_t count, std::size_t keptCount)
    {
        world.extend(*m_device, count, keptCount);
        if (!m_anyPosed)
            own.release();
        else if (begins)
            own.copy(*m_device, world, count, keptCount);  // the world was every obstacle's own frame
        else
            own.extend(*m_device, count, keptCount);
    };
    extend(m_obstaclePositions, m_ownPositions, 3 * std::size_t(end.m_vertex), 3 * std::size_t(kept.m_vertex));
    extend(m_vertexCones, m_ownVertexCones, end.m_vertex, kept.m_vertex);
    extend(m_edgeCones, m_ownEdgeCones, end.m_edge, kept.m_edge);
}

void DeviceBackend::updateObstacles(const Scene& scene, std::size_t fresh)
{
    const MeshPool& obstacles = scene.m_obstacles;
    m_changes.take(scene, fresh);  // the device has been waited for since places were written last
    reserveObstacles(scene, fresh);
    for (const PatchCullStage::Slots& run : runsOf(obstacles, [&](std::size_t slot) { return m_changes.given(slot); }))
        uploadObstacles(scene, run);
    const std::vector<PatchCullStage::Slots> runs =
        runsOf(obstacles, [&](std::size_t slot) { return m_changes.moved(slot); });
    if (scene.m_anyPosed && !runs.empty())
    {
        m_places.assign(*m_device, m_changes.places());
        for (const PatchCullStage::Slots& run : runs)
            enqueuePlacing(scene, run);
    }
    if (!patches())
    {
        refitObstacles(scene);
        return;
    }
    const std::size_t count = obstacles.meshCount();
    m_patchCull.pack(*m_device, {fresh, count}, m_obstacle.m_triangles, m_obstaclePositions, m_vertexCones,
                     m_edgeCones);
    for (const PatchCullStage::Slots& run : runs)
        m_patchCull.pack(*m_device, {run.m_first, std::min(run.m_last, fresh)}, m_obstacle.m_triangles,
                         m_obstaclePositions, m_vertexCones, m_edgeCones);
}

void DeviceBackend::refitObstacles(const Scene& scene)
{
    const std::vector<float> noRadius(scene.m_obstacles.meshCount(), 0.0f);
    m_obstacle.m_radius.assign(*m_device, noRadius);
    m_refit.enqueue(*m_device, m_obstacle.m_layout, m_obstacle.m_levels, m_obstacle.m_nodes, m_obstacle.m_order,
                    m_obstacle.m_triangles, m_obstaclePositions, m_obstaclePositions, m_obstacle.m_radius,
                    m_refitCounters);
    m_broadPhase.obstaclesRefitted(*m_device, m_obstacle.m_nodes);
    m_device->wait();  // noRadius is a local
}

void DeviceBackend::writeNodes(const Scene& scene, std::size_t first, std::size_t count)
{
    m_clothStart.write(*m_device, scene.m_clothStart.data() + 3 * first, 3 * count, 3 * first);
    m_clothEnd.write(*m_device, scene.m_clothEnd.data() + 3 * first, 3 * count, 3 * first);
}

bool DeviceBackend::sendNodes(const Scene& scene, std::size_t first, std::size_t count)
{
    if (m_device->failed() || m_cloth.m_revision != scene.m_cloths.revision()) return false;
    writeNodes(scene, first, count);
    m_device->flush();
    return true;
}

void DeviceBackend::uploadStep(const Scene& scene, const StepPairs& pairs, std::size_t sent)
{
    writeNodes(scene, sent, scene.m_cloths.vertexCount() - sent);
    if (m_sentThickness != pairs.m_thickness)
    {
        m_sentThickness = pairs.m_thickness;
        m_thickness.assign(*m_device, m_sentThickness);
    }
    if (pairs.m_anyTube && m_sentTube != pairs.m_tube)
    {
        m_sentTube = pairs.m_tube;
        m_tube.assign(*m_device, m_sentTube);
    }
    if (pairs.m_anySelf) m_self.setReach(*m_device, pairs.m_self);
    if (!pairs.m_motions.empty())
    {
        m_sentMotions = pairs.m_motions;
        m_motions.assign(*m_device, m_sentMotions);
    }
    if (m_sentRadius != pairs.m_clothRadius)
    {
        m_sentRadius = pairs.m_clothRadius;
        m_cloth.m_radius.assign(*m_device, m_sentRadius);
    }
}

NarrowPhaseBuffers DeviceBackend::narrowPhaseBuffers(const StepPairs& pairs)
{
    return {m_clothStart,           m_clothEnd,    m_cloth.m_triangles, m_clothEdges, m_obstaclePositions,
            m_obstacle.m_triangles, m_vertexCones, m_edgeCones,         m_thickness,  m_motions,
            pairs.m_motions.size()};
}

SelfWork DeviceBackend::selfWork(const Scene& scene)
{
    const MeshPool& cloths = scene.m_cloths;
    return {m_self,
            {m_cloth.m_triangles, m_clothEdges, m_clothStart, m_clothEnd, m_cloth.m_radius, cloths.vertexCount(),
             cloths.triangles().size(), cloths.edges().size(), std::uint32_t(m_settings.m_mode),
             1.0f + m_settings.m_activation, StepLimits(m_settings).m_candidates}};
}

// Pairs of features, or of triangles, that may touch.
void DeviceBackend::enqueueBroad(const Scene& scene, const StepPairs& pairs)
{
    const std::size_t obstacleMeshes = scene.m_obstacles.meshCount();
    if (pairs.m_anySelf) m_self.enqueueCull(*m_device, selfWork(scene).m_step, counters());
    if (!pairs.m_anyPair) return;
    if (patches())
    {
        m_patchCull.enqueue(
            *m_device,
            {m_cloth.m_order, m_cloth.m_triangles, m_clothStart, m_clothEnd, m_cloth.m_radius, m_thickness,
             scene.m_cloths.triangles().size(), obstacleMeshes, 1.0f + m_settings.m_activation,
             std::uint32_t(m_settings.m_mode), m_motions, pairs.m_motions.size(), StepLimits(m_settings).m_candidates},
            counters());
        return;
    }
    RefitStage::Motions motions = {m_motions, pairs.m_motions.size(), m_thickness, obstacleMeshes};
    m_refit.enqueue(*m_device, m_cloth.m_layout, m_cloth.m_levels, m_cloth.m_nodes, m_cloth.m_order,
                    m_cloth.m_triangles, m_clothStart, m_clothEnd, m_cloth.m_radius, counters(),
                    pairs.m_motions.empty() ? nullptr : &motions);
    if (pairs.m_measureTree)
        m_treeCost.enqueue(*m_device, m_cloth.m_nodes, m_cloth.m_layout.nodeCount(), m_cloth.m_layout.root());
    m_broadPhase.enqueue(*m_device, {{m_cloth.m_nodes, m_cloth.m_order, m_cloth.m_triangles},
                                     {m_obstacle.m_nodes, m_obstacle.m_order, m_obstacle.m_triangles},
                                     m_thickness,
                                     obstacleMeshes,
                                     m_candidates,
                                     counters(),
                                     StepLimits(m_settings).m_candidates});
}

void DeviceBackend::enqueueNarrow(const Scene& scene, const StepPairs& pairs)
{
    const std::size_t obstacleMeshes = scene.m_obstacles.meshCount();
    const ReductionBuffers buffers = {m_cloth.m_firsts, m_obstacle.m_firsts, scene.m_cloths.meshCount(), obstacleMeshes,
                                      m_tube};
    const ReductionBuffers* const reduction = pairs.m_anyTube ? &buffers : nullptr;
    const SelfWork own = selfWork(scene);
    const SelfWork* const self = pairs.m_anySelf ? &own : nullptr;
    const std::size_t nodes = scene.m_cloths.vertexCount(), triangles = scene.m_cloths.triangles().size();
    const std::uint32_t mode = std::uint32_t(m_settings.m_mode);
    if (pairs.m_anyPair && m_settings.m_reportIntersections)
        m_narrowPhase.enqueueIntersect(*m_device, narrowPhaseBuffers(pairs), m_candidates, counters());
    if (!pairs.m_anyPair)
    {
        m_narrowPhase.enqueueSelf(*m_device, narrowPhaseBuffers(pairs), tally(), own);
        return;
    }
    if (patches())
    {
        m_narrowPhase.enqueueFeatures(*m_device, narrowPhaseBuffers(pairs), nodes, triangles, mode, m_patchCull,
                                      tally(), reduction, self);
    }
    else
    {
        const NarrowPhaseSettings narrow = {
            pairs.m_thickness, obstacleMeshes, 1.0f + m_settings.m_activation, mode, {}};
        m_narrowPhase.enqueue(*m_device, narrowPhaseBuffers(pairs), nodes, triangles, narrow, m_candidates, tally(),
                              reduction, self);
    }
}

void DeviceBackend::enqueueStep(const Scene& scene, const StepPairs& pairs)
{
    m_turn = 1 - m_turn;
    enqueueBroad(scene, pairs);
    enqueueNarrow(scene, pairs);
    readContacts(m_contactsAsked);
    m_device->flush();
}

void DeviceBackend::prepare(const Scene& scene)
{
    updateTopology(scene);
    m_device->wait();
}

void DeviceBackend::submit(const Scene& scene, const StepPairs& pairs, std::size_t sent)
{
    m_limitReached = false;
    updateTopology(scene);
    uploadStep(scene, pairs, sent);
    enqueueStep(scene, pairs);
}

void DeviceBackend::readContacts(std::size_t count)
{
    m_narrowPhase.contacts().read(*m_device, m_contactsRead.data(), DRAPE_CONTACT_HEAD + count);
}

StepCounters DeviceBackend::countersRead() const
{
    StepCounters counters;
    static_assert(sizeof(counters) <= DRAPE_CONTACT_HEAD * sizeof(Contact));
    std::memcpy(&counters, m_contactsRead.data(), sizeof(counters));
    return counters;
}

// What the next launches are chosen by.
void DeviceBackend::takeCounts(const StepCounters& counters)
{
    m_testsBefore = counters.m_candidates;
    m_hitsBefore = counters.m_listed;
}

bool DeviceBackend::overLimit(StepResult& result)
{
    const StepCounters counters = countersRead();
    const StepLimits limits(m_settings);
    // Hits are all of them only where every candidate was there to be tested.
    const bool ofObstacles = patches() ? counters.m_patchPairs <= m_patchCull.pairs().capacity() &&
                                             counters.m_candidates <= m_patchCull.tests().capacity()
                                       : counters.m_candidates <= m_candidates.capacity();
    const bool ofSelf =
        counters.m_selfPairs <= m_self.pairs().capacity() && counters.m_selfTests <= m_self.tests().capacity();
    if (std::max({counters.m_candidates, counters.m_patchPairs, counters.m_selfPairs, counters.m_selfTests}) >
        limits.m_candidates)
    {
        result.m_overLimit = true;
    }
    else if (ofObstacles && ofSelf && counters.m_listed > limits.m_contacts)
    {
        result.m_overLimit = true;
        result.m_contactDemand = counters.m_listed;
    }
    return result.m_overLimit;
}

bool DeviceBackend::grow()
{
    const StepCounters counters = countersRead();
    const std::size_t largest = m_device->maxAllocationBytes();
    bool again = false;
    const auto demand = [&](std::size_t wanted, std::size_t capacity, std::size_t elementBytes, auto reserve)
    {
        if (wanted <= capacity) return;
        again = true;
        const std::size_t most = largest / elementBytes - DRAPE_CONTACT_HEAD;  // contacts have a head before them
        m_limitReached = m_limitReached || wanted > most;
        if (!m_limitReached) reserve(std::min(withHeadroom(wanted), most));
    };
    Device& device = *m_device;
    if (patches())
    {
        demand(counters.m_patchPairs, m_patchCull.pairs().capacity(), sizeof(FeatureTest),
               [&](std::size_t count) { m_patchCull.reservePairs(device, count); });
        demand(counters.m_candidates, m_patchCull.tests().capacity(), sizeof(FeatureTest),
               [&](std::size_t count) { m_patchCull.reserveTests(device, count); });
    }
    else
    {
        again = m_broadPhase.grow(device, counters, m_limitReached);
        demand(counters.m_candidates, m_candidates.capacity(), sizeof(Candidate),
               [&](std::size_t count) { m_candidates.reserve(device, count); });
    }
    demand(counters.m_selfPairs, m_self.pairs().capacity(), sizeof(Candidate),
           [&](std::size_t count) { m_self.reservePairs(device, count); });
    demand(counters.m_selfTests, m_self.tests().capacity(), sizeof(FeatureTest),
           [&](std::size_t count) { m_self.reserveTests(device, count); });
    demand(std::min(std::size_t(counters.m_listed), StepLimits(m_settings).m_contacts), m_narrowPhase.hitCapacity(),
           sizeof(Contact), [&](std::size_t count) { m_narrowPhase.reserveHits(device, count); });
    if (counters.m_crowded > 0)
    {
        again |= m_stepsToOrder == 0;
        m_stepsToOrder = kStepsToOrder;
    }
    else if (m_stepsToOrder > 0)
        --m_stepsToOrder;
    demand(counters.m_intersections, m_narrowPhase.intersections().capacity(), sizeof(Candidate),
           [&](std::size_t count) { m_narrowPhase.reserveIntersections(device, count); });
    return again;
}

bool DeviceBackend::finish(const Scene& scene, const StepPairs& pairs, StepResult& result)
{
    result = StepResult();
    m_device->wait();
    while (!m_device->failed())
    {
        if (overLimit(result)) return true;
        if (!grow()) break;
        if (m_limitReached) return false;
        ++result.m_retries;
        takeCounts(countersRead());
        enqueueStep(scene, pairs);
        m_device->wait();
    }
    if (m_device->failed()) return false;
    if (!patches()) m_broadPhase.accept(*m_device, countersRead());
    readAll(result);
    if (pairs.m_measureTree) result.m_treeCost = m_treeCost.cost();
    return !m_device->failed();
}

void DeviceBackend::readAll(StepResult& result)
{
    const StepCounters counters = countersRead();
    takeCounts(counters);
    result.m_candidates = counters.m_candidates;
    result.m_volumeTests = counters.m_visits;
    result.m_sweptTests = counters.m_swept;
    result.m_selfCandidates = counters.m_selfTests;
    result.m_selfSweptTests = counters.m_selfSwept;
    result.m_reduced = counters.m_listed - counters.m_hits;
    result.m_invalidNodes = counters.m_invalidNodes;
    result.m_intersectionCount = counters.m_intersections;
    if (m_settings.m_reportIntersections)
    {
        result.m_intersections.resize(counters.m_intersections);
        m_narrowPhase.intersections().read(*m_device, result.m_intersections.data(), counters.m_intersections);
    }
    const std::size_t count = counters.m_hits;
    const bool inHand = count <= m_contactsAsked;
    if (!inHand)
    {
        m_contactsRead.reserve(m_device.get(), DRAPE_CONTACT_HEAD + withHeadroom(count));
        readContacts(count);
    }
    if (!inHand || m_settings.m_reportIntersections) m_device->wait();
    result.m_deviceContacts = ContactList{m_contactsRead.data() + DRAPE_CONTACT_HEAD, count};
    m_contactsAsked = std::min(
        {count + count / 16 + 256, m_contactsRead.capacity() - DRAPE_CONTACT_HEAD, m_narrowPhase.hitCapacity()});
    sortCandidates(result.m_intersections);
}
}  // namespace drape
