#include "warm_up_step.h"

#include <algorithm>
#include <iterator>

namespace drape
{
namespace
{
// Arrays instead of vectors: a pipeline may be created during the initialisation of an app's namespace-scope objects,
// before vectors at namespace scope.
constexpr float kAbove[] = {0, 0, 0.5f, 1, 0, 0.5f, 0, 1, 0.5f}, kBelow[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
constexpr float kReach = 0.1f;

void addTriangle(MeshPool& pool)
{
    const std::int32_t indices[3] = {0, 1, 2};
    PooledMesh mesh;
    mesh.m_id = 0;
    mesh.m_topology = buildTopology(indices, 1, 3);
    mesh.m_order = {0};
    mesh.m_positions.assign(std::begin(kBelow), std::end(kBelow));
    pool.add(std::move(mesh));
    pool.update();
}
}  // namespace

void makeWarmUpStep(Scene& scene, StepPairs& pairs, float selfThickness)
{
    addTriangle(scene.m_cloths);
    addTriangle(scene.m_obstacles);
    scene.m_clothNodes.reserve(nullptr, std::size(kAbove));
    std::copy(std::begin(kAbove), std::end(kAbove), scene.m_clothNodes.start());
    std::copy(std::begin(kBelow), std::end(kBelow), scene.m_clothNodes.end());
    scene.m_obstaclePositions.assign(std::begin(kBelow), std::end(kBelow));
    scene.m_vertexCones.assign(3, NormalCone{{0, 0, 1}, -1});
    scene.m_edgeCones.assign(3, NormalCone{{0, 0, 1}, -1});
    ObstaclePlacing placing;
    placing.m_posed = true;
    placing.m_start = placing.m_end = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    scene.m_places = {ObstaclePlace{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, 1, 0, 0}};
    scene.m_anyPosed = true;
    pairs.m_motions = {makeMotion(placing, MeshBox{{0, 0, 0}, {1, 1, 0}}, 0)};
    pairs.m_thickness = {kReach};
    pairs.m_clothRadius = {kReach};
    pairs.m_anyPair = pairs.m_any = true;
    if (!(selfThickness > 0.0f)) return;
    scene.m_anySelf = pairs.m_anySelf = true;
    scene.m_clothRest.assign(std::begin(kBelow), std::end(kBelow));
    pairs.m_self = SelfReach{{selfThickness}, {selfGrowth(selfThickness)}};
}
}  // namespace drape
