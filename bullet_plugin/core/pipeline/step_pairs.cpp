// Collects the work of the coming step: pairs of cloth and obstacle, cloths that collide with themselves, and moving
// obstacles.
#include <algorithm>
#include <cassert>

#include "implementation.h"

namespace drape
{
namespace
{
// Extra reach of volumes beyond the feature tests, more than the rounding of those. The choice of candidates then
// never decides whether a pair is a contact.
constexpr float kReachPad = 1.001f;
// Extra reach of candidates beyond contacts, as a share of the obstacle's longest edge. The search for meetings
// counts features as met that are apart by a share of their size (isSwept in kernels/lib/rigid_motion.h).
constexpr float kEdgePad = 1e-4f;
}  // namespace

void Pipeline::Implementation::findSlots()
{
    m_pairSlots.clear();
    for (const NamedPair& pair : m_pairs)
        m_pairSlots.push_back({slotOf(m_scene.m_cloths, pair.m_cloth), slotOf(m_scene.m_obstacles, pair.m_obstacle)});
}

// Adds the ordinary tests of a pair that is about to be collected.
void Pipeline::Implementation::addOrdinaryTests(std::size_t cloth, std::size_t obstacle)
{
    const auto triangles = [](const MeshPool& pool, std::size_t slot)
    { return pool.mesh(slot).m_topology.m_triangles.size(); };
    TestLimits own = ordinaryTestsBeside(triangles(m_scene.m_obstacles, obstacle));
    if (m_stepPairs.m_clothRadius[cloth] < 0.0f) own += ordinaryTests(triangles(m_scene.m_cloths, cloth));
    m_stepPairs.m_ordinary[cloth] += own;
    // Leaves the continuous tests unbounded: their number depends on the mode, and no contact may depend on the mode.
    m_stepPairs.m_limits += TestLimits{own.m_tests, SIZE_MAX};
}

void Pipeline::Implementation::collectPairs()
{
    const std::size_t obstacleMeshes = m_scene.m_obstacles.meshCount();
    m_stepPairs.m_thickness.assign(m_scene.m_cloths.meshCount() * obstacleMeshes, -1.0f);
    m_stepPairs.m_clothRadius.assign(m_scene.m_cloths.meshCount(), -1.0f);
    m_stepPairs.m_ordinary.assign(m_scene.m_cloths.meshCount(), TestLimits{0, 0});
    m_stepPairs.m_limits = TestLimits{0, 0};
    m_stepPairs.m_anyPair = false;
    m_paired.assign(obstacleMeshes, false);
    findSlots();
    for (std::size_t i = 0; i < m_pairs.size(); ++i)
    {
        const NamedPair& pair = m_pairs[i];
        const std::size_t cloth = m_pairSlots[i].m_cloth, obstacle = m_pairSlots[i].m_obstacle;
        assert(pair.m_thickness > 0.0f);
        m_stepPairs.m_thickness[cloth * obstacleMeshes + obstacle] = pair.m_thickness;
        m_paired[obstacle] = true;
        if (m_scene.m_obstacles.mesh(obstacle).m_coordinateStep > pair.m_thickness)
            m_statistics.m_status |= kStepCoarsePositions;
        addOrdinaryTests(cloth, obstacle);
        float& radius = m_stepPairs.m_clothRadius[cloth];
        radius = std::max(radius, pair.m_thickness * (1.0f + m_settings.m_activation) * kReachPad +
                                      kEdgePad * m_scene.m_obstacles.mesh(obstacle).m_longestEdge);
        m_stepPairs.m_anyPair = true;
    }
    collectMotions();
    if (m_stepPairs.m_anyPair) m_statistics.m_obstaclesKept = countKept();
    m_pairs.clear();
    const std::size_t clothTriangles = m_scene.m_cloths.triangles().size();
    const std::size_t obstacleTriangles = m_scene.m_obstacles.triangles().size();
    m_statistics.m_clothTriangles = m_scene.m_cloths.presentFaces();
    m_statistics.m_obstacleTriangles = m_scene.m_obstacles.presentFaces();
    if (clothTriangles == 0 || obstacleTriangles == 0) m_stepPairs.m_anyPair = false;
    collectSelf();
    m_stepPairs.m_any = m_stepPairs.m_anyPair || m_stepPairs.m_anySelf;
}

void Pipeline::Implementation::collectSelf()
{
    const MeshPool& cloths = m_scene.m_cloths;
    m_stepPairs.m_self.m_thickness.assign(cloths.meshCount(), -1.0f);
    m_stepPairs.m_self.m_radius.assign(cloths.meshCount(), -1.0f);
    m_stepPairs.m_anySelf = false;
    for (MeshId id : m_selfCloths)
    {
        const std::size_t slot = slotOf(cloths, id);
        assert(cloths.mesh(slot).m_selfThickness > 0.0f);
        const float thickness = cloths.mesh(slot).m_selfThickness;
        m_stepPairs.m_self.m_thickness[slot] = thickness;
        m_stepPairs.m_self.m_radius[slot] = selfGrowth(thickness * (1.0f + m_settings.m_activation));
        m_stepPairs.m_anySelf = m_stepPairs.m_anySelf || !cloths.mesh(slot).m_topology.m_triangles.empty();
    }
    m_selfCloths.clear();
}

void Pipeline::Implementation::collectMotions()
{
    const MeshPool& obstacles = m_scene.m_obstacles;
    m_stepPairs.m_motions.clear();
    for (std::size_t slot = 0; slot < obstacles.meshCount(); ++slot)
    {
        const PooledMesh& mesh = obstacles.mesh(slot);
        if (m_paired[slot] && mesh.m_placing.moves())
            m_stepPairs.m_motions.push_back(makeMotion(mesh.m_placing, mesh.m_box, std::uint32_t(slot)));
    }
}

std::size_t Pipeline::Implementation::countKept()
{
    const MeshPool& obstacles = m_scene.m_obstacles;
    std::size_t kept = 0;
    for (std::size_t slot = 0; slot < obstacles.meshCount(); ++slot)
    {
        const PooledMesh& mesh = obstacles.mesh(slot);
        if (m_paired[slot] && !mesh.m_placedAnew) ++kept;
    }
    takeObstacles();
    return kept;
}

void Pipeline::Implementation::takeObstacles()
{
    for (std::size_t slot = 0; slot < m_scene.m_obstacles.meshCount(); ++slot)
        m_scene.m_obstacles.mesh(slot).m_placedAnew = false;
}
}  // namespace drape
