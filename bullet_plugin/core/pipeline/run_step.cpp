// Runs a step on the back end in use, and again without the largest cloths where it is over the settings' limits.
#include <numeric>

#include "cloths_over_budget.h"
#include "implementation.h"

namespace drape
{
void Pipeline::Implementation::runOnHost()
{
    if (!goesOverPatches(m_settings)) layOut();
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
    layOut();
    const std::vector<std::uint64_t> candidates = m_hostBackend->countCandidates(m_scene, m_stepPairs, m_settings);
    const StepLimits limits(m_settings);
    std::uint64_t budget = limits.m_candidates;
    if (m_result.m_contactDemand > 0)
    {
        // As many candidates as should give contacts within their limit, at the rate of this step.
        const std::uint64_t all = std::accumulate(candidates.begin(), candidates.end(), std::uint64_t(0));
        budget = std::uint64_t(double(all) * double(limits.m_contacts) / double(m_result.m_contactDemand));
    }
    std::vector<std::size_t> taking;
    for (std::size_t slot = 0; slot < candidates.size(); ++slot)
        if (m_stepPairs.m_clothRadius[slot] >= 0.0f || m_stepPairs.m_self.m_radius[slot] >= 0.0f)
            taking.push_back(slot);
    m_statistics.m_status |= kStepClothsLeftOut;
    for (std::size_t slot : clothsOverBudget(taking, candidates, budget))
    {
        ++m_statistics.m_clothsLeftOut;
        m_statistics.m_candidates += candidates[slot];
        m_stepPairs.leaveOut(slot);
        m_leftOut.push_back(m_scene.m_cloths.mesh(slot).m_id);
    }
}
}  // namespace drape
