// Decides whether a mesh is closed, and measures its volume.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "axis.h"
#include "mesh_probe.h"

namespace drape
{
namespace
{
// Distance of vertices that count as one, as a share of the mesh's size. A surface computed from sines and cosines
// returns to its seam or pole with rounding errors.
constexpr double kSeam = 1e-6;

// A direction along which the vertices of grids, boxes and flat parts do not coincide.
constexpr double kAlong[3] = {0.5257, 0.6821, 0.5083};

// Returns, for each vertex, the first vertex at its position.
std::vector<std::uint32_t> firstsAtPositions(const std::vector<float>& positions)
{
    std::vector<std::uint32_t> order(positions.size() / 3), firsts(order.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto less = [&](std::uint32_t a, std::uint32_t b)
    {
        const float *const p = &positions[3 * std::size_t(a)], *const q = &positions[3 * std::size_t(b)];
        return std::lexicographical_compare(p, p + 3, q, q + 3);
    };
    std::sort(order.begin(), order.end(), less);
    for (std::size_t i = 0; i < order.size(); ++i)
        firsts[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? firsts[order[i - 1]] : order[i];
    return firsts;
}

double alongOf(const float* position)
{
    return kAlong[0] * position[0] + kAlong[1] * position[1] + kAlong[2] * position[2];
}

bool areNear(const float* p, const float* q, double distance)
{
    return std::fabs(double(p[0]) - q[0]) <= distance && std::fabs(double(p[1]) - q[1]) <= distance &&
           std::fabs(double(p[2]) - q[2]) <= distance;
}

// Returns an id per vertex, equal for vertices that count as one. distance: m.
std::vector<std::uint32_t> joinedVertices(const std::vector<float>& positions, double distance)
{
    std::vector<std::uint32_t> joined = firstsAtPositions(positions);
    struct Placed
    {
        double m_along;
        std::uint32_t m_vertex;
    };
    std::vector<Placed> placed;
    for (std::uint32_t vertex = 0; vertex < joined.size(); ++vertex)
    {
        const double along = alongOf(&positions[3 * std::size_t(vertex)]);
        if (joined[vertex] == vertex && std::isfinite(along)) placed.push_back(Placed{along, vertex});
    }
    std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.m_along < b.m_along; });
    const auto root = [&](std::uint32_t vertex)
    {
        while (joined[vertex] != vertex)
            vertex = joined[vertex] = joined[joined[vertex]];
        return vertex;
    };
    for (std::size_t i = 0; i < placed.size(); ++i)
    {
        const float* const own = &positions[3 * std::size_t(placed[i].m_vertex)];
        // Maximum distance along the unit direction of vertices that are near along every axis.
        for (std::size_t j = i + 1; j < placed.size() && placed[j].m_along - placed[i].m_along <= 1.75 * distance; ++j)
            if (areNear(own, &positions[3 * std::size_t(placed[j].m_vertex)], distance))
                joined[root(placed[j].m_vertex)] = root(placed[i].m_vertex);
    }
    for (std::uint32_t vertex = 0; vertex < joined.size(); ++vertex)
        joined[vertex] = root(vertex);
    return joined;
}
}  // namespace

bool MeshProbe::isClosed()
{
    if (m_closed != Closed::Unknown) return m_closed == Closed::Yes;
    const std::vector<std::uint32_t> joined = joinedVertices(m_positions, kSeam * double(size()));
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
