// Runs a step on the chosen back end, and repeats it without some cloths if it exceeds limits.
//
// Job: a step over the limits of ordinary motion (ordinary_tests.h) leaves out cloths that need more than their
// allowance; one over the settings' limits leaves out the largest cloths. Input: the scene and the pairs, which lose
// the cloths that are left out. Output: contacts and statistics. Guarantee: the result is within the limits; the host
// runs the step if the device fails or has no room. Cost: a repetition per cause, which ordinary motion does not have.
#pragma once

#include <vector>

#include "bullet_plugin/core/backend_choice/backend_selector.h"
#include "bullet_plugin/core/backends/step_limits.h"
#include "bullet_plugin/core/backends/step_result.h"
#include "pipeline.h"

namespace drape
{
class StepRunner
{
public:
    StepRunner(BackendSelector& backends, const Settings& settings, const Scene& scene, StepPairs& pairs)
        : m_backends(backends), m_limits(settings), m_scene(scene), m_pairs(pairs)
    {
    }

    // Enqueues the step if the device runs it. place: where its contacts go. sent: number of the cloths' first nodes
    // that are uploaded already.
    void submit(ContactPlace place = ContactPlace::Host, std::size_t sent = 0);
    // Waits for the step, and repeats it where needed.
    void finish(const Pipeline::Allowance& allowance, StepResult& result, StepStatistics& statistics);
    // Brings contacts that stayed on the device to the host. If the device fails, the host finds them.
    void bringContacts(StepResult& result, StepStatistics& statistics);
    // Returns the cloths that the last finish() left out.
    const std::vector<MeshId>& clothsLeftOut() const { return m_leftOut; }
    // Ends a step in which there is nothing to do.
    void skip(StepResult& result)
    {
        m_leftOut.clear();
        result.clear();
    }

private:
    // Runs the step once.
    void complete(StepResult& result, StepStatistics& statistics);
    // Removes a cloth from the step. candidates: the cloth's, as far as they were counted.
    void leaveOut(std::size_t slot, std::uint64_t candidates);
    // Removes cloths until the rest is within the settings' limits. contactDemand: see StepResult.
    void leaveOutCloths(std::uint64_t contactDemand);
    // Removes cloths that need more tests than their allowance, and gives the others theirs.
    void leaveOutStretched(const Pipeline::Allowance& allowance);
    // Raises every cloth's limits to its allowance, where that is more, before a step on the host that is likely to
    // exceed ordinary motion, like the one before.
    void expectMore(const Pipeline::Allowance& allowance);
    // Returns the slots of the cloths that have a pair with an obstacle.
    std::vector<std::size_t> pairedCloths() const;
    float shareOf(std::size_t slot, const Pipeline::Allowance& allowance) const;
    // Returns the tests that a cloth may make: those of ordinary motion times `share`, at least times 1.
    TestLimits limitsOf(std::size_t slot, float share) const;
    // Returns whether one of the active cloths exceeds the limits in a step of its own.
    bool exceeds(std::size_t slot, const std::vector<std::size_t>& active, TestLimits limits);

    BackendSelector& m_backends;
    const StepLimits m_limits;
    const Scene& m_scene;
    StepPairs& m_pairs;
    std::vector<MeshId> m_leftOut;
    std::uint64_t m_leftOutTests = 0;  // candidates of the cloths left out
    bool m_neededMore = false;         // the last step needed more tests than ordinary motion
    bool m_limitsRaised = false;       // in this step they exceed those of ordinary motion
};
}  // namespace drape
