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

    // Updates the back end as a step does after meshes were added or obstacles moved.
    void prepare(const Scene& scene);
    // Runs the whole step.
    void run(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result);

    // Releases memory that only earlier, larger steps needed. Call between steps.
    void giveBackRoom() { m_patches.giveBackRoom(); }

    // Counts the step's pairs of triangles per cloth slot: exact, however many; for cloths with themselves up to the
    // limit.
    std::vector<std::uint64_t> countCandidates(const Scene& scene, const StepPairs& pairs, const Settings& settings);

private:
    static ReductionView reductionView(const Scene& scene, const StepPairs& pairs);
    static SelfStep selfStep(const Scene& scene, const StepPairs& pairs, const Settings& settings);
    // Finds contacts of cloth-obstacle pairs, in canonical order. Returns false if the step exceeds a limit.
    bool runPairs(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result);
    void runSelf(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result);

    std::shared_ptr<ThreadTeam> m_threads;
    bool m_overPatches;
    HostPatches m_patches;
    HostTrees m_trees;  // over patches it counts only
};
}  // namespace drape
