#include "warm_up_scene.h"

#include <algorithm>
#include <iterator>

#include "step_input.h"

namespace drape
{
namespace
{
// Arrays instead of vectors: a pipeline may be created during the initialisation of an app's namespace-scope objects,
// before vectors at namespace scope.
constexpr std::int32_t kCorners[] = {0, 1, 2};
constexpr float kAbove[] = {0, 0, 0.5f, 1, 0, 0.5f, 0, 1, 0.5f}, kBelow[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
constexpr float kStartPose[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -0.01f};
constexpr float kEndPose[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
constexpr float kThickness = 0.1f;
}  // namespace

void makeWarmUpScene(Scene& scene, StepPairs& pairs, float selfThickness)
{
    MeshDescription mesh;
    mesh.m_triangles = kCorners;
    mesh.m_triangleCount = 1;
    mesh.m_positions = kBelow;
    mesh.m_vertexCount = 3;
    const MeshId obstacle = scene.addObstacle(mesh);
    mesh.m_selfThickness = selfThickness;
    const MeshId cloth = scene.addCloth(mesh);
    scene.join(nullptr);
    scene.placeObstacle(obstacle, kStartPose, kEndPose);
    std::copy(std::begin(kAbove), std::end(kAbove), scene.m_clothNodes.start());
    StepInput input;
    StepStatistics statistics;
    input.addPair({cloth, obstacle, kThickness});
    if (selfThickness > 0.0f) input.addSelf(cloth);
    input.collect(scene, 0.0f, pairs, statistics);
}
}  // namespace drape
