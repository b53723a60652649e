// Runs a step on the back end in use, and again without the largest cloths where it is over the settings' limits.
#include <algorithm>
#include <numeric>

#include "implementation.h"

namespace drape
{
namespace
{
// Cloth slots to take out so that the others have at most `budget` candidates together: those with the most, of equals
// the last ones. At least one.
std::vector<std::size_t> largestCloths(const std::vector<std::uint64_t>& candidates, std::uint64_t budget)
{
    std::vector<std::size_t> slots(candidates.size());
    std::iota(slots.begin(), slots.end(), std::size_t(0));
    std::stable_sort(slots.begin(), slots.end(),
                     [&](std::size_t a, std::size_t b) { return candidates[a] < candidates[b]; });
    std::uint64_t sum = 0;
    std::size_t kept = 0;
    while (kept + 1 < slots.size() && sum + candidates[slots[kept]] <= budget)
        sum += candidates[slots[kept++]];
    slots.erase(slots.begin(), slots.begin() + std::ptrdiff_t(kept));
    return slots;
}
}  // namespace

void Pipeline::Implementation::runOnHost()
{
    m_hostBackend.run(m_scene, m_stepPairs, m_settings, m_result);
    m_statistics.m_onHost = true;
}

void Pipeline::Implementation::enqueue()
{
    if (m_stepPairs.m_any && !m_report.m_onHost) m_deviceBackend->submit(m_scene, m_stepPairs, m_nodesSent);
}

void Pipeline::Implementation::complete()
{
    m_result = StepResult();
    if (!m_stepPairs.m_any) return;
    if (m_report.m_onHost)
    {
        runOnHost();
    }
    else if (!m_deviceBackend->finish(m_scene, m_stepPairs, m_result))
    {
        if (m_deviceBackend->limitReached()) m_statistics.m_status |= kStepDeviceFull;
        if (m_deviceBackend->device().failed()) leaveDevice();
        runOnHost();
    }
}

void Pipeline::Implementation::leaveOutCloths()
{
    const std::vector<std::uint64_t> candidates = m_hostBackend.countCandidates(m_scene, m_stepPairs, m_settings);
    const StepLimits limits(m_settings);
    std::uint64_t budget = limits.m_candidates;
    if (m_result.m_contactDemand > 0)
    {
        // As many candidates as should give contacts within their limit, at the rate of this step.
        const std::uint64_t all = std::accumulate(candidates.begin(), candidates.end(), std::uint64_t(0));
        budget = std::uint64_t(double(all) * double(limits.m_contacts) / double(m_result.m_contactDemand));
    }
    m_statistics.m_status |= kStepClothsLeftOut;
    for (std::size_t slot : largestCloths(candidates, budget))
    {
        if (m_stepPairs.m_clothRadius[slot] < 0.0f && m_stepPairs.m_self.m_radius[slot] < 0.0f) continue;
        ++m_statistics.m_clothsLeftOut;
        m_statistics.m_candidates += candidates[slot];
        m_stepPairs.leaveOut(slot);
    }
}
}  // namespace drape
