#include "step_runner.h"

#include <cmath>
#include <numeric>

#include "bullet_plugin/core/backends/device_backend.h"
#include "bullet_plugin/core/backends/host_backend.h"
#include "bullet_plugin/core/backends/write_counts.h"
#include "cloths_over_budget.h"

namespace drape
{
void StepRunner::submit(ContactPlace place, std::size_t sent)
{
    if (!m_pairs.m_any) return;
    if (DeviceBackend* const device = m_backends.chosenDevice()) device->submit(m_scene, m_pairs, place, sent);
}

void StepRunner::bringContacts(StepResult& result, StepStatistics& statistics)
{
    DeviceBackend* const device = m_backends.chosenDevice();
    if (device && device->bringContacts(result)) return;
    if (device) m_backends.leaveDevice();
    result.clear();
    m_backends.host().run(m_scene, m_pairs, result, statistics);
    statistics.m_onHost = true;
}

void StepRunner::finish(const Pipeline::Allowance& allowance, StepResult& result, StepStatistics& statistics)
{
    m_leftOut.clear();
    m_leftOutTests = 0;
    const TestLimits ordinary = m_pairs.m_limits;
    expectMore(allowance);
    for (complete(result, statistics); result.m_overLimit; complete(result, statistics))
    {
        if (result.m_overTests)
            leaveOutStretched(allowance);
        else
            leaveOutCloths(result.m_contactDemand);
        submit();
    }
    result.m_isRepeated = result.m_isRepeated || !m_leftOut.empty();
    m_neededMore = statistics.m_candidates > ordinary.m_tests || statistics.m_sweptTests > ordinary.m_swept;
    statistics.m_candidates += m_leftOutTests;
    statistics.m_clothsLeftOut = m_leftOut.size();
    if (!m_leftOut.empty()) statistics.m_status |= kStepClothsLeftOut;
}

void StepRunner::complete(StepResult& result, StepStatistics& statistics)
{
    result.clear();
    writeCounts(StepCounters{}, statistics);
    if (!m_pairs.m_any) return;
    if (DeviceBackend* const device = m_backends.chosenDevice())
    {
        if (device->finish(m_scene, m_pairs, result, statistics)) return;
        if (device->limitReached()) statistics.m_status |= kStepDeviceFull;
        if (device->device().failed()) m_backends.leaveDevice();
    }
    m_backends.host().run(m_scene, m_pairs, result, statistics);
    statistics.m_onHost = true;
}

void StepRunner::leaveOutCloths(std::uint64_t contactDemand)
{
    const std::vector<std::uint64_t> candidates = m_backends.host().countTests(m_scene, m_pairs);
    std::uint64_t budget = m_limits.m_candidates;
    if (contactDemand > 0)
    {
        // Allows as many candidates as should give contacts within their limit, at this step's rate.
        const std::uint64_t all = std::accumulate(candidates.begin(), candidates.end(), std::uint64_t(0));
        budget = std::uint64_t(double(all) * double(m_limits.m_contacts) / double(contactDemand));
    }
    std::vector<std::size_t> active;
    for (std::size_t slot = 0; slot < candidates.size(); ++slot)
        if (m_pairs.hasPair(slot) || m_pairs.m_self.m_radius[slot] >= 0.0f) active.push_back(slot);
    for (const std::size_t slot : clothsOverBudget(active, candidates, budget))
        leaveOut(slot, candidates[slot]);
}

void StepRunner::leaveOut(std::size_t slot, std::uint64_t candidates)
{
    m_leftOutTests += candidates;
    m_pairs.leaveOut(slot);
    m_leftOut.push_back(m_scene.m_cloths.mesh(slot).m_id);
}

std::vector<std::size_t> StepRunner::pairedCloths() const
{
    std::vector<std::size_t> slots;
    for (std::size_t slot = 0; slot < m_pairs.m_clothRadius.size(); ++slot)
        if (m_pairs.hasPair(slot)) slots.push_back(slot);
    return slots;
}

float StepRunner::shareOf(std::size_t slot, const Pipeline::Allowance& allowance) const
{
    return allowance ? allowance(m_scene.m_cloths.mesh(slot).m_id) : HUGE_VALF;
}

TestLimits StepRunner::limitsOf(std::size_t slot, float share) const
{
    const TestLimits& ordinary = m_pairs.m_ordinary[slot];
    if (share <= 1) return TestLimits{ordinary.m_tests, SIZE_MAX};
    return std::isfinite(share) ? ordinary.times(share) : TestLimits();
}

void StepRunner::expectMore(const Pipeline::Allowance& allowance)
{
    m_limitsRaised = false;
    if (!m_neededMore || m_backends.chosenDevice()) return;
    TestLimits all = {0, 0};
    for (const std::size_t slot : pairedCloths())
    {
        const float share = shareOf(slot, allowance);
        if (share <= 1) return;
        all += limitsOf(slot, share);
    }
    m_pairs.m_limits = all;
    m_limitsRaised = true;
}

void StepRunner::leaveOutStretched(const Pipeline::Allowance& allowance)
{
    const std::vector<std::size_t> active = pairedCloths();
    // A GPU's cull lists tests that the host's excludes. Only the host's counts decide, so that all back ends agree.
    const bool onDevice = m_backends.chosenDevice() != nullptr;
    TestLimits all = {0, 0};
    for (const std::size_t slot : active)
    {
        const float share = shareOf(slot, allowance);
        const TestLimits own = limitsOf(slot, share);
        const bool mayExceed = share <= 1 || (m_limitsRaised && std::isfinite(share));
        if (mayExceed && ((active.size() == 1 && !onDevice) || exceeds(slot, active, own)))
            leaveOut(slot, own.m_tests + 1);
        else
            all += mayExceed && onDevice ? TestLimits() : own;
    }
    m_pairs.m_limits = all;
    m_limitsRaised = true;
}

bool StepRunner::exceeds(std::size_t slot, const std::vector<std::size_t>& active, TestLimits limits)
{
    StepPairs alone = m_pairs;
    for (const std::size_t other : active)
        if (other != slot) alone.leaveOut(other);
    alone.m_limits = limits;
    alone.m_anySelf = false;
    StepResult result;
    StepStatistics statistics;
    m_backends.host().run(m_scene, alone, result, statistics);
    return result.m_overLimit;
}
}  // namespace drape
