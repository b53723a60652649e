#include "host_patches.h"

#include <algorithm>

#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
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

StepCloths HostPatches::clothsOf(const Scene& scene, const StepPairs& pairs, const Settings& settings,
                                 ItemRange triangles) const
{
    return {clothView(scene, settings),
            m_clothOrder.data() + triangles.m_first,
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
        counts[slot] += m_cull.count(clothsOf(scene, pairs, settings, triangles), limit, threads);
    }
    return counts;
}

bool HostPatches::run(const Scene& scene, const StepPairs& pairs, const Settings& settings, ThreadTeam& threads,
                      StepResult& result)
{
    Stopwatch watch;
    update(scene);
    result.m_refitMs = watch.lapMs();
    const StepLimits limits(settings);
    const std::size_t mostTests = std::min(limits.m_candidates, pairs.m_limits.m_tests);
    StepCounters counters = {};
    const StepCloths cloths = clothsOf(scene, pairs, settings, {0, m_clothOrder.size()});
    result.m_retries = m_cull.run(cloths, mostTests, threads, counters);
    result.m_invalidNodes = counters.m_invalidNodes;
    result.m_broadMs = watch.lapMs();
    result.m_overLimit = counters.m_candidates > mostTests;
    result.m_overTests = result.m_overLimit && mostTests < limits.m_candidates;
    if (result.m_overLimit) return false;
    result.m_candidates = counters.m_candidates;

    const CpuKernels& kernels = m_cull.kernels();
    const FeatureInput input = {m_cull.tests().data(), counters.m_candidates, cloths.m_cloth,
                                m_placed.view(scene),  m_cull.packed(),       pairs.m_motions.data()};
    result.m_retries +=
        m_contacts.find(kernels.m_findContacts, kernels.m_findSwept, &StepCounters::m_swept, input, scene.slotCount(),
                        {limits.m_contacts, pairs.m_limits.m_swept}, threads, counters);
    result.m_sweptTests = counters.m_swept;
    result.m_overLimit = result.m_overTests = counters.m_swept > pairs.m_limits.m_swept;
    if (result.m_overLimit) return false;
    result.m_overLimit = counters.m_contactsFound > limits.m_contacts;
    if (result.m_overLimit)
        result.m_contactDemand = counters.m_contactsFound;
    else
        m_contacts.order(counters.m_contactsFound, result.m_contacts, threads);
    result.m_narrowMs = watch.lapMs();
    return !result.m_overLimit;
}

SelfCounts HostPatches::runSelf(const Scene& scene, const SelfStep& step, SelfStepLimits limits, ThreadTeam& threads,
                                StepResult& result)
{
    Stopwatch watch;
    m_self.update(scene.m_cloths, scene.m_clothRest.data());
    m_self.cull(step, limits.m_candidates, threads);
    result.m_broadMs += watch.lapMs();
    m_self.findContacts(step, limits, threads, result.m_contacts);
    result.m_narrowMs += watch.lapMs();
    return m_self.counts();
}
}  // namespace drape
