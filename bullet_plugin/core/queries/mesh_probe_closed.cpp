// Decides whether a mesh is closed, and measures its volume.
#include <algorithm>
#include <utility>

#include "axis.h"
#include "mesh_probe.h"

namespace drape
{
namespace
{
// Equal for vertices at one position.
std::vector<std::uint32_t> joinedVertices(const std::vector<float>& positions)
{
    std::vector<std::uint32_t> order(positions.size() / 3), joined(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[i] = i;
    const auto less = [&](std::uint32_t a, std::uint32_t b)
    {
        const float *const p = &positions[3 * std::size_t(a)], *const q = &positions[3 * std::size_t(b)];
        return std::lexicographical_compare(p, p + 3, q, q + 3);
    };
    std::sort(order.begin(), order.end(), less);
    for (std::size_t i = 0; i < order.size(); ++i)
        joined[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? joined[order[i - 1]] : order[i];
    return joined;
}
}  // namespace

bool MeshProbe::isClosed()
{
    if (m_closed != Closed::Unknown) return m_closed == Closed::Yes;
    const std::vector<std::uint32_t> joined = joinedVertices(m_positions);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Triangle& triangle : m_triangles)
    {
        for (int i = 0; i < 3; ++i)
        {
            const std::uint32_t a = joined[triangle.m_vertices[i]], b = joined[triangle.m_vertices[(i + 1) % 3]];
            if (a != b) edges.emplace_back(std::min(a, b), std::max(a, b));
        }
    }
    std::sort(edges.begin(), edges.end());
    bool even = !edges.empty();
    for (std::size_t first = 0, next; even && first < edges.size(); first = next)
    {
        for (next = first; next < edges.size() && edges[next] == edges[first];)
            ++next;
        even = (next - first) % 2 == 0;
    }
    m_closed = even ? Closed::Yes : Closed::No;
    return even;
}

double MeshProbe::volume() const
{
    double sixfold = 0;
    const Vec3 origin = m_triangles.empty() ? vec3(0, 0, 0) : corner(0, 0);
    for (std::uint32_t t = 0; t < m_triangles.size(); ++t)
    {
        double p[3][3];
        for (int i = 0; i < 3; ++i)
            for (int axis = 0; axis < 3; ++axis)
                p[i][axis] = double(at(corner(t, i), axis)) - at(origin, axis);
        sixfold += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
                   p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
                   p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return sixfold / 6;
}
}  // namespace drape
