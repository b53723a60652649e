// The step's pairs of cloth and obstacle on the host, over patches of the obstacles: the product's own way, with the
// kernels of a CPU on the threads of a team.
#pragma once

#include "bullet_plugin/core/broad_phase/host_patch_cull.h"
#include "drape/settings.h"
#include "host_placed_obstacles.h"
#include "step.h"

namespace drape
{
class HostPatches
{
public:
    // Does what a step does after meshes came or obstacles moved.
    void update(const Scene& scene);
    // Adds to the result what the pairs give, contacts in canonical order. False when the step is over a limit.
    bool run(const Scene& scene, const StepPairs& pairs, const Settings& settings, ThreadTeam& threads,
             StepResult& result);

private:
    void updateObstacles(const Scene& scene, std::size_t fresh);
    // Lists the hits of the culled tests, in no particular order, and counts them. Returns how often the list was too
    // short and grew.
    std::size_t findHits(const Scene& scene, const StepPairs& pairs, const Settings& settings, ThreadTeam& threads,
                         StepCounters& counters);

    HostPatchCull m_cull;
    HostPlacedObstacles m_placed;
    std::uint32_t m_clothRevision = 0, m_obstacleRevision = 0;
    std::vector<std::uint32_t> m_clothOrder;  // that of the cloths' own patches, since it walks for packets
    std::vector<Contact> m_hits;
    std::vector<std::uint32_t> m_slotCount;  // of hits
    std::vector<std::uint32_t> m_swept;      // tests that the continuous test decides
};
}  // namespace drape
