#include "host_backend.h"

#include <algorithm>

#include "bullet_plugin/core/broad_phase/candidate_count.h"
#include "bullet_plugin/core/bvh/refit.h"
#include "bullet_plugin/core/bvh/tree_cost.h"
#include "bullet_plugin/core/mesh/reserve_room.h"
#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
void HostBackend::update(const Scene& scene)
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
    if (newObstacles || m_changes.any(scene)) updateObstacles(scene, kept);
}

void HostBackend::updateObstacles(const Scene& scene, std::size_t fresh)
{
    if (!scene.m_anyPosed) m_placed = Placed();
    const bool placesBegin = scene.m_anyPosed && m_placed.m_positions.empty();
    m_changes.take(scene, placesBegin ? 0 : fresh);
    if (scene.m_anyPosed) place(scene);
    refitObstacles(scene);
    m_traversal.obstaclesRefitted(obstacleSide(scene));
}

void HostBackend::refitObstacles(const Scene& scene)
{
    const MeshPool& obstacles = scene.m_obstacles;
    const BvhLayout& layout = scene.m_obstacleLayout;
    const float* positions = obstacleView(scene).m_positions;
    if (!layout.joined())
    {
        const std::vector<float> noRadius(obstacles.meshCount(), 0.0f);
        std::size_t ignored = 0;  // the adapter reports bad obstacles when it mirrors them
        refitOnHost(m_obstacleNodes, layout, obstacles.order(), obstacles.triangles(), positions, positions, noRadius,
                    ignored);
        return;
    }
    for (std::size_t slot = 0; slot < obstacles.meshCount(); ++slot)
        if (m_changes.moved(slot))
            refitMeshOnHost(m_obstacleNodes, layout, slot, obstacles.order(), obstacles.triangles(), positions);
    refitTopOnHost(m_obstacleNodes, layout);
}

// As kernels/place_obstacles.cl.
void HostBackend::place(const Scene& scene)
{
    const auto resize = [](auto& placed, const auto& own)
    {
        reserveRoom(placed, own.size());
        placed.resize(own.size());
    };
    resize(m_placed.m_positions, scene.m_obstaclePositions);
    resize(m_placed.m_vertexCones, scene.m_vertexCones);
    resize(m_placed.m_edgeCones, scene.m_edgeCones);
    for (std::size_t slot = 0; slot < scene.m_places.size(); ++slot)
    {
        if (!m_changes.moved(slot)) continue;
        const ObstaclePlace* at = &scene.m_places[slot];
        const MeshFirsts first = scene.m_obstacles.begin(slot), last = scene.m_obstacles.begin(slot + 1);
        for (std::uint32_t vertex = first.m_vertex; vertex < last.m_vertex; ++vertex)
        {
            const Vec3 p = placedPosition(at, vec3Load(scene.m_obstaclePositions.data(), vertex));
            const float coordinates[3] = {p.x, p.y, p.z};
            std::copy(coordinates, coordinates + 3, &m_placed.m_positions[3 * std::size_t(vertex)]);
            m_placed.m_vertexCones[vertex] = placedCone(at, scene.m_vertexCones[vertex]);
        }
        for (std::uint32_t edge = first.m_edge; edge < last.m_edge; ++edge)
            m_placed.m_edgeCones[edge] = placedCone(at, scene.m_edgeCones[edge]);
    }
}

ObstacleView HostBackend::obstacleView(const Scene& scene) const
{
    const Triangle* triangles = scene.m_obstacles.triangles().data();
    if (scene.m_anyPosed)
        return {m_placed.m_positions.data(), triangles, m_placed.m_vertexCones.data(), m_placed.m_edgeCones.data()};
    return {scene.m_obstaclePositions.data(), triangles, scene.m_vertexCones.data(), scene.m_edgeCones.data()};
}

std::size_t HostBackend::refitCloths(const Scene& scene, const StepPairs& pairs)
{
    update(scene);
    std::size_t invalidNodes = 0;
    refitOnHost(m_clothNodes, scene.m_clothLayout, scene.m_cloths.order(), scene.m_cloths.triangles(),
                scene.m_clothStart.data(), scene.m_clothEnd.data(), pairs.m_clothRadius, invalidNodes);
    growByMotionsOnHost(m_clothNodes, scene.m_clothLayout, scene.m_cloths.order(), scene.m_cloths.triangles(),
                        scene.m_clothStart.data(), scene.m_clothEnd.data(), pairs.m_clothRadius, pairs.m_motions,
                        pairs.m_thickness, scene.m_obstacles.meshCount());
    return invalidNodes;
}

ReductionView HostBackend::reductionView(const Scene& scene, const StepPairs& pairs)
{
    return {scene.m_clothStart.data(),
            scene.m_clothEnd.data(),
            scene.m_cloths.triangles().data(),
            scene.m_cloths.edges().data(),
            scene.m_cloths.firsts().data(),
            scene.m_obstacles.firsts().data(),
            std::uint32_t(scene.m_cloths.meshCount()),
            std::uint32_t(scene.m_obstacles.meshCount()),
            pairs.m_thickness.data(),
            pairs.m_tube.data()};
}

BroadPhaseSide HostBackend::clothSide(const Scene& scene) const
{
    return {m_clothNodes, scene.m_clothLayout, scene.m_cloths.order(), scene.m_cloths.triangles()};
}

BroadPhaseSide HostBackend::obstacleSide(const Scene& scene) const
{
    return {m_obstacleNodes, scene.m_obstacleLayout, scene.m_obstacles.order(), scene.m_obstacles.triangles()};
}

std::vector<std::uint64_t> HostBackend::countCandidates(const Scene& scene, const StepPairs& pairs,
                                                        const Settings& settings)
{
    std::vector<std::uint64_t> counts(scene.m_cloths.meshCount(), 0);
    if (pairs.m_anyPair)
    {
        refitCloths(scene, pairs);
        counts = drape::countCandidates(clothSide(scene), obstacleSide(scene), pairs.m_thickness,
                                        scene.m_cloths.meshCount(), scene.m_obstacles.meshCount());
    }
    if (!pairs.m_anySelf) return counts;
    const std::vector<std::uint64_t> self =
        m_self.countPairs(selfStep(scene, pairs, settings), StepLimits(settings).m_candidates);
    for (std::size_t slot = 0; slot < counts.size(); ++slot)
        counts[slot] += self[slot];
    return counts;
}

SelfStep HostBackend::selfStep(const Scene& scene, const StepPairs& pairs, const Settings& settings)
{
    const MeshPool& cloths = scene.m_cloths;
    const ClothView cloth =
        clothView(scene.m_clothStart.data(), scene.m_clothEnd.data(), cloths.triangles().data(), cloths.edges().data(),
                  std::uint32_t(cloths.vertexCount()), std::uint32_t(cloths.triangles().size()),
                  std::uint32_t(settings.m_mode), nullptr);
    return {cloths, selfView(cloth, scene.m_clothRest.data(), 1.0f + settings.m_activation), pairs.m_self};
}

std::size_t HostBackend::invalidSelfNodes(const Scene& scene, const StepPairs& pairs)
{
    std::size_t invalid = 0;
    for (const Triangle& triangle : scene.m_cloths.triangles())
    {
        if (pairs.m_clothRadius[triangle.m_mesh] >= 0.0f || pairs.m_self.m_radius[triangle.m_mesh] < 0.0f) continue;
        Dop ignored;
        invalid += leafVolume(&ignored, &triangle, scene.m_clothStart.data(), scene.m_clothEnd.data(), 0.0f);
    }
    return invalid;
}

bool HostBackend::runSelf(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result)
{
    const StepLimits limits(settings);
    const std::size_t others = result.m_contacts.size();
    result.m_invalidNodes += invalidSelfNodes(scene, pairs);
    const SelfCounts counts = m_self.run(selfStep(scene, pairs, settings), limits.m_candidates,
                                         limits.m_contacts - std::min(limits.m_contacts, others), result.m_contacts);
    result.m_selfCandidates = counts.m_candidates;
    result.m_selfSweptTests = counts.m_swept;
    const bool tooMany = others + counts.m_contacts > limits.m_contacts;
    result.m_overLimit = counts.m_candidates > limits.m_candidates || tooMany;
    if (counts.m_candidates <= limits.m_candidates && tooMany) result.m_contactDemand = others + counts.m_contacts;
    return !result.m_overLimit;
}

void HostBackend::run(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result)
{
    result = StepResult();
    if (pairs.m_anyPair && !runPairs(scene, pairs, settings, result)) return;
    if (pairs.m_anySelf) runSelf(scene, pairs, settings, result);
}

bool HostBackend::runPairs(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result)
{
    const MeshPool& cloths = scene.m_cloths;
    const MeshPool& obstacles = scene.m_obstacles;
    Stopwatch watch;
    const StepLimits limits(settings);
    result.m_invalidNodes = refitCloths(scene, pairs);
    if (pairs.m_measureTree) result.m_treeCost = treeCostOnHost(m_clothNodes, scene.m_clothLayout.root());
    result.m_refitMs = watch.lapMs();
    if (!m_traversal.run(clothSide(scene), obstacleSide(scene), pairs.m_thickness, obstacles.meshCount(), m_candidates,
                         limits.m_candidates))
    {
        std::vector<Candidate>().swap(m_candidates);
        result.m_overLimit = true;
        return false;
    }
    result.m_candidates = m_candidates.size();
    result.m_volumeTests = m_traversal.volumeTests();
    result.m_broadMs = watch.lapMs();
    const std::uint32_t mode = std::uint32_t(settings.m_mode);
    const ClothView cloth =
        clothView(scene.m_clothStart.data(), scene.m_clothEnd.data(), cloths.triangles().data(), cloths.edges().data(),
                  std::uint32_t(cloths.vertexCount()), std::uint32_t(cloths.triangles().size()), mode, nullptr);
    const ObstacleView obstacle = obstacleView(scene);
    const MotionList motions = {pairs.m_motions.data(), std::uint32_t(pairs.m_motions.size())};
    const NarrowPhaseSettings narrow = {pairs.m_thickness, obstacles.meshCount(), 1.0f + settings.m_activation, mode,
                                        motions};
    const NarrowPhaseCounts counts =
        narrowPhaseOnHost(m_candidates, cloth, obstacle, narrow, result.m_contacts, limits.m_contacts);
    result.m_sweptTests = counts.m_swept;
    if (counts.m_contacts > limits.m_contacts)
    {
        result.m_overLimit = true;
        result.m_contactDemand = counts.m_contacts;
        return false;
    }
    if (pairs.m_anyTube)
    {
        reduceOnHost(result.m_contacts, reductionView(scene, pairs), scene.slotCount());
        result.m_reduced = counts.m_contacts - result.m_contacts.size();
    }
    result.m_narrowMs = watch.lapMs();
    if (settings.m_reportIntersections) intersectOnHost(m_candidates, cloth, obstacle, motions, result.m_intersections);
    result.m_intersectionCount = result.m_intersections.size();
    return true;
}
}  // namespace drape
