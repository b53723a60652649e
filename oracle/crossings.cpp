#include "oracle/crossings.h"

#include <algorithm>
#include <cmath>

#include "oracle/exact_predicates.h"

namespace drape
{
namespace
{
Vector3 placeOf(const std::vector<float>& positions, std::size_t node)
{
    return {positions[3 * node], positions[3 * node + 1], positions[3 * node + 2]};
}

bool finite(const Vector3& p)
{
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}
}  // namespace

Crossings::Crossings(const TriangleMesh& obstacle, const std::vector<float>& positions)
    : m_surface(obstacle.m_positions.data(), obstacle.vertexCount(), obstacle.m_triangles.data(),
                obstacle.triangleCount()),
      m_crossed(positions.size() / 3, false)
{
    for (std::size_t node = 0; node < m_crossed.size(); ++node)
        m_last.push_back(placeOf(positions, node));
}

void Crossings::follow(const std::vector<float>& positions)
{
    for (std::size_t node = 0; node < m_last.size(); ++node)
    {
        const Vector3 from = m_last[node], to = placeOf(positions, node);
        if (!finite(to)) continue;
        m_last[node] = to;
        if (m_crossed[node]) continue;
        const Vector3 low = {std::min(from.x, to.x), std::min(from.y, to.y), std::min(from.z, to.z)};
        const Vector3 high = {std::max(from.x, to.x), std::max(from.y, to.y), std::max(from.z, to.z)};
        m_surface.visitBox(low, high,
                           [&](std::int32_t triangle)
                           {
                               Vector3 corners[3];
                               m_surface.corners(triangle, corners);
                               if (!m_crossed[node]) m_crossed[node] = segmentMeetsTriangle(from, to, corners);
                           });
    }
}

std::size_t Crossings::nodes() const
{
    return std::size_t(std::count(m_crossed.begin(), m_crossed.end(), true));
}
}  // namespace drape
