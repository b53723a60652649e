#include "device_backend.h"

#include <algorithm>

#include "step_limits.h"
#include "warm_up_scene.h"

namespace drape
{
namespace
{
// First guesses; they grow to the scenes' needs.
constexpr std::size_t kFirstCandidates = 1 << 16;
constexpr std::size_t kFirstContacts = 1 << 13;

// Number of floats whose transfer takes less time than the start of a transfer.
constexpr std::size_t kFloatsBetween = 1 << 16;

// Returns the files that are one program on a CPU: those of every step, and those that cloths need beside them that
// collide with themselves.
std::vector<ProgramSet::Names> filesTogether()
{
    return {{"ordering/ordering", "scene/place_obstacles", "broad_phase/patch_cull", "scene/patch_pack",
             "narrow_phase/narrow_phase", "narrow_phase/narrow_phase_simd"},
            {"cloth_cloth/self_cull", "cloth_cloth/self_pack_simd", "cloth_cloth/self_contact",
             "cloth_cloth/self_contact_simd"}};
}
}  // namespace

DeviceBackend::DeviceBackend(std::unique_ptr<Device> device, const Settings& settings)
    : m_device(std::move(device)),
      m_settings(settings),
      m_programs(*m_device, settings.m_cacheFolder, filesTogether(), PatchCullStage::defines(*m_device))
{
    const ProgramLoader load = m_programs.loader();
    m_patchCull.create(*m_device, load);
    m_narrowPhase.create(*m_device, load);
    m_ordering.create(*m_device, load);
    m_placed.create(*m_device, load("scene/place_obstacles"));
    m_motions.reserve(*m_device, 1);
    reserveFirst();
    for (Buffer<StepCounters>& counters : m_counters)
    {
        counters.reserve(*m_device, 1);
        counters.fill(*m_device, 0, 1);
    }
    warmUp();
}

DeviceBackend::~DeviceBackend()
{
    // Waits for transfers into host memory that is about to be released.
    m_device->wait();
}

void DeviceBackend::reserveFirst()
{
    m_patchCull.reserveTests(*m_device, kFirstCandidates);
    m_ordering.reserveHits(*m_device, kFirstContacts);
    m_contactsRead = std::make_unique<Staging<Contact>>();
    m_contactsRead->reserve(m_device.get(), DRAPE_CONTACT_HEAD + kFirstContacts);
    m_contactsAsked = std::min(m_contactsAsked, kFirstContacts);
}

void DeviceBackend::giveBackRoom()
{
    m_device->wait();
    m_patchCull.giveBackRoom(*m_device);
    m_ordering.giveBackRoom();
    reserveFirst();
}

// A step of one triangle over another: some drivers compile a kernel again at its first launch with a group size.
void DeviceBackend::warmUp(float selfThickness)
{
    forgetScene();
    Scene scene;
    StepPairs pairs;
    makeWarmUpScene(scene, pairs, selfThickness);
    StepResult result;
    StepStatistics statistics;
    submit(scene, pairs);
    finish(scene, pairs, result, statistics);
    m_device->wait();
    forgetScene();
    m_sentThickness.clear();
    m_sentRadius.clear();
    m_testsBefore = m_hitsBefore = SIZE_MAX;
}

void DeviceBackend::forgetScene()
{
    m_cloth.m_revision = m_obstacle.m_revision = 0;
    m_placed.forget();
}

void DeviceBackend::prepareSelf()
{
    if (m_self.created() || m_device->failed()) return;
    m_self.create(*m_device, m_programs.loader());
    warmUp(0.1f);
}

void DeviceBackend::uploadSide(const MeshPool& pool, Side& side)
{
    const std::size_t first = pool.firstSince(side.m_revision);
    side.m_revision = pool.revision();
    side.m_triangles.append(*m_device, pool.triangles(), pool.begin(first).m_triangle);
}

// The cull over patches needs only the cloths' order: that of their own patches, since it traverses for packets.
void DeviceBackend::clusterCloths(const MeshPool& cloths, std::size_t firstSlot)
{
    clusterMeshes(cloths, firstSlot, PatchCullStage::width(*m_device), m_clustered);
    m_cloth.m_order.append(*m_device, m_clustered, cloths.begin(firstSlot).m_triangle);
}

void DeviceBackend::reserveNodes(std::size_t room)
{
    const bool grows = m_clothNodes.capacity() < 2 * room;
    if (!grows && m_clothEnd.capacity() == room) return;
    // Releases both sub-buffers, which would keep the old memory alive.
    m_clothStart.release();
    m_clothEnd.release();
    m_clothNodes.reserve(*m_device, 2 * room);
    m_clothStart.bePart(*m_device, m_clothNodes, 0, room);
    m_clothEnd.bePart(*m_device, m_clothNodes, room, room);
}

void DeviceBackend::updateCloths(const Scene& scene)
{
    const std::size_t first = scene.m_cloths.firstSince(m_cloth.m_revision);
    clusterCloths(scene.m_cloths, first);
    m_clothEdges.append(*m_device, scene.m_cloths.edges(), scene.m_cloths.begin(first).m_edge);
    uploadSide(scene.m_cloths, m_cloth);
    reserveNodes(scene.m_clothNodes.room());
    m_ordering.resizeSlots(*m_device, scene.allSlotCount());
    if (scene.m_anySelf) m_self.setTopology(*m_device, scene.m_cloths, scene.m_clothRest);
}

void DeviceBackend::updateTopology(const Scene& scene)
{
    const bool newCloths = m_cloth.m_revision != scene.m_cloths.revision();
    const bool newObstacles = m_obstacle.m_revision != scene.m_obstacles.revision();
    const std::size_t fresh =
        newObstacles ? scene.m_obstacles.firstSince(m_obstacle.m_revision) : scene.m_obstacles.meshCount();
    if (newCloths) updateCloths(scene);
    if (newObstacles)
    {
        uploadSide(scene.m_obstacles, m_obstacle);
        m_patchCull.setTopology(*m_device, scene.m_obstacles, fresh);
    }
    if (newObstacles || m_placed.changed(scene)) updateObstacles(scene, fresh);
    // Releases data that only packing reads, once resting obstacles are packed. Obstacles whose positions change
    // later keep it from then on.
    if (newObstacles && !scene.m_anyPosed) m_patchCull.releasePacking();
}

void DeviceBackend::updateObstacles(const Scene& scene, std::size_t fresh)
{
    const std::vector<SlotRange> runs = m_placed.update(*m_device, scene, fresh);
    const auto pack = [&](SlotRange slots)
    {
        m_patchCull.pack(*m_device, slots, m_obstacle.m_triangles, m_placed.positions(), m_placed.vertexCones(),
                         m_placed.edgeCones());
    };
    pack({fresh, scene.m_obstacles.meshCount()});
    for (const SlotRange& run : runs)
        pack({run.m_first, std::min(run.m_last, fresh)});
}

void DeviceBackend::writeNodes(const Scene& scene, std::size_t first, std::size_t count)
{
    const ClothNodes& nodes = scene.m_clothNodes;
    // Transfers start and end together if the gap between them takes less time than a second transfer.
    if (count == scene.m_cloths.vertexCount() && nodes.room() - 3 * count <= kFloatsBetween)
    {
        m_clothNodes.write(*m_device, nodes.start(), nodes.room() + 3 * count);
        return;
    }
    m_clothStart.write(*m_device, nodes.start() + 3 * first, 3 * count, 3 * first);
    m_clothEnd.write(*m_device, nodes.end() + 3 * first, 3 * count, 3 * first);
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
    return {m_clothStart,
            m_clothEnd,
            m_cloth.m_triangles,
            m_clothEdges,
            m_placed.positions(),
            m_obstacle.m_triangles,
            m_placed.vertexCones(),
            m_placed.edgeCones(),
            m_thickness,
            m_motions,
            pairs.m_motions.size()};
}

SelfBuffers DeviceBackend::selfBuffers(const Scene& scene)
{
    const MeshPool& cloths = scene.m_cloths;
    return {m_cloth.m_triangles,
            m_clothEdges,
            m_clothStart,
            m_clothEnd,
            m_cloth.m_radius,
            cloths.vertexCount(),
            cloths.triangles().size(),
            cloths.edges().size(),
            std::uint32_t(m_settings.m_mode),
            1.0f + m_settings.m_activation,
            StepLimits(m_settings).m_candidates};
}

// Finds pairs of features, or of triangles, that may touch.
void DeviceBackend::enqueueBroad(const Scene& scene, const StepPairs& pairs)
{
    if (pairs.m_anySelf) m_self.enqueueCull(*m_device, selfBuffers(scene), counters());
    if (!pairs.m_anyPair) return;
    const std::size_t limit = StepLimits(m_settings).m_candidates;
    m_patchCull.enqueue(*m_device,
                        {m_cloth.m_order, m_cloth.m_triangles, m_clothStart, m_clothEnd, m_cloth.m_radius, m_thickness,
                         scene.m_cloths.triangles().size(), scene.m_obstacles.meshCount(),
                         1.0f + m_settings.m_activation, std::uint32_t(m_settings.m_mode), m_motions,
                         pairs.m_motions.size(), std::min(limit, pairs.m_limits.m_tests), limit},
                        counters());
}

// Tests the candidates for contact.
void DeviceBackend::enqueueNarrow(const Scene& scene, const StepPairs& pairs)
{
    const HitBuffers hits = m_ordering.hits();
    if (pairs.m_anyPair)
        m_narrowPhase.enqueueFeatures(*m_device, narrowPhaseBuffers(pairs), scene.m_cloths.vertexCount(),
                                      scene.m_cloths.triangles().size(), std::uint32_t(m_settings.m_mode), m_patchCull,
                                      {m_testsBefore, pairs.m_limits.m_swept}, hits, counters());
    if (pairs.m_anySelf) m_self.enqueueContacts(*m_device, selfBuffers(scene), hits, counters());
}

// Puts the contacts into canonical order.
void DeviceBackend::enqueueOrdering()
{
    m_ordering.enqueue(*m_device, {counters(), m_counters[1 - m_turn], m_stepsToOrder > 0, m_hitsBefore});
}

void DeviceBackend::enqueueStep(const Scene& scene, const StepPairs& pairs)
{
    m_turn = 1 - m_turn;
    enqueueBroad(scene, pairs);
    enqueueNarrow(scene, pairs);
    enqueueOrdering();
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

}  // namespace drape
