#include "triangles_in_box.h"

#include <algorithm>

namespace drape
{
bool anyTriangleIn(const PooledMesh& mesh, const float low[3], const float high[3])
{
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
}  // namespace drape
