#include "host_patches.h"

#include <algorithm>

#include "bullet_plugin/core/stopwatch.h"
#include "step_limits.h"

namespace drape
{
ClothView clothView(const Scene& scene, const Settings& settings)
{
    const MeshPool& cloths = scene.m_cloths;
    return clothView(scene.m_clothNodes.start(), scene.m_clothNodes.end(), cloths.triangles().data(),
                     cloths.edges().data(), std::uint32_t(cloths.vertexCount()),
                     std::uint32_t(cloths.triangles().size()), std::uint32_t(settings.m_mode), nullptr);
}

void HostPatches::update(const Scene& scene)
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

void HostPatches::updateObstacles(const Scene& scene, std::size_t fresh)
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

HostCloths HostPatches::clothsOf(const Scene& scene, const StepPairs& pairs, const Settings& settings,
                                 ItemRange triangles) const
{
    return {m_clothOrder.data() + triangles.m_first,
            std::uint32_t(triangles.count()),
            pairs.m_clothRadius.data(),
            pairs.m_thickness.data(),
            std::uint32_t(scene.m_obstacles.meshCount()),
            1.0f + settings.m_activation,
            pairs.m_motions.data(),
            std::uint32_t(pairs.m_motions.size())};
}

std::vector<std::uint64_t> HostPatches::countTests(const Scene& scene, const StepPairs& pairs, const SelfStep& step,
                                                   const Settings& settings, ThreadTeam& threads)
{
    update(scene);
    const MeshPool& cloths = scene.m_cloths;
    const std::size_t limit = StepLimits(settings).m_candidates;
    std::vector<std::uint64_t> counts(cloths.meshCount(), 0);
    if (pairs.m_anySelf) counts = m_self.countTests(step, limit, threads);
    for (std::size_t slot = 0; slot < counts.size(); ++slot)
    {
        if (pairs.m_clothRadius[slot] < 0.0f) continue;
        const ItemRange triangles = {cloths.begin(slot).m_triangle, cloths.begin(slot + 1).m_triangle};
        counts[slot] +=
            m_cull.count(clothView(scene, settings), clothsOf(scene, pairs, settings, triangles), limit, threads);
    }
    return counts;
}

void HostPatches::run(const Scene& scene, const StepPairs& pairs, const Settings& settings, ThreadTeam& threads,
                      StepCounters& counters, StepResult& result, StepStatistics& statistics)
{
    Stopwatch watch;
    update(scene);
    statistics.m_refitMs += watch.lapMs();
    const StepLimits limits(settings);
    const std::size_t mostTests = std::min(limits.m_candidates, pairs.m_limits.m_tests);
    const HostCloths cloths = clothsOf(scene, pairs, settings, {0, m_clothOrder.size()});
    statistics.m_retries += m_cull.run(clothView(scene, settings), cloths, mostTests, threads, counters);
    statistics.m_broadMs += watch.lapMs();
    result.m_overLimit = counters.m_candidates > mostTests;
    result.m_overTests = result.m_overLimit && mostTests < limits.m_candidates;
    if (result.m_overLimit) return;

    const CpuKernels& kernels = m_cull.kernels();
    const HostFeatures features = {m_cull.tests().data(), counters.m_candidates, clothView(scene, settings),
                                   m_placed.view(scene),  m_cull.packed(),       pairs.m_motions.data()};
    statistics.m_retries +=
        m_hits.find(kernels.m_findHits, kernels.m_findSwept, &StepCounters::m_swept, features, scene.slotCount(),
                    {limits.m_contacts, pairs.m_limits.m_swept}, threads, counters);
    result.m_overLimit = result.m_overTests = counters.m_swept > pairs.m_limits.m_swept;
    if (result.m_overLimit) return;
    result.m_overLimit = counters.m_contactsFound > limits.m_contacts;
    if (result.m_overLimit)
        result.m_contactDemand = counters.m_contactsFound;
    else
        m_hits.order(counters.m_contactsFound, result.m_contacts, threads);
    statistics.m_narrowMs += watch.lapMs();
}

SelfCounts HostPatches::runSelf(const Scene& scene, const SelfStep& step, SelfStepLimits limits, ThreadTeam& threads,
                                StepResult& result, StepStatistics& statistics)
{
    Stopwatch watch;
    m_self.update(scene.m_cloths, scene.m_clothRest.data());
    m_self.cull(step, limits.m_candidates, threads);
    statistics.m_broadMs += watch.lapMs();
    m_self.findContacts(step, limits, threads, result.m_contacts);
    statistics.m_narrowMs += watch.lapMs();
    return m_self.counts();
}
}  // namespace drape
