#include "tools/cloth_drop/run_subject.h"

namespace drape
{
bool ObstacleFrame::isWorld() const
{
    for (std::size_t i = 0; i < 9; ++i)
        if (m_axes[i] != (i % 4 == 0 ? 1 : 0)) return false;
    return m_origin.x == 0 && m_origin.y == 0 && m_origin.z == 0;
}

std::vector<float> ObstacleFrame::into(const std::vector<float>& points) const
{
    std::vector<float> own = points;
    if (isWorld()) return own;
    for (std::size_t i = 0; i < own.size(); i += 3)
    {
        const double at[3] = {points[i] - m_origin.x, points[i + 1] - m_origin.y, points[i + 2] - m_origin.z};
        for (std::size_t k = 0; k < 3; ++k)
            own[i + k] = float(m_axes[k] * at[0] + m_axes[3 + k] * at[1] + m_axes[6 + k] * at[2]);
    }
    return own;
}

std::vector<float> ObstacleFrame::outOf(const std::vector<float>& points) const
{
    std::vector<float> world = points;
    if (isWorld()) return world;
    for (std::size_t i = 0; i < world.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            world[i + k] = float(m_origin[int(k)] + m_axes[3 * k] * double(points[i]) +
                                 m_axes[3 * k + 1] * double(points[i + 1]) + m_axes[3 * k + 2] * double(points[i + 2]));
    return world;
}

std::size_t RunSubject::obstacleTriangles() const
{
    std::size_t count = 0;
    for (const TriangleMesh& obstacle : m_obstacles)
        count += obstacle.triangleCount();
    return count;
}

TriangleMesh RunSubject::shown(const std::vector<ObstacleFrame>& frames) const
{
    TriangleMesh all;
    for (std::size_t i = 0; i < m_obstacles.size(); ++i)
    {
        if (!m_isShown[i]) continue;
        const auto first = std::int32_t(all.vertexCount());
        for (const std::int32_t vertex : m_obstacles[i].m_triangles)
            all.m_triangles.push_back(first + vertex);
        const std::vector<float> places = frames[i].outOf(m_obstacles[i].m_positions);
        all.m_positions.insert(all.m_positions.end(), places.begin(), places.end());
    }
    return all;
}
}  // namespace drape
