#include "host_backend.h"

#include <algorithm>

#include "bullet_plugin/core/stopwatch.h"
#include "write_counts.h"

namespace drape
{
void HostBackend::prepare(const Scene& scene)
{
    const MeshPool &cloths = scene.m_cloths, &obstacles = scene.m_obstacles;
    if (m_clothRevision != cloths.revision())
    {
        clusterMeshes(cloths, cloths.firstSince(m_clothRevision), DRAPE_PATCH_WIDTH, m_clothOrder);
        m_clothRevision = cloths.revision();
    }
    std::size_t fresh = obstacles.meshCount();
    const bool newObstacles = m_obstacleRevision != obstacles.revision();
    if (newObstacles)
    {
        fresh = obstacles.firstSince(m_obstacleRevision);
        m_cull.setTopology(obstacles, fresh);
        m_obstacleRevision = obstacles.revision();
    }
    if (newObstacles || m_placed.changed(scene)) updateObstacles(scene, fresh);
    if (scene.m_anySelf) m_self.update(cloths, scene.m_clothRest.data());
}

void HostBackend::updateObstacles(const Scene& scene, std::size_t fresh)
{
    m_placed.update(scene, fresh);
    const ObstacleView obstacle = m_placed.view(scene);
    m_cull.pack({fresh, scene.m_obstacles.meshCount()}, obstacle);
    for (std::size_t slot = 0; slot < fresh; ++slot)
    {
        std::size_t last = slot;
        while (last < fresh && m_placed.moved(last))
            ++last;
        if (last == slot) continue;
        m_cull.pack({slot, last}, obstacle);
        slot = last;
    }
}

ClothView HostBackend::clothView(const Scene& scene) const
{
    const MeshPool& cloths = scene.m_cloths;
    return drape::clothView(scene.m_clothNodes.start(), scene.m_clothNodes.end(), cloths.triangles().data(),
                            cloths.edges().data(), std::uint32_t(cloths.vertexCount()),
                            std::uint32_t(cloths.triangles().size()), m_mode, nullptr);
}

StepCloths HostBackend::clothsOf(const Scene& scene, const StepPairs& pairs, ItemRange triangles) const
{
    return {clothView(scene),
            m_clothOrder.data() + triangles.m_first,
            std::uint32_t(triangles.count()),
            pairs.m_clothRadius.data(),
            pairs.m_thickness.data(),
            std::uint32_t(scene.m_obstacles.meshCount()),
            m_reachScale,
            pairs.m_motions.data(),
            std::uint32_t(pairs.m_motions.size())};
}

SelfStep HostBackend::selfStep(const Scene& scene, const StepPairs& pairs) const
{
    const SelfView view = selfView(clothView(scene), scene.m_clothRest.data(), m_reachScale);
    return {scene.m_cloths, view, pairs.m_self, pairs.m_clothRadius};
}

std::vector<std::uint64_t> HostBackend::countTests(const Scene& scene, const StepPairs& pairs)
{
    prepare(scene);
    const MeshPool& cloths = scene.m_cloths;
    const std::size_t limit = m_limits.m_candidates;
    std::vector<std::uint64_t> counts(cloths.meshCount(), 0);
    if (pairs.m_anySelf) counts = m_self.countTests(selfStep(scene, pairs), limit, *m_threads);
    for (std::size_t slot = 0; slot < counts.size(); ++slot)
    {
        if (!pairs.hasPair(slot)) continue;
        const ItemRange triangles = {cloths.begin(slot).m_triangle, cloths.begin(slot + 1).m_triangle};
        counts[slot] += m_cull.count(clothsOf(scene, pairs, triangles), limit, *m_threads);
    }
    return counts;
}

void HostBackend::runPairs(const Scene& scene, const StepPairs& pairs, StepCounters& counters, StepResult& result,
                           StepStatistics& statistics)
{
    Stopwatch watch;
    prepare(scene);
    statistics.m_refitMs += watch.lapMs();
    const std::size_t mostTests = std::min(m_limits.m_candidates, pairs.m_limits.m_tests);
    const StepCloths cloths = clothsOf(scene, pairs, {0, m_clothOrder.size()});
    statistics.m_retries += m_cull.run(cloths, mostTests, *m_threads, counters);
    statistics.m_broadMs += watch.lapMs();
    result.m_overLimit = counters.m_candidates > mostTests;
    result.m_overTests = result.m_overLimit && mostTests < m_limits.m_candidates;
    if (result.m_overLimit) return;

    const CpuKernels& kernels = m_cull.kernels();
    const FeatureInput input = {m_cull.tests().data(), counters.m_candidates, cloths.m_cloth,
                                m_placed.view(scene),  m_cull.packed(),       pairs.m_motions.data()};
    statistics.m_retries +=
        m_contacts.find(kernels.m_findContacts, kernels.m_findSwept, &StepCounters::m_swept, input,
                        scene.featureCount(), {m_limits.m_contacts, pairs.m_limits.m_swept}, *m_threads, counters);
    result.m_overLimit = result.m_overTests = counters.m_swept > pairs.m_limits.m_swept;
    if (result.m_overLimit) return;
    result.m_overLimit = counters.m_contactsFound > m_limits.m_contacts;
    if (result.m_overLimit)
        result.m_contactDemand = counters.m_contactsFound;
    else
        m_contacts.order(counters.m_contactsFound, result.m_contacts, *m_threads);
    statistics.m_narrowMs += watch.lapMs();
}

void HostBackend::runSelf(const Scene& scene, const StepPairs& pairs, StepCounters& counters, StepResult& result,
                          StepStatistics& statistics)
{
    Stopwatch watch;
    const std::size_t others = result.m_contacts.size();
    const SelfStepLimits left = {m_limits.m_candidates, m_limits.m_contacts - std::min(m_limits.m_contacts, others)};
    const SelfStep step = selfStep(scene, pairs);
    m_self.update(scene.m_cloths, scene.m_clothRest.data());
    m_self.cull(step, left.m_candidates, *m_threads);
    statistics.m_broadMs += watch.lapMs();
    m_self.findContacts(step, left, *m_threads, result.m_contacts);
    statistics.m_narrowMs += watch.lapMs();
    const SelfCounts counts = m_self.counts();
    statistics.m_retries += counts.m_retries;
    counters.m_selfTests = std::uint32_t(counts.m_candidates);
    counters.m_selfSwept = std::uint32_t(counts.m_swept);
    counters.m_invalidNodes += std::uint32_t(counts.m_invalidNodes);
    const bool tooMany = counts.m_contacts > left.m_contacts;
    result.m_overLimit = counts.m_candidates > left.m_candidates || tooMany;
    if (counts.m_candidates <= left.m_candidates && tooMany) result.m_contactDemand = others + counts.m_contacts;
}

void HostBackend::run(const Scene& scene, const StepPairs& pairs, StepResult& result, StepStatistics& statistics)
{
    result.clear();
    StepCounters counters = {};
    if (pairs.m_anyPair) runPairs(scene, pairs, counters, result, statistics);
    if (pairs.m_anySelf && !result.m_overLimit) runSelf(scene, pairs, counters, result, statistics);
    if (!result.m_overLimit) writeCounts(counters, statistics);
}

void HostBackend::giveBackRoom()
{
    m_cull.giveBackRoom();
    m_placed.giveBackRoom();
    shrinkSparse(m_clothOrder);
    m_contacts.giveBackRoom();
    m_self.giveBackRoom();
}
}  // namespace drape
