// The step on the host. Needs no OpenCL device.
#pragma once

#include <memory>

#include "bullet_plugin/core/compaction/contact_reduction.h"
#include "drape/settings.h"
#include "host_patches.h"
#include "host_trees.h"
#include "step.h"

namespace drape
{
class HostBackend
{
public:
    explicit HostBackend(const Settings& settings, std::shared_ptr<ThreadTeam> threads);

    // Does what a step does after meshes came or obstacles moved.
    void prepare(const Scene& scene);
    // Runs the whole step.
    void run(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result);

    // Gives back room that only earlier, larger steps needed. Between steps.
    void giveBackRoom() { m_patches.giveBackRoom(); }

    // Returns HostPatches::countTests() of the step.
    std::vector<std::uint64_t> countTests(const Scene& scene, const StepPairs& pairs, const Settings& settings);

private:
    static ReductionView reductionView(const Scene& scene, const StepPairs& pairs);
    static SelfStep selfStep(const Scene& scene, const StepPairs& pairs, const Settings& settings);
    // What pairs of cloth and obstacle give, in canonical order. False when the step is over a limit.
    bool runPairs(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result);
    void runSelf(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result);

    std::shared_ptr<ThreadTeam> m_threads;
    bool m_overPatches;
    HostPatches m_patches;
    HostTrees m_trees;
};
}  // namespace drape
