#include "topology.h"

#include <cassert>
#include <unordered_map>

namespace drape
{
namespace
{
constexpr std::uint32_t kNone = 0xffffffffu;

std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b)
{
    return a < b ? (std::uint64_t(a) << 32 | b) : (std::uint64_t(b) << 32 | a);
}

void addEdge(Topology& topology, std::unordered_map<std::uint64_t, std::uint32_t>& known, std::uint32_t index, int i)
{
    Triangle& triangle = topology.m_triangles[index];
    const std::uint32_t a = triangle.m_vertices[i], b = triangle.m_vertices[(i + 1) % 3];
    const std::uint32_t opposite = triangle.m_vertices[(i + 2) % 3];
    const auto inserted = known.emplace(edgeKey(a, b), std::uint32_t(topology.m_edges.size()));
    const std::uint32_t edge = inserted.first->second;
    triangle.m_edges[i] = edge;
    if (inserted.second)
    {
        topology.m_edges.push_back(Edge{{a, b}, {opposite, opposite}});
        topology.m_edgeTriangle.push_back(index);
        topology.m_edgeUses.push_back(1);
        triangle.m_owned |= DRAPE_OWNS_EDGE(i);
        return;
    }
    if (topology.m_edgeUses[edge] == 1) topology.m_edges[edge].m_opposite[1] = opposite;
    if (topology.m_edgeUses[edge] < 255) ++topology.m_edgeUses[edge];
}
}  // namespace

Topology buildTopology(const std::int32_t* triangles, std::size_t triangleCount, std::size_t vertexCount)
{
    Topology topology;
    topology.m_vertexCount = vertexCount;
    topology.m_vertexTriangle.assign(vertexCount, kNone);
    topology.m_triangles.reserve(triangleCount);
    std::unordered_map<std::uint64_t, std::uint32_t> known;
    known.reserve(triangleCount * 3 / 2 + 1);
    for (std::size_t source = 0; source < triangleCount; ++source)
    {
        Triangle triangle = {};
        for (int i = 0; i < 3; ++i)
        {
            assert(triangles[3 * source + i] >= 0 && std::size_t(triangles[3 * source + i]) < vertexCount);
            triangle.m_vertices[i] = std::uint32_t(triangles[3 * source + i]);
        }
        const std::uint32_t* v = triangle.m_vertices;
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
        const std::uint32_t index = std::uint32_t(topology.m_triangles.size());
        for (int i = 0; i < 3; ++i)
        {
            if (topology.m_vertexTriangle[v[i]] != kNone) continue;
            topology.m_vertexTriangle[v[i]] = index;
            triangle.m_owned |= DRAPE_OWNS_VERTEX(i);
        }
        topology.m_triangles.push_back(triangle);
        topology.m_sourceTriangle.push_back(std::uint32_t(source));
        for (int i = 0; i < 3; ++i)
            addEdge(topology, known, index, i);
    }
    return topology;
}
}  // namespace drape
