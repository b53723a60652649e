#include "topology.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <set>
#include <utility>

#include "kernels/lib/geometry/segment.h"
#include "kernels/lib/geometry/vec3.h"

namespace drape
{
namespace
{
constexpr std::uint32_t kNone = 0xffffffffu;

// Finds a topology's edges by their vertices. Each vertex has a chain of edges. An edge belongs to the chain of its
// end with fewer triangle corners, so that a fan's chains are short.
class EdgeFinder
{
public:
    EdgeFinder(const std::int32_t* triangles, std::size_t triangleCount, std::size_t vertexCount)
        : m_uses(vertexCount, 0), m_first(vertexCount, kNone)
    {
        for (std::size_t i = 0; i < 3 * triangleCount; ++i)
            ++m_uses[std::size_t(triangles[i])];
        m_next.reserve(triangleCount * 3 / 2 + 1);
    }

    // kNone where there is none.
    std::uint32_t find(const Topology& topology, std::uint32_t a, std::uint32_t b) const
    {
        std::uint32_t edge = m_first[chainOf(a, b)];
        while (edge != kNone && !joins(topology.m_edges[edge], a, b))
            edge = m_next[edge];
        return edge;
    }
    // The next of the topology's edges.
    void add(std::uint32_t a, std::uint32_t b)
    {
        const std::uint32_t chain = chainOf(a, b);
        const std::uint32_t edge = std::uint32_t(m_next.size());
        m_next.push_back(m_first[chain]);
        m_first[chain] = edge;
    }

private:
    std::uint32_t chainOf(std::uint32_t a, std::uint32_t b) const
    {
        return m_uses[a] < m_uses[b] || (m_uses[a] == m_uses[b] && a < b) ? a : b;
    }
    static bool joins(const Edge& edge, std::uint32_t a, std::uint32_t b)
    {
        return (edge.m_vertices[0] == a && edge.m_vertices[1] == b) ||
               (edge.m_vertices[0] == b && edge.m_vertices[1] == a);
    }

    std::vector<std::uint32_t> m_uses, m_first;  // by vertex
    std::vector<std::uint32_t> m_next;           // by edge
};

using CrowdedTriangles = std::set<std::array<std::uint32_t, 3>>;

// Returns whether a triangle of the same three vertices was added before. An edge remembers the third vertices of its
// first two triangles. A triangle that is a later one at all its edges is remembered in `crowded`.
bool repeatsTriangle(const Topology& topology, const EdgeFinder& known, CrowdedTriangles& crowded,
                     const std::uint32_t* v)
{
    int leastUses = 255;
    for (int i = 0; i < 3; ++i)
    {
        const std::uint32_t edge = known.find(topology, v[i], v[(i + 1) % 3]);
        if (edge == kNone) return false;
        const std::uint32_t* opposite = topology.m_edges[edge].m_opposite;
        if (opposite[0] == v[(i + 2) % 3] || opposite[1] == v[(i + 2) % 3]) return true;
        leastUses = std::min(leastUses, int(topology.m_edgeUses[edge]));
    }
    if (leastUses < 2) return false;
    std::array<std::uint32_t, 3> key = {v[0], v[1], v[2]};
    std::sort(key.begin(), key.end());
    return !crowded.insert(key).second;
}

void addEdge(Topology& topology, EdgeFinder& known, std::uint32_t index, int i)
{
    Triangle& triangle = topology.m_triangles[index];
    const std::uint32_t a = triangle.m_vertices[i], b = triangle.m_vertices[(i + 1) % 3];
    const std::uint32_t opposite = triangle.m_vertices[(i + 2) % 3];
    const std::uint32_t edge = known.find(topology, a, b);
    triangle.m_edges[i] = edge;
    if (edge == kNone)
    {
        triangle.m_edges[i] = std::uint32_t(topology.m_edges.size());
        known.add(a, b);
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
    EdgeFinder known(triangles, triangleCount, vertexCount);
    CrowdedTriangles crowded;
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
        if (repeatsTriangle(topology, known, crowded, v)) continue;
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
    topology.m_faceCount = topology.m_triangles.size();
    return topology;
}

void addEdges(Topology& topology, const std::int32_t* edges, std::size_t edgeCount)
{
    using VertexPair = std::pair<std::uint32_t, std::uint32_t>;
    const auto pairOf = [](std::uint32_t a, std::uint32_t b) { return VertexPair(std::min(a, b), std::max(a, b)); };
    std::set<VertexPair> known;
    for (std::size_t e = 0; edgeCount > 0 && e < topology.m_edges.size(); ++e)
        known.insert(pairOf(topology.m_edges[e].m_vertices[0], topology.m_edges[e].m_vertices[1]));
    for (std::size_t source = 0; source < edgeCount; ++source)
    {
        const std::uint32_t a = std::uint32_t(edges[2 * source]), b = std::uint32_t(edges[2 * source + 1]);
        assert(a < topology.m_vertexCount && b < topology.m_vertexCount);
        if (a == b || !known.insert(pairOf(a, b)).second) continue;
        const std::uint32_t edge = std::uint32_t(topology.m_edges.size());
        const std::uint32_t index = std::uint32_t(topology.m_triangles.size());
        Triangle triangle = {{a, b, b}, {edge, edge, edge}, DRAPE_OWNS_EDGE(0), 0};
        for (int i = 0; i < 2; ++i)
        {
            std::uint32_t& owner = topology.m_vertexTriangle[triangle.m_vertices[i]];
            if (owner != kNone) continue;
            owner = index;
            triangle.m_owned |= DRAPE_OWNS_VERTEX(i);
        }
        topology.m_edges.push_back(Edge{{a, b}, {b, b}});
        topology.m_edgeTriangle.push_back(index);
        topology.m_edgeUses.push_back(1);
        topology.m_triangles.push_back(triangle);
        topology.m_sourceTriangle.push_back(kNone);
    }
}

void addPoints(Topology& topology)
{
    for (std::uint32_t vertex = 0; vertex < topology.m_vertexCount; ++vertex)
    {
        if (topology.m_vertexTriangle[vertex] != kNone) continue;
        const std::uint32_t edge = std::uint32_t(topology.m_edges.size());
        const std::uint32_t index = std::uint32_t(topology.m_triangles.size());
        topology.m_edges.push_back(Edge{{vertex, vertex}, {vertex, vertex}});
        topology.m_edgeTriangle.push_back(index);
        topology.m_edgeUses.push_back(1);
        topology.m_triangles.push_back(Triangle{{vertex, vertex, vertex}, {edge, edge, edge}, DRAPE_OWNS_VERTEX(0), 0});
        topology.m_sourceTriangle.push_back(kNone);
        topology.m_vertexTriangle[vertex] = index;
    }
}

double surfaceArea(const std::vector<Triangle>& triangles, const float* positions)
{
    double area = 0;
    for (const Triangle& triangle : triangles)
    {
        const Vec3 a = vec3Load(positions, triangle.m_vertices[0]);
        const Vec3 ab = vec3Sub(vec3Load(positions, triangle.m_vertices[1]), a);
        const Vec3 ac = vec3Sub(vec3Load(positions, triangle.m_vertices[2]), a);
        const double twice = isSegment(&triangle) ? vec3Dot(ab, ab) : vec3Length(vec3Cross(ab, ac));
        if (std::isfinite(twice)) area += 0.5 * twice;
    }
    return area;
}
}  // namespace drape
