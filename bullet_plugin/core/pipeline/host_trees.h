// A step on the calling thread by hierarchies of triangles: what the traversals that a setting names find, and contacts
// of cloths with themselves.
#pragma once

#include "bullet_plugin/core/broad_phase/host_traversal.h"
#include "bullet_plugin/core/self_collision/host_self_trees.h"
#include "drape/settings.h"
#include "host_placed_obstacles.h"
#include "step.h"

namespace drape
{
class HostTrees
{
public:
    explicit HostTrees(Traversal traversal) : m_traversal(traversal) {}

    // Does what a step does after meshes came or obstacles moved.
    void update(const Scene& scene);
    // Adds to the result what the pairs give, contacts in canonical order. False when the step is over a limit.
    bool run(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result);
    // Adds what cloths have with themselves, likewise; no contacts where it is over a limit.
    SelfCounts runSelf(const SelfStep& step, SelfStepLimits limits, StepResult& result);

private:
    // Those from slot `fresh` on, and of the others those whose positions or places changed.
    void updateObstacles(const Scene& scene, std::size_t fresh);
    void refitObstacles(const Scene& scene);
    // Returns the invalid nodes.
    std::size_t refitCloths(const Scene& scene, const StepPairs& pairs);
    BroadPhaseSide clothSide(const Scene& scene) const;
    BroadPhaseSide obstacleSide(const Scene& scene) const;

    std::vector<BvhNode> m_clothNodes, m_obstacleNodes;
    HostTraversal m_traversal;
    std::vector<Candidate> m_candidates;
    std::uint32_t m_clothRevision = 0, m_obstacleRevision = 0;
    std::vector<BvhBlock> m_obstacleBlocks;  // that m_obstacleNodes has
    HostPlacedObstacles m_placed;
    HostSelfTrees m_self;
};
}  // namespace drape
