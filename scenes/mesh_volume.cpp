#include "scenes/mesh_volume.h"

#include <map>
#include <utility>
#include <vector>

#include "scenes/vector3.h"

namespace drape
{
namespace
{
Vector3 vertexOf(const TriangleMesh& mesh, std::int32_t vertex)
{
    const float* const p = &mesh.m_positions[3 * std::size_t(vertex)];
    return {p[0], p[1], p[2]};
}

using Edge = std::pair<std::int32_t, std::int32_t>;

// Calls `take` with each edge of each triangle in the triangle's direction.
template <typename Take>
void forEachEdge(const TriangleMesh& mesh, const Take& take)
{
    for (std::size_t i = 0; i < mesh.m_triangles.size(); ++i)
        take(Edge(mesh.m_triangles[i], mesh.m_triangles[i % 3 == 2 ? i - 2 : i + 1]));
}

// Returns the number of parts that edges connect. Vertices without a triangle are no part.
std::size_t partsOf(const TriangleMesh& mesh)
{
    std::vector<std::int32_t> parents(mesh.vertexCount(), -1);
    const auto rootOf = [&](std::int32_t vertex)
    {
        while (parents[std::size_t(vertex)] != vertex)
            vertex = parents[std::size_t(vertex)] = parents[std::size_t(parents[std::size_t(vertex)])];
        return vertex;
    };
    for (const std::int32_t vertex : mesh.m_triangles)
        parents[std::size_t(vertex)] = vertex;
    forEachEdge(mesh, [&](const Edge& edge) { parents[std::size_t(rootOf(edge.first))] = rootOf(edge.second); });
    std::size_t parts = 0;
    for (std::size_t vertex = 0; vertex < parents.size(); ++vertex)
        parts += parents[vertex] == std::int32_t(vertex);
    return parts;
}

std::string nameOf(const Edge& edge)
{
    return "the edge of nodes " + std::to_string(edge.first) + " and " + std::to_string(edge.second);
}
}  // namespace

double volumeOf(const TriangleMesh& mesh)
{
    if (mesh.m_triangles.empty()) return 0;
    const Vector3 origin = vertexOf(mesh, mesh.m_triangles[0]);
    double volume = 0;
    for (std::size_t t = 0; t < mesh.m_triangles.size(); t += 3)
    {
        const std::int32_t* const c = &mesh.m_triangles[t];
        volume +=
            dot(vertexOf(mesh, c[0]) - origin, cross(vertexOf(mesh, c[1]) - origin, vertexOf(mesh, c[2]) - origin)) / 6;
    }
    return volume;
}

std::string whyNotClosed(const TriangleMesh& mesh)
{
    if (mesh.m_triangles.empty()) return "it has no triangles";
    std::map<Edge, int> uses;
    forEachEdge(mesh, [&](const Edge& edge) { ++uses[edge]; });
    for (const auto& [edge, count] : uses)
    {
        const auto back = uses.find({edge.second, edge.first});
        const int others = back == uses.end() ? 0 : back->second;
        if (count + others == 1) return nameOf(edge) + " belongs to one triangle only";
        if (count + others > 2)
            return nameOf(edge) + " belongs to " + std::to_string(count + others) + " triangles, not two";
        if (count != 1) return "the triangles at " + nameOf(edge) + " face opposite sides";
    }
    const std::size_t parts = partsOf(mesh);
    return parts > 1 ? "it has " + std::to_string(parts) + " parts; make a cloth of each" : "";
}

void turnOutwards(TriangleMesh& mesh)
{
    if (volumeOf(mesh) >= 0) return;
    for (std::size_t t = 0; t < mesh.m_triangles.size(); t += 3)
        std::swap(mesh.m_triangles[t + 1], mesh.m_triangles[t + 2]);
}
}  // namespace drape
