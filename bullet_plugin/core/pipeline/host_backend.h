// The step on the calling thread, with the kernels' own pure functions. Needs no OpenCL device.
#pragma once

#include "bullet_plugin/core/broad_phase/host_traversal.h"
#include "bullet_plugin/core/bvh/refit.h"
#include "bullet_plugin/core/compaction/contact_reduction.h"
#include "drape/settings.h"
#include "obstacle_changes.h"
#include "step.h"

namespace drape
{
class HostBackend
{
public:
    explicit HostBackend(const Methods& methods = Methods()) : m_traversal(methods.m_traversal) {}

    // Does what a step does after meshes came or obstacles moved.
    void prepare(const Scene& scene) { update(scene); }
    // Runs the whole step.
    void run(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result);

    // The step's pairs of triangles per cloth slot: exact, however many; of cloths with themselves up to the limit.
    std::vector<std::uint64_t> countCandidates(const Scene& scene, const StepPairs& pairs, const Settings& settings);

private:
    // The obstacles in the world: the scene's own arrays where no obstacle has a place.
    struct Placed
    {
        std::vector<float> m_positions;
        std::vector<NormalCone> m_vertexCones, m_edgeCones;
    };
    void update(const Scene& scene);
    // Those from slot `fresh` on, and of the others those whose positions or places changed.
    void updateObstacles(const Scene& scene, std::size_t fresh);
    void refitObstacles(const Scene& scene);
    void place(const Scene& scene);
    ObstacleView obstacleView(const Scene& scene) const;
    static ReductionView reductionView(const Scene& scene, const StepPairs& pairs);
    static SelfStep selfStep(const Scene& scene, const StepPairs& pairs, const Settings& settings);
    // Of cloths that are in the step for their collisions with themselves only.
    static std::size_t invalidSelfNodes(const Scene& scene, const StepPairs& pairs);
    // What pairs of cloth and obstacle give, in canonical order. False when the step is over a limit.
    bool runPairs(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result);
    bool runSelf(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result);
    // Returns the invalid nodes.
    std::size_t refitCloths(const Scene& scene, const StepPairs& pairs);
    BroadPhaseSide clothSide(const Scene& scene) const;
    BroadPhaseSide obstacleSide(const Scene& scene) const;

    std::vector<BvhNode> m_clothNodes, m_obstacleNodes;
    HostTraversal m_traversal;
    SelfContactsOnHost m_self;
    std::vector<Candidate> m_candidates;
    std::uint32_t m_clothRevision = 0, m_obstacleRevision = 0;
    std::vector<BvhBlock> m_obstacleBlocks;  // that m_obstacleNodes has
    ObstacleChanges m_changes;
    Placed m_placed;
};
}  // namespace drape
