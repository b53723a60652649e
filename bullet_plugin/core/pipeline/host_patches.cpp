#include "host_patches.h"

#include <algorithm>

#include "bullet_plugin/core/compaction/canonical_order.h"
#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
namespace
{
constexpr std::size_t kFirstHits = 1 << 10;
constexpr std::size_t kTestsOfItem = 128;  // a run of them (item_runs.h)
constexpr std::size_t kSweptItems = 32;
// From so many on, which take a fifth of a millisecond, threads are worth waking.
constexpr std::size_t kLeastShared = 1 << 10;
constexpr std::size_t kLeastSweptShared = 1 << 6;
}  // namespace

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

std::size_t HostPatches::findHits(const Scene& scene, const StepPairs& pairs, const Settings& settings,
                                  ThreadTeam& threads, StepCounters& counters)
{
    const HostKernels& kernels = m_cull.kernels();
    const std::size_t limit = StepLimits(settings).m_contacts;
    const HostFeatures features = {m_cull.tests().data(), counters.m_candidates, clothView(scene, settings),
                                   m_placed.view(scene),  m_cull.packed(),       pairs.m_motions.data()};
    const std::size_t items = (counters.m_candidates + kTestsOfItem - 1) / kTestsOfItem;
    if (m_hits.empty()) m_hits.resize(kFirstHits);
    if (m_swept.size() < counters.m_candidates) m_swept.resize(m_cull.tests().size());
    for (std::size_t retries = 0;; ++retries)
    {
        m_slotCount.assign(scene.slotCount(), 0);
        counters.m_listed = counters.m_swept = 0;
        const HostHits list = {m_hits.data(), std::uint32_t(m_hits.size()), m_slotCount.data()};
        const auto run = [&](auto kernel, std::size_t count, bool worth)
        {
            runShared(threads, worth, count,
                      [&](std::size_t item) {
                          kernel(std::uint32_t(item), std::uint32_t(count), features, list, m_swept.data(), &counters);
                      });
        };
        run(kernels.m_findHits, items, counters.m_candidates >= kLeastShared);
        const std::size_t swept = counters.m_swept;
        if (swept > 0) run(kernels.m_findSwept, kSweptItems, swept >= kLeastSweptShared);
        const std::size_t wanted = counters.m_listed;
        if (wanted <= m_hits.size() || wanted > limit) return retries;
        m_hits = std::vector<Contact>();
        m_hits.resize(std::min(wanted + wanted / 4, limit));
    }
}

bool HostPatches::run(const Scene& scene, const StepPairs& pairs, const Settings& settings, ThreadTeam& threads,
                      StepResult& result)
{
    Stopwatch watch;
    update(scene);
    result.m_refitMs = watch.lapMs();
    const StepLimits limits(settings);
    StepCounters counters = {};
    const HostCloths cloths = {
        m_clothOrder.data(),      std::uint32_t(m_clothOrder.size()),           pairs.m_clothRadius.data(),
        pairs.m_thickness.data(), std::uint32_t(scene.m_obstacles.meshCount()), 1.0f + settings.m_activation,
        pairs.m_motions.data(),   std::uint32_t(pairs.m_motions.size())};
    result.m_retries = m_cull.run(clothView(scene, settings), cloths, limits.m_candidates, threads, counters);
    result.m_invalidNodes = counters.m_invalidNodes;
    result.m_broadMs = watch.lapMs();
    result.m_overLimit = counters.m_candidates > limits.m_candidates;
    if (result.m_overLimit) return false;
    result.m_candidates = counters.m_candidates;

    result.m_retries += findHits(scene, pairs, settings, threads, counters);
    result.m_sweptTests = counters.m_swept;
    result.m_overLimit = counters.m_listed > limits.m_contacts;
    if (result.m_overLimit)
        result.m_contactDemand = counters.m_listed;
    else
        orderHits(m_hits.data(), counters.m_listed, m_slotCount, result.m_contacts, threads);
    result.m_narrowMs = watch.lapMs();
    return !result.m_overLimit;
}
}  // namespace drape
