#include "device_backend.h"

#include <algorithm>

#include "bullet_plugin/core/scene/patch_width.h"
#include "step_limits.h"
#include "warm_up_scene.h"

namespace drape
{
namespace
{
// First guesses; they grow to the scenes' needs.
constexpr std::size_t kFirstCandidates = 1 << 16;
constexpr std::size_t kFirstContacts = 1 << 13;

// Returns the files that are one program on a CPU: those of every step, and those that cloths need beside them that
// collide with themselves.
std::vector<ProgramSet::Names> filesTogether()
{
    return {{"ordering/ordering", "scene/place_obstacles", "broad_phase/patch_cull_simd", "scene/patch_pack",
             "narrow_phase/narrow_phase", "narrow_phase/narrow_phase_simd"},
            {"cloth_cloth/self_cull_simd", "cloth_cloth/self_pack_simd", "cloth_cloth/self_contact",
             "cloth_cloth/self_contact_simd"}};
}
// Returns whether cloths may be solved on the device.
bool solvesOn(const Device& device, const Settings& settings)
{
    if (settings.m_solver == Solver::Bullet || settings.m_solverPlace == SolverPlace::Host) return false;
    return device.isGpu() || settings.m_solverPlace == SolverPlace::Device;
}
}  // namespace

DeviceBackend::DeviceBackend(std::shared_ptr<Device> device, const Settings& settings)
    : m_device(std::move(device)),
      m_settings(settings),
      m_programs(
          std::make_shared<ProgramSet>(*m_device, settings.m_cacheFolder, filesTogether(), patchDefines(*m_device)))
{
    const ProgramLoader load = m_programs->loader();
    m_patchCull.create(*m_device, load);
    m_narrowPhase.create(*m_device, load);
    m_ordering.create(*m_device, load);
    m_obstacles.create(*m_device, load);
    if (solvesOn(*m_device, settings)) m_solve.create(*m_device, load);
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
    m_tests.reserve(*m_device, kFirstCandidates);
    reserveContacts(kFirstContacts);
    m_contactsRead = std::make_unique<Staging<Contact>>();
    m_contactsRead->reserve(m_device.get(), DRAPE_CONTACT_HEAD + kFirstContacts);
    m_contactsAsked = std::min(m_contactsAsked, kFirstContacts);
}

void DeviceBackend::reserveContacts(std::size_t count)
{
    m_unsorted.reserve(*m_device, count);
    m_ordering.reserve(*m_device, count);
}

void DeviceBackend::giveBackRoom()
{
    m_device->wait();
    m_tests.m_tests.release();
    m_patchCull.giveBackRoom(*m_device);
    m_unsorted.release();
    m_ordering.release();
    m_solve.giveBackRoom();
    reserveFirst();
}

// A step of one triangle over another: some drivers compile a kernel again at its first launch with a group size.
void DeviceBackend::warmUp(float selfThickness)
{
    forgetScene();
    Scene scene;
    // At the end, also by an exception: its transfers are over, and the next scene is another one.
    struct End
    {
        ~End()
        {
            m_backend.m_device->wait();
            m_backend.forgetScene();
        }
        DeviceBackend& m_backend;
    } end = {*this};
    StepPairs pairs;
    makeWarmUpScene(scene, pairs, selfThickness);
    StepResult result;
    StepStatistics statistics;
    submit(scene, pairs);
    finish(scene, pairs, result, statistics);
    m_testsBefore = m_contactsBefore = SIZE_MAX;
}

void DeviceBackend::forgetScene()
{
    m_cloths.forget();
    m_obstacles.forget();
}

void DeviceBackend::prepareSelf()
{
    if (m_self.created() || m_device->failed()) return;
    m_self.create(*m_device, m_programs->loader());
    warmUp(0.1f);
}

void DeviceBackend::updateTopology(const Scene& scene)
{
    if (!m_cloths.knows(scene))
    {
        m_cloths.update(*m_device, scene);
        m_unsorted.resizeFeatures(*m_device, scene.allFeatureCount());
        m_ordering.resizeFeatures(*m_device, scene.allFeatureCount());
        if (scene.m_anySelf) m_self.setTopology(*m_device, scene.m_cloths, scene.m_clothRest);
    }
    m_obstacles.update(*m_device, scene);
}

bool DeviceBackend::sendNodes(const Scene& scene, std::size_t first, std::size_t count)
{
    if (m_device->failed() || !m_cloths.knows(scene)) return false;
    m_cloths.writeNodes(*m_device, scene, first, count);
    m_device->flush();
    return true;
}

void DeviceBackend::uploadStep(const Scene& scene, const StepPairs& pairs, std::size_t sent)
{
    if (pairs.m_kept.size() < scene.m_cloths.presentMeshes())  // the device predicts those of kept cloths
        m_cloths.writeNodes(*m_device, scene, sent, scene.m_cloths.vertexCount() - sent);
    m_cloths.writePairs(*m_device, pairs);
    if (pairs.m_anySelf) m_self.setReach(*m_device, pairs.m_self);
    if (!pairs.m_kept.empty()) predictKept(scene, pairs);
}

void DeviceBackend::predictKept(const Scene& scene, const StepPairs& pairs)
{
    std::vector<KeptCloth> cloths;
    for (const KeptInput& kept : pairs.m_kept)
    {
        KeptCloth cloth = m_solve.kept().clothOf(kept.m_step);
        cloth.m_start = 3 * cl_uint(scene.m_cloths.existing(kept.m_cloth).m_firstVertex);
        cloth.m_end = cl_uint(scene.m_clothNodes.room()) + cloth.m_start;
        cloths.push_back(cloth);
    }
    m_solve.kept().predict(cloths, m_cloths.nodes());
}

SelfContactStage::Input DeviceBackend::selfInput(const Scene& scene, const StepPairs& pairs) const
{
    return {m_cloths.cloths(), m_cloths.pairs(scene, pairs).m_radius, std::uint32_t(m_settings.m_mode),
            1.0f + m_settings.m_activation, StepLimits(m_settings).m_candidates};
}

// Finds pairs of features that may touch.
void DeviceBackend::enqueueBroad(const Scene& scene, const StepPairs& pairs)
{
    if (pairs.m_anySelf) m_self.enqueueCull(*m_device, selfInput(scene, pairs), counters());
    if (!pairs.m_anyPair) return;
    const std::size_t limit = StepLimits(m_settings).m_candidates;
    m_patchCull.enqueue(*m_device, m_cloths.cloths(), m_cloths.pairs(scene, pairs), m_obstacles.patches(),
                        {1.0f + m_settings.m_activation, std::uint32_t(m_settings.m_mode),
                         std::min(limit, pairs.m_limits.m_tests), limit},
                        m_tests, counters());
}

// Tests the candidates for contact.
void DeviceBackend::enqueueNarrow(const Scene& scene, const StepPairs& pairs)
{
    if (pairs.m_anyPair)
        m_narrowPhase.enqueue(*m_device,
                              {m_cloths.cloths(), m_obstacles.obstacles(), m_obstacles.patches(),
                               m_cloths.pairs(scene, pairs).m_motions, std::uint32_t(m_settings.m_mode)},
                              m_tests, {m_testsBefore, pairs.m_limits.m_swept}, m_unsorted, counters());
    if (pairs.m_anySelf) m_self.enqueueContacts(*m_device, selfInput(scene, pairs), m_unsorted, counters());
}

// Puts the contacts into canonical order.
void DeviceBackend::enqueueOrdering()
{
    m_ordering.enqueue(*m_device, m_unsorted,
                       {counters(), m_counters[1 - m_turn], m_stepsToOrder > 0, m_contactsBefore});
}

void DeviceBackend::enqueueStep(const Scene& scene, const StepPairs& pairs)
{
    m_turn = 1 - m_turn;
    enqueueBroad(scene, pairs);
    enqueueNarrow(scene, pairs);
    enqueueOrdering();
    readContacts(m_place == ContactPlace::Host ? m_contactsAsked : 0);
    m_device->flush();
}

void DeviceBackend::prepare(const Scene& scene)
{
    updateTopology(scene);
    m_device->wait();
}

void DeviceBackend::submit(const Scene& scene, const StepPairs& pairs, ContactPlace place, std::size_t sent)
{
    m_limitReached = false;
    m_place = place;
    updateTopology(scene);
    uploadStep(scene, pairs, sent);
    enqueueStep(scene, pairs);
}

DeviceContacts DeviceBackend::contactsOnDevice()
{
    if (m_place == ContactPlace::Host || m_device->failed()) return DeviceContacts();
    const std::size_t room = m_unsorted.capacity();
    return {&m_ordering.contacts(), room, std::min(room, m_contactsBefore)};
}
}  // namespace drape
