#include "tools/cloth_drop/smooth_mesh.h"

namespace drape
{
namespace
{
Vector3 vertexOf(const TriangleMesh& mesh, std::int32_t vertex)
{
    const float* p = &mesh.m_positions[3 * static_cast<std::size_t>(vertex)];
    return {p[0], p[1], p[2]};
}

// `fine` is subdivide(coarse): the middles of coarse triangle t's edges are the corners of fine triangle 4t + 3.
void roundMiddles(const TriangleMesh& coarse, TriangleMesh& fine, std::vector<Vector3>& normals)
{
    normals.resize(fine.vertexCount());
    for (std::size_t t = 0; t < coarse.triangleCount(); ++t)
        for (std::size_t i = 0; i < 3; ++i)
        {
            const std::int32_t from = coarse.m_triangles[3 * t + i], to = coarse.m_triangles[3 * t + (i + 1) % 3];
            const Vector3 a = vertexOf(coarse, from), b = vertexOf(coarse, to);
            const Vector3 na = normals[static_cast<std::size_t>(from)], nb = normals[static_cast<std::size_t>(to)];
            const Vector3 middle = 0.5 * (a + b) - 0.125 * (dot(b - a, na) * na + dot(a - b, nb) * nb);
            const auto index = static_cast<std::size_t>(fine.m_triangles[12 * t + 9 + i]);
            for (int axis = 0; axis < 3; ++axis)
                fine.m_positions[3 * index + static_cast<std::size_t>(axis)] = static_cast<float>(middle[axis]);
            normals[index] = normalized(na + nb);
        }
}

// Each of the first three parts that subdivide() makes of a triangle has two halves of its edges, the fourth none.
std::vector<std::uint8_t> edgesOfParts(const std::vector<std::uint8_t>& edges)
{
    std::vector<std::uint8_t> parts;
    for (const unsigned mask : edges)
        for (const unsigned halves : {5u, 3u, 6u, 0u})
            parts.push_back(static_cast<std::uint8_t>(mask & halves));
    return parts;
}
}  // namespace

std::vector<Vector3> vertexNormals(const TriangleMesh& mesh)
{
    std::vector<Vector3> normals(mesh.vertexCount());
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    {
        const std::int32_t* c = &mesh.m_triangles[3 * t];
        const Vector3 a = vertexOf(mesh, c[0]);
        const Vector3 area = cross(vertexOf(mesh, c[1]) - a, vertexOf(mesh, c[2]) - a);
        for (int corner = 0; corner < 3; ++corner)
            normals[static_cast<std::size_t>(c[corner])] += area;
    }
    for (Vector3& normal : normals)
        normal = normalized(normal);
    return normals;
}

ShadedMesh smoothMesh(const TriangleMesh& mesh, int levels, bool edges)
{
    ShadedMesh smooth{mesh, vertexNormals(mesh), {}};
    if (edges) smooth.m_edges.assign(mesh.triangleCount(), 7);
    for (int level = 0; level < levels; ++level)
    {
        TriangleMesh fine = subdivide(smooth.m_mesh);
        roundMiddles(smooth.m_mesh, fine, smooth.m_normals);
        smooth.m_mesh = std::move(fine);
        smooth.m_edges = edgesOfParts(smooth.m_edges);
    }
    return smooth;
}
}  // namespace drape
