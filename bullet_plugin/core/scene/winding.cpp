#include "winding.h"

namespace drape
{
namespace
{
constexpr std::uint32_t kNone = 0xffffffffu;

int cornerOf(const Triangle& triangle, std::uint32_t vertex)
{
    return triangle.m_vertices[0] == vertex ? 0 : triangle.m_vertices[1] == vertex ? 1 : 2;
}

int edgeOf(const Triangle& triangle, std::uint32_t edge)
{
    return triangle.m_edges[0] == edge ? 0 : triangle.m_edges[1] == edge ? 1 : 2;
}
}  // namespace

WindingSigns::WindingSigns(const Topology& topology)
{
    if (!markTurnedEdges(topology)) return;
    m_vertex.assign(topology.m_triangles.size(), CornerSigns{0, 0, 0});
    std::vector<bool> begun(topology.m_vertexCount, false);
    for (std::uint32_t t = 0; t < topology.m_triangles.size(); ++t)
    {
        for (const std::uint32_t vertex : topology.m_triangles[t].m_vertices)
        {
            if (!begun[vertex]) spread(topology, t, vertex);
            begun[vertex] = true;
        }
    }
}

// Returns whether neighbours are wound differently. An edge runs in the direction of its first triangle; a second
// triangle with the same winding runs along it the other way.
bool WindingSigns::markTurnedEdges(const Topology& topology)
{
    bool any = false;
    m_at.assign(topology.m_edges.size(), {kNone, kNone});
    std::vector<CornerSigns> signs(topology.m_triangles.size(), CornerSigns{1, 1, 1});
    for (std::uint32_t t = 0; t < topology.m_triangles.size(); ++t)
    {
        const Triangle& triangle = topology.m_triangles[t];
        for (std::size_t i = 0; i < 3; ++i)
        {
            std::array<std::uint32_t, 2>& at = m_at[triangle.m_edges[i]];
            if (at[0] == t) continue;  // a point: its edge joins its vertex to itself
            if (at[0] != kNone && triangle.m_vertices[i] == topology.m_edges[triangle.m_edges[i]].m_vertices[0])
            {
                signs[t][i] = -1;
                any = true;
            }
            if (at[1] == kNone) at[at[0] == kNone ? 0 : 1] = t;
        }
    }
    if (any)
        m_edge = std::move(signs);
    else
        m_at.clear();
    return any;
}

// Spreads from the vertex's first triangle to those around it, over the edges that they share.
void WindingSigns::spread(const Topology& topology, std::uint32_t triangle, std::uint32_t vertex)
{
    std::vector<std::uint32_t> open(1, triangle);
    const auto signOf = [&](std::uint32_t t) -> signed char&
    { return m_vertex[t][std::size_t(cornerOf(topology.m_triangles[t], vertex))]; };
    signOf(triangle) = 1;
    while (!open.empty())
    {
        const std::uint32_t from = open.back();
        open.pop_back();
        const Triangle& triangleFrom = topology.m_triangles[from];
        const int corner = cornerOf(triangleFrom, vertex);
        for (const int i : {corner, (corner + 2) % 3})
        {
            const std::uint32_t edge = triangleFrom.m_edges[i];
            for (const std::uint32_t to : m_at[edge])
            {
                if (to == kNone || signOf(to) != 0) continue;
                const int turns = atEdge(from, i) * atEdge(to, edgeOf(topology.m_triangles[to], edge));
                signOf(to) = static_cast<signed char>(signOf(from) * turns);
                open.push_back(to);
            }
        }
    }
}
}  // namespace drape
