#include "host_backend.h"

#include <algorithm>

#include "step_counts.h"
#include "step_limits.h"

namespace drape
{
std::vector<std::uint64_t> HostBackend::countTests(const Scene& scene, const StepPairs& pairs, const Settings& settings)
{
    return m_patches.countTests(scene, pairs, selfStep(scene, pairs, settings), settings, *m_threads);
}

SelfStep HostBackend::selfStep(const Scene& scene, const StepPairs& pairs, const Settings& settings)
{
    const SelfView view = selfView(clothView(scene, settings), scene.m_clothRest.data(), 1.0f + settings.m_activation);
    return {scene.m_cloths, view, pairs.m_self, pairs.m_clothRadius};
}

void HostBackend::runSelf(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepCounters& counters,
                          StepResult& result, StepStatistics& statistics)
{
    const StepLimits limits(settings);
    const std::size_t others = result.m_contacts.size();
    const SelfStepLimits left = {limits.m_candidates, limits.m_contacts - std::min(limits.m_contacts, others)};
    const SelfStep step = selfStep(scene, pairs, settings);
    const SelfCounts counts = m_patches.runSelf(scene, step, left, *m_threads, result, statistics);
    statistics.m_retries += counts.m_retries;
    counters.m_selfTests = std::uint32_t(counts.m_candidates);
    counters.m_selfSwept = std::uint32_t(counts.m_swept);
    counters.m_invalidNodes += std::uint32_t(counts.m_invalidNodes);
    const bool tooMany = counts.m_contacts > left.m_contacts;
    result.m_overLimit = counts.m_candidates > limits.m_candidates || tooMany;
    if (counts.m_candidates <= limits.m_candidates && tooMany) result.m_contactDemand = others + counts.m_contacts;
}

void HostBackend::run(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result,
                      StepStatistics& statistics)
{
    result.clear();
    StepCounters counters = {};
    if (pairs.m_anyPair) m_patches.run(scene, pairs, settings, *m_threads, counters, result, statistics);
    if (pairs.m_anySelf && !result.m_overLimit) runSelf(scene, pairs, settings, counters, result, statistics);
    if (!result.m_overLimit) writeCounts(counters, statistics);
}
}  // namespace drape
