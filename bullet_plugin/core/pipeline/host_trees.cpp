#include "host_trees.h"

#include "bullet_plugin/core/bvh/refit.h"
#include "bullet_plugin/core/bvh/tree_cost.h"
#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
void HostTrees::update(const Scene& scene)
{
    const bool newCloths = m_clothRevision != scene.m_cloths.revision();
    if (newCloths)
    {
        m_clothRevision = scene.m_cloths.revision();
        m_clothNodes = makeBvhNodes(scene.m_clothLayout);
    }
    std::size_t kept = scene.m_obstacles.meshCount();
    const bool newObstacles = m_obstacleRevision != scene.m_obstacles.revision();
    if (newObstacles)
    {
        m_obstacleRevision = scene.m_obstacles.revision();
        kept = sameBlocks(m_obstacleBlocks, scene.m_obstacleLayout.m_blocks);
        makeBvhNodes(scene.m_obstacleLayout, kept, m_obstacleNodes);
        m_obstacleBlocks = scene.m_obstacleLayout.m_blocks;
        m_traversal.setObstacles(obstacleSide(scene), kept);
    }
    if (newCloths || newObstacles) m_traversal.setTopology(clothSide(scene));
    if (newObstacles || m_placed.changed(scene)) updateObstacles(scene, kept);
}

void HostTrees::updateObstacles(const Scene& scene, std::size_t fresh)
{
    m_placed.update(scene, fresh);
    refitObstacles(scene);
    m_traversal.obstaclesRefitted(obstacleSide(scene));
}

void HostTrees::refitObstacles(const Scene& scene)
{
    const MeshPool& obstacles = scene.m_obstacles;
    const BvhLayout& layout = scene.m_obstacleLayout;
    const float* positions = m_placed.view(scene).m_positions;
    if (!layout.joined())
    {
        const std::vector<float> noRadius(obstacles.meshCount(), 0.0f);
        std::size_t ignored = 0;  // the adapter reports bad obstacles when it mirrors them
        refitOnHost(m_obstacleNodes, layout, obstacles.order(), obstacles.triangles(), positions, positions, noRadius,
                    ignored);
        return;
    }
    for (std::size_t slot = 0; slot < obstacles.meshCount(); ++slot)
        if (m_placed.moved(slot))
            refitMeshOnHost(m_obstacleNodes, layout, slot, obstacles.order(), obstacles.triangles(), positions);
    refitTopOnHost(m_obstacleNodes, layout);
}

std::size_t HostTrees::refitCloths(const Scene& scene, const StepPairs& pairs)
{
    update(scene);
    std::size_t invalidNodes = 0;
    refitOnHost(m_clothNodes, scene.m_clothLayout, scene.m_cloths.order(), scene.m_cloths.triangles(),
                scene.m_clothNodes.start(), scene.m_clothNodes.end(), pairs.m_clothRadius, invalidNodes);
    growByMotionsOnHost(m_clothNodes, scene.m_clothLayout, scene.m_cloths.order(), scene.m_cloths.triangles(),
                        scene.m_clothNodes.start(), scene.m_clothNodes.end(), pairs.m_clothRadius, pairs.m_motions,
                        pairs.m_thickness, scene.m_obstacles.meshCount());
    return invalidNodes;
}

BroadPhaseSide HostTrees::clothSide(const Scene& scene) const
{
    return {m_clothNodes, scene.m_clothLayout, scene.m_cloths.order(), scene.m_cloths.triangles()};
}

BroadPhaseSide HostTrees::obstacleSide(const Scene& scene) const
{
    return {m_obstacleNodes, scene.m_obstacleLayout, scene.m_obstacles.order(), scene.m_obstacles.triangles()};
}

SelfCounts HostTrees::runSelf(const SelfStep& step, SelfStepLimits limits, StepResult& result)
{
    Stopwatch watch;
    const SelfCounts counts = m_self.run(step, limits, result.m_contacts);
    result.m_narrowMs += watch.lapMs();
    return counts;
}

bool HostTrees::run(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result)
{
    Stopwatch watch;
    const StepLimits limits(settings);
    result.m_invalidNodes = refitCloths(scene, pairs);
    if (pairs.m_measureTree) result.m_treeCost = treeCostOnHost(m_clothNodes, scene.m_clothLayout.root());
    result.m_refitMs = watch.lapMs();
    if (!m_traversal.run(clothSide(scene), obstacleSide(scene), pairs.m_thickness, scene.m_obstacles.meshCount(),
                         m_candidates, limits.m_candidates))
    {
        std::vector<Candidate>().swap(m_candidates);
        result.m_overLimit = true;
        return false;
    }
    result.m_candidates = m_candidates.size();
    result.m_volumeTests = m_traversal.volumeTests();
    result.m_broadMs = watch.lapMs();
    const ClothView cloth = clothView(scene, settings);
    const ObstacleView obstacle = m_placed.view(scene);
    const MotionList motions = {pairs.m_motions.data(), std::uint32_t(pairs.m_motions.size())};
    const NarrowPhaseSettings narrow = {pairs.m_thickness, scene.m_obstacles.meshCount(), 1.0f + settings.m_activation,
                                        std::uint32_t(settings.m_mode), motions};
    const NarrowPhaseCounts counts =
        narrowPhaseOnHost(m_candidates, cloth, obstacle, narrow, result.m_contacts, limits.m_contacts);
    result.m_sweptTests = counts.m_swept;
    result.m_narrowMs = watch.lapMs();
    if (counts.m_contacts > limits.m_contacts)
    {
        result.m_overLimit = true;
        result.m_contactDemand = counts.m_contacts;
        return false;
    }
    if (settings.m_reportIntersections) intersectOnHost(m_candidates, cloth, obstacle, motions, result.m_intersections);
    result.m_intersectionCount = result.m_intersections.size();
    return true;
}
}  // namespace drape
