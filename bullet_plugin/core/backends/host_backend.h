// The step on the host, with a CPU's kernels on a team's threads: over patches of the obstacles and, for contacts of
// cloths with themselves, of the cloths. Needs no OpenCL device.
#pragma once

#include <memory>
#include <utility>

#include "bullet_plugin/core/broad_phase/host_patch_cull.h"
#include "bullet_plugin/core/cloth_cloth/host_self_patches.h"
#include "bullet_plugin/core/lists/step_pairs.h"
#include "bullet_plugin/core/narrow_phase/host_contacts.h"
#include "drape/settings.h"
#include "host_placed_obstacles.h"
#include "step_limits.h"
#include "step_result.h"

namespace drape
{
class HostBackend
{
public:
    HostBackend(const Settings& settings, std::shared_ptr<ThreadTeam> threads)
        : m_limits(settings),
          m_mode(std::uint32_t(settings.m_mode)),
          m_reachScale(1.0f + settings.m_activation),
          m_threads(std::move(threads))
    {
    }

    // Updates the patches as a step does after meshes were added or obstacles moved.
    void prepare(const Scene& scene);
    // Runs the whole step. Contacts are in canonical order. The result says whether the step exceeded a limit; if not,
    // its counts are written to the statistics. Retries and times are added.
    void run(const Scene& scene, const StepPairs& pairs, StepResult& result, StepStatistics& statistics);
    // Returns the number of feature tests of each cloth slot in the step, with obstacles plus with itself. Either
    // number is exact up to the step's limit of candidates; a larger one counts as the limit plus one.
    std::vector<std::uint64_t> countTests(const Scene& scene, const StepPairs& pairs);

    // Releases memory that only earlier, larger steps needed. Call between steps.
    void giveBackRoom();

private:
    void updateObstacles(const Scene& scene, std::size_t fresh);
    void runPairs(const Scene& scene, const StepPairs& pairs, StepCounters& counters, StepResult& result,
                  StepStatistics& statistics);
    void runSelf(const Scene& scene, const StepPairs& pairs, StepCounters& counters, StepResult& result,
                 StepStatistics& statistics);
    ClothView clothView(const Scene& scene) const;
    // Returns the cloths' triangles in these positions of their order.
    StepCloths clothsOf(const Scene& scene, const StepPairs& pairs, ItemRange triangles) const;
    SelfStep selfStep(const Scene& scene, const StepPairs& pairs) const;

    const StepLimits m_limits;
    const std::uint32_t m_mode;
    const float m_reachScale;  // reach per thickness
    std::shared_ptr<ThreadTeam> m_threads;

    HostPatchCull m_cull;
    HostPlacedObstacles m_placed;
    std::uint32_t m_clothRevision = 0, m_obstacleRevision = 0;
    std::vector<std::uint32_t> m_clothOrder;  // order of the cloths' own patches, traversed in packets
    HostContactFinder m_contacts;
    HostSelfPatches m_self;
};
}  // namespace drape
