#include "mesh_io/triangulate.h"

#include <cmath>

#include "mesh_io/ear_clipping.h"

namespace drape
{
namespace
{
class Triangulator
{
public:
    Triangulator(const MeshFile& mesh, std::vector<std::int32_t>& triangles) : m_mesh(mesh), m_triangles(triangles) {}

    std::string split(std::size_t face)
    {
        const std::size_t start = m_mesh.faceStart(face), count = m_mesh.m_faceEnds[face] - start;
        m_corners = &m_mesh.m_corners[start];
        if (count == 3)
        {
            m_triangles.insert(m_triangles.end(), m_corners, m_corners + 3);
            return "";
        }
        if (count > kMostVertices) return "face " + std::to_string(face + 1) + ": has too many corners";
        project(count);
        if (count == 4)
        {
            splitFour();
            return "";
        }
        m_numbers.clear();
        const EarClipping::Outcome outcome = m_clipping.split(m_outline, m_numbers);
        if (outcome == EarClipping::Outcome::TooLong)
            return "face " + std::to_string(face + 1) + ": the outline of " + std::to_string(count) +
                   " corners takes too long to triangulate";
        m_notSimple += outcome == EarClipping::Outcome::NotSimple;
        for (const std::int32_t number : m_numbers)
            m_triangles.push_back(m_corners[number]);
        return "";
    }

    std::size_t notSimple() const { return m_notSimple; }

private:
    // Drops the axis along which the polygon's normal (Newell's method) is largest, so that coordinates stay exact.
    void project(std::size_t count)
    {
        const auto position = [&](std::size_t corner)
        { return &m_mesh.m_positions[3 * static_cast<std::size_t>(m_corners[corner])]; };
        const double* origin = position(0);
        double normal[3] = {0, 0, 0};
        for (std::size_t i = 0; i < count; ++i)
        {
            const double *p = position(i), *q = position(i + 1 == count ? 0 : i + 1);
            for (int axis = 0; axis < 3; ++axis)
            {
                const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                normal[axis] += (p[u] - origin[u]) * (q[v] - origin[v]) - (p[v] - origin[v]) * (q[u] - origin[u]);
            }
        }
        int axis = 0;
        for (int i = 1; i < 3; ++i)
            if (std::fabs(normal[i]) > std::fabs(normal[axis])) axis = i;
        const int u = (axis + (normal[axis] < 0 ? 2 : 1)) % 3, v = (axis + (normal[axis] < 0 ? 1 : 2)) % 3;
        m_outline.clear();
        for (std::size_t i = 0; i < count; ++i)
            m_outline.push_back({position(i)[u], position(i)[v]});
    }

    bool isLeft(int a, int b, int c) const
    {
        const Point2 &p = m_outline[a], &q = m_outline[b], &r = m_outline[c];
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0;
    }

    void splitFour()
    {
        const bool atFirst = (isLeft(0, 1, 2) && isLeft(0, 2, 3)) || !(isLeft(1, 2, 3) && isLeft(1, 3, 0));
        static constexpr int numbers[2][6] = {{1, 2, 3, 1, 3, 0}, {0, 1, 2, 0, 2, 3}};
        for (const int number : numbers[atFirst])
            m_triangles.push_back(m_corners[number]);
    }

    const MeshFile& m_mesh;
    std::vector<std::int32_t>& m_triangles;
    EarClipping m_clipping;
    const std::int32_t* m_corners = nullptr;
    std::vector<Point2> m_outline;
    std::vector<std::int32_t> m_numbers;
    std::size_t m_notSimple = 0;
};
}  // namespace

std::string triangulate(const MeshFile& mesh, std::vector<std::int32_t>& triangles, std::vector<std::string>& notes)
{
    triangles.clear();
    triangles.reserve(mesh.m_corners.size());
    Triangulator triangulator(mesh, triangles);
    for (std::size_t face = 0; face < mesh.faceCount(); ++face)
    {
        const std::string problem = triangulator.split(face);
        if (!problem.empty()) return problem;
    }
    if (triangulator.notSimple() > 0)
        notes.push_back(counted(triangulator.notSimple(), "face") +
                        " whose outline meets itself: triangles may overlap");
    return "";
}
}  // namespace drape
