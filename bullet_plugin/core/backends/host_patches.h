// A step on the host over patches of the obstacles and, for contacts of cloths with themselves, of the cloths. This
// is the product's method, with a CPU's kernels on a team's threads.
#pragma once

#include "bullet_plugin/core/broad_phase/host_patch_cull.h"
#include "bullet_plugin/core/narrow_phase/host_contacts.h"
#include "bullet_plugin/core/cloth_cloth/host_self_patches.h"
#include "drape/settings.h"
#include "host_placed_obstacles.h"
#include "step.h"

namespace drape
{
class HostPatches
{
public:
    // Updates the patches as a step does after meshes were added or obstacles moved.
    void update(const Scene& scene);
    // Adds the pairs' contacts to the result, in canonical order. Returns false if the step exceeds a limit.
    bool run(const Scene& scene, const StepPairs& pairs, const Settings& settings, ThreadTeam& threads,
             StepResult& result);
    // Adds contacts of cloths with themselves in the same way; none if that exceeds a limit.
    SelfCounts runSelf(const Scene& scene, const SelfStep& step, SelfStepLimits limits, ThreadTeam& threads,
                       StepResult& result);

    // Returns the number of feature tests of each cloth slot in the step, with obstacles plus with itself. Either
    // number is exact up to the step's limit of candidates; a larger one counts as the limit plus one.
    std::vector<std::uint64_t> countTests(const Scene& scene, const StepPairs& pairs, const SelfStep& step,
                                          const Settings& settings, ThreadTeam& threads);

    // Releases memory that only earlier, larger steps needed. Call between steps.
    void giveBackRoom()
    {
        m_cull.giveBackRoom();
        m_placed.giveBackRoom();
        dropRoom(m_clothOrder);
        m_contacts.giveBackRoom();
        m_self.giveBackRoom();
    }

private:
    void updateObstacles(const Scene& scene, std::size_t fresh);
    // The cloths' triangles in these places of their order.
    StepCloths clothsOf(const Scene& scene, const StepPairs& pairs, const Settings& settings,
                        ItemRange triangles) const;

    HostPatchCull m_cull;
    HostPlacedObstacles m_placed;
    std::uint32_t m_clothRevision = 0, m_obstacleRevision = 0;
    std::vector<std::uint32_t> m_clothOrder;  // order of the cloths' own patches, traversed in packets
    HostContactFinder m_contacts;
    HostSelfPatches m_self;
};
}  // namespace drape
