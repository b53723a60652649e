#include "step_input.h"

#include <algorithm>
#include <cassert>

namespace drape
{
namespace
{
// Extra reach of volumes beyond the feature tests, more than the rounding of those. The choice of candidates then
// never decides whether a pair is a contact.
constexpr float kReachPad = 1.001f;
// Extra reach of candidates beyond contacts, as a share of the obstacle's longest edge. The search for meetings
// counts features as met that are apart by a share of their size (isSwept in kernels/lib/geometry/rigid_motion.h).
constexpr float kEdgePad = 1e-4f;

std::size_t triangleCount(const MeshPool& pool, std::size_t slot)
{
    return pool.mesh(slot).m_topology.m_triangles.size();
}
}  // namespace

void StepInput::collect(Scene& scene, float activation, StepPairs& step, StepStatistics& statistics)
{
    const MeshPool &cloths = scene.m_cloths, &obstacles = scene.m_obstacles;
    step.m_thickness.assign(cloths.meshCount() * obstacles.meshCount(), -1.0f);
    step.m_clothRadius.assign(cloths.meshCount(), -1.0f);
    step.m_ordinary.assign(cloths.meshCount(), TestLimits{0, 0});
    step.m_limits = TestLimits{0, 0};
    m_paired.assign(obstacles.meshCount(), false);
    for (const NamedPair& pair : m_pairs)
        collectPair(scene, pair, activation, step, statistics);
    collectMotions(obstacles, step);
    if (!m_pairs.empty()) statistics.m_obstaclesKept = countKept(scene);
    statistics.m_clothTriangles = cloths.presentFaces();
    statistics.m_obstacleTriangles = obstacles.presentFaces();
    step.m_anyPair = !m_pairs.empty() && !cloths.triangles().empty() && !obstacles.triangles().empty();
    collectSelf(cloths, activation, step);
    step.m_any = step.m_anyPair || step.m_anySelf;
    step.m_kept = std::move(m_kept);
    m_kept.clear();
    m_pairs.clear();
    m_selfCloths.clear();
}

void StepInput::collectPair(const Scene& scene, const NamedPair& pair, float activation, StepPairs& step,
                            StepStatistics& statistics)
{
    assert(pair.m_thickness > 0.0f);
    const std::size_t cloth = scene.m_cloths.existingSlot(pair.m_cloth);
    const std::size_t slot = scene.m_obstacles.existingSlot(pair.m_obstacle);
    const PooledMesh& obstacle = scene.m_obstacles.mesh(slot);
    float& radius = step.m_clothRadius[cloth];
    TestLimits own = ordinaryTestsBeside(triangleCount(scene.m_obstacles, slot));
    if (radius < 0.0f) own += ordinaryTests(triangleCount(scene.m_cloths, cloth));
    step.m_ordinary[cloth] += own;
    // Leaves the continuous tests unbounded: their number depends on the mode, and no contact may depend on the mode.
    step.m_limits += TestLimits{own.m_tests, SIZE_MAX};
    step.m_thickness[cloth * scene.m_obstacles.meshCount() + slot] = pair.m_thickness;
    radius = std::max(radius, pair.m_thickness * (1.0f + activation) * kReachPad + kEdgePad * obstacle.m_longestEdge);
    m_paired[slot] = true;
    if (obstacle.m_coordinateStep > pair.m_thickness) statistics.m_status |= kStepCoarsePositions;
}

void StepInput::collectMotions(const MeshPool& obstacles, StepPairs& step) const
{
    step.m_motions.clear();
    for (std::size_t slot = 0; slot < obstacles.meshCount(); ++slot)
    {
        const PooledMesh& mesh = obstacles.mesh(slot);
        if (m_paired[slot] && mesh.m_poses.moves())
            step.m_motions.push_back(makeMotion(mesh.m_poses, mesh.m_box, std::uint32_t(slot)));
    }
}

void StepInput::collectSelf(const MeshPool& cloths, float activation, StepPairs& step) const
{
    step.m_self.m_thickness.assign(cloths.meshCount(), -1.0f);
    step.m_self.m_radius.assign(cloths.meshCount(), -1.0f);
    step.m_anySelf = false;
    for (const MeshId id : m_selfCloths)
    {
        const std::size_t slot = cloths.existingSlot(id);
        const float thickness = cloths.mesh(slot).m_selfThickness;
        assert(thickness > 0.0f);
        step.m_self.m_thickness[slot] = thickness;
        step.m_self.m_radius[slot] = selfGrowth(thickness * (1.0f + activation));
        step.m_anySelf = step.m_anySelf || triangleCount(cloths, slot) > 0;
    }
}

std::size_t StepInput::countKept(Scene& scene) const
{
    std::size_t kept = 0;
    for (std::size_t slot = 0; slot < m_paired.size(); ++slot)
        kept += m_paired[slot] && !scene.m_obstacles.mesh(slot).m_changed;
    scene.markObstaclesUsed();
    return kept;
}
}  // namespace drape
