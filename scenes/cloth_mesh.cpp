#include "scenes/cloth_mesh.h"

#include <algorithm>
#include <utility>

#include "scenes/vector3.h"

namespace drape
{
namespace
{
// An edge of a triangle, the lower vertex first, and the vertex opposite to it.
struct HalfEdge
{
    std::int32_t m_low, m_high, m_opposite;

    bool sameEdge(const HalfEdge& other) const { return m_low == other.m_low && m_high == other.m_high; }
};

std::vector<HalfEdge> halfEdges(const TriangleMesh& mesh)
{
    std::vector<HalfEdge> all;
    for (std::size_t t = 0; t < mesh.m_triangles.size(); t += 3)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const std::int32_t a = mesh.m_triangles[t + k], b = mesh.m_triangles[t + (k + 1) % 3];
            all.push_back({std::min(a, b), std::max(a, b), mesh.m_triangles[t + (k + 2) % 3]});
        }
    std::sort(all.begin(), all.end(),
              [](const HalfEdge& a, const HalfEdge& b)
              {
                  return std::make_pair(a.m_low, a.m_high) != std::make_pair(b.m_low, b.m_high)
                             ? std::make_pair(a.m_low, a.m_high) < std::make_pair(b.m_low, b.m_high)
                             : a.m_opposite < b.m_opposite;
              });
    return all;
}

Vector3 vertexOf(const TriangleMesh& mesh, std::int32_t vertex)
{
    const float* const p = &mesh.m_positions[3 * std::size_t(vertex)];
    return {p[0], p[1], p[2]};
}

double areaOfTriangle(const TriangleMesh& mesh, std::size_t triangle)
{
    const std::int32_t* const corners = &mesh.m_triangles[3 * triangle];
    const Vector3 origin = vertexOf(mesh, corners[0]);
    return 0.5 * length(cross(vertexOf(mesh, corners[1]) - origin, vertexOf(mesh, corners[2]) - origin));
}
}  // namespace

ClothGrid clothOfMesh(TriangleMesh mesh)
{
    ClothGrid cloth;
    const std::vector<HalfEdge> edges = halfEdges(mesh);
    for (std::size_t i = 0; i < edges.size();)
    {
        std::size_t end = i + 1;
        while (end < edges.size() && edges[end].sameEdge(edges[i]))
            ++end;
        cloth.m_edgeSprings.insert(cloth.m_edgeSprings.end(), {edges[i].m_low, edges[i].m_high});
        if (end == i + 2 && edges[i].m_opposite != edges[i + 1].m_opposite)
            cloth.m_bendingSprings.insert(cloth.m_bendingSprings.end(), {edges[i].m_opposite, edges[i + 1].m_opposite});
        i = end;
    }
    cloth.m_mesh = std::move(mesh);
    return cloth;
}

double areaOf(const TriangleMesh& mesh)
{
    double area = 0;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        area += areaOfTriangle(mesh, t);
    return area;
}

std::vector<double> massesByArea(const TriangleMesh& mesh, double mass)
{
    std::vector<double> masses(mesh.vertexCount());
    const double areaMass = mass / areaOf(mesh);
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            masses[std::size_t(mesh.m_triangles[3 * t + k])] += areaMass * areaOfTriangle(mesh, t) / 3;
    return masses;
}
}  // namespace drape
