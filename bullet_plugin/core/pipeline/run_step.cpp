// Runs a step on the current back end, and repeats it without some cloths if it exceeds limits: without stretched
// cloths for the limits of ordinary motion, without the largest for the settings' limits.
#include <cmath>
#include <numeric>

#include "cloths_over_budget.h"
#include "implementation.h"

namespace drape
{
void Pipeline::Implementation::runOnHost()
{
    m_hostBackend->run(m_scene, m_stepPairs, m_settings, m_result);
    m_statistics.m_onHost = true;
}

void Pipeline::Implementation::enqueue()
{
    if (m_stepPairs.m_any && !m_report.m_onHost) m_deviceBackend->submit(m_scene, m_stepPairs, m_nodesSent);
}

void Pipeline::Implementation::complete()
{
    m_result.clear();
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
    const std::vector<std::uint64_t> candidates = m_hostBackend->countTests(m_scene, m_stepPairs, m_settings);
    const StepLimits limits(m_settings);
    std::uint64_t budget = limits.m_candidates;
    if (m_result.m_contactDemand > 0)
    {
        // Allows as many candidates as should give contacts within their limit, at this step's rate.
        const std::uint64_t all = std::accumulate(candidates.begin(), candidates.end(), std::uint64_t(0));
        budget = std::uint64_t(double(all) * double(limits.m_contacts) / double(m_result.m_contactDemand));
    }
    std::vector<std::size_t> taking;
    for (std::size_t slot = 0; slot < candidates.size(); ++slot)
        if (m_stepPairs.m_clothRadius[slot] >= 0.0f || m_stepPairs.m_self.m_radius[slot] >= 0.0f)
            taking.push_back(slot);
    for (std::size_t slot : clothsOverBudget(taking, candidates, budget))
        leaveOut(slot, candidates[slot]);
}

void Pipeline::Implementation::leaveOut(std::size_t slot, std::uint64_t candidates)
{
    m_statistics.m_status |= kStepClothsLeftOut;
    ++m_statistics.m_clothsLeftOut;
    m_statistics.m_candidates += candidates;
    m_stepPairs.leaveOut(slot);
    m_leftOut.push_back(m_scene.m_cloths.mesh(slot).m_id);
}

// Returns the tests that a slot's cloth may make: those of ordinary motion times `share`, at least times 1.
TestLimits Pipeline::Implementation::allowed(std::size_t slot, float share) const
{
    const TestLimits& ordinary = m_stepPairs.m_ordinary[slot];
    if (share <= 1) return TestLimits{ordinary.m_tests, SIZE_MAX};
    return std::isfinite(share) ? ordinary.times(share) : TestLimits();
}

void Pipeline::Implementation::expectMore(const Allowance& allowance)
{
    m_limitsRaised = false;
    if (!m_neededMore || !m_report.m_onHost) return;
    TestLimits all = {0, 0};
    for (std::size_t slot = 0; slot < m_stepPairs.m_clothRadius.size(); ++slot)
    {
        if (m_stepPairs.m_clothRadius[slot] < 0.0f) continue;
        const float share = allowance ? allowance(m_scene.m_cloths.mesh(slot).m_id) : HUGE_VALF;
        if (share <= 1) return;
        all += allowed(slot, share);
    }
    m_stepPairs.m_limits = all;
    m_limitsRaised = true;
}

void Pipeline::Implementation::leaveOutStretched(const Allowance& allowance)
{
    std::vector<std::size_t> taking;
    for (std::size_t slot = 0; slot < m_stepPairs.m_clothRadius.size(); ++slot)
        if (m_stepPairs.m_clothRadius[slot] >= 0.0f) taking.push_back(slot);
    TestLimits all = {0, 0};
    for (const std::size_t slot : taking)
    {
        const float share = allowance ? allowance(m_scene.m_cloths.mesh(slot).m_id) : HUGE_VALF;
        const TestLimits own = allowed(slot, share);
        const bool isAsked = share <= 1 || (m_limitsRaised && std::isfinite(share));
        if (isAsked && (taking.size() == 1 || needsMore(slot, taking, own)))
            leaveOut(slot, own.m_tests + 1);
        else
            all += own;
    }
    m_stepPairs.m_limits = all;
    m_limitsRaised = true;
}

// Returns whether the active cloth in this slot exceeds the limits of tests in a step of its own.
bool Pipeline::Implementation::needsMore(std::size_t slot, const std::vector<std::size_t>& taking, TestLimits limits)
{
    StepPairs alone = m_stepPairs;
    for (const std::size_t other : taking)
        if (other != slot) alone.leaveOut(other);
    alone.m_limits = limits;
    alone.m_anySelf = false;
    StepResult result;
    m_hostBackend->run(m_scene, alone, m_settings, result);
    return result.m_overLimit;
}
}  // namespace drape
