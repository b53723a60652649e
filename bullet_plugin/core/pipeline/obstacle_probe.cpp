// Answers queries about single obstacles, on the host.
#include <algorithm>

#include "bullet_plugin/core/queries/mesh_probe.h"
#include "implementation.h"

namespace drape
{
bool Pipeline::anyTriangleIn(MeshId obstacle, const float low[3], const float high[3])
{
    m_implementation->joinScene();
    const MeshPool& obstacles = m_implementation->m_scene.m_obstacles;
    const PooledMesh& mesh = obstacles.mesh(slotOf(obstacles, obstacle));
    for (int axis = 0; axis < 3; ++axis)
        if (!(mesh.m_box.m_low[axis] <= high[axis] && mesh.m_box.m_high[axis] >= low[axis])) return false;
    const float* const positions = mesh.m_positions.data();
    const auto reachesIn = [&](const Triangle& triangle)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const float a = positions[3 * std::size_t(triangle.m_vertices[0]) + axis];
            const float b = positions[3 * std::size_t(triangle.m_vertices[1]) + axis];
            const float c = positions[3 * std::size_t(triangle.m_vertices[2]) + axis];
            if (std::min(std::min(a, b), c) > high[axis] || std::max(std::max(a, b), c) < low[axis]) return false;
        }
        return true;
    };
    return std::any_of(mesh.m_topology.m_triangles.begin(), mesh.m_topology.m_triangles.end(), reachesIn);
}

std::unique_ptr<MeshProbe> Pipeline::makeProbe(MeshId obstacle)
{
    m_implementation->joinScene();
    const MeshPool& obstacles = m_implementation->m_scene.m_obstacles;
    const PooledMesh& mesh = obstacles.mesh(slotOf(obstacles, obstacle));
    return std::make_unique<MeshProbe>(mesh.m_topology, mesh.m_order, mesh.m_positions);
}
}  // namespace drape
