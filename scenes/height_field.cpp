#include "scenes/height_field.h"

#include <algorithm>
#include <cmath>

namespace drape
{
namespace
{
// Cells a side at most: 4 million cells are 16 MB, and a mesh of a million triangles has no finer ones.
constexpr std::size_t kMostCells = 2048;

// Computes the height of the triangle over (x, z). Returns false if the triangle is beside it.
bool heightOver(const float* const corners[3], double x, double z, double& height)
{
    const double x0 = corners[0][0], z0 = corners[0][2];
    const double x1 = corners[1][0] - x0, z1 = corners[1][2] - z0;
    const double x2 = corners[2][0] - x0, z2 = corners[2][2] - z0;
    const double area = x1 * z2 - z1 * x2;
    if (area == 0) return false;
    const double v = ((x - x0) * z2 - (z - z0) * x2) / area;
    const double w = (x1 * (z - z0) - z1 * (x - x0)) / area;
    if (v < 0 || w < 0 || v + w > 1) return false;
    const double y0 = corners[0][1];
    height = y0 + v * (corners[1][1] - y0) + w * (corners[2][1] - y0);
    return true;
}
}  // namespace

HeightField::HeightField(const TriangleMesh& mesh) : m_mesh(mesh), m_bounds(boundsOf(mesh))
{
    const double side = std::sqrt(static_cast<double>(std::max<std::size_t>(mesh.triangleCount(), 1)));
    m_cells = std::min(kMostCells, static_cast<std::size_t>(side));
    m_first.assign(m_cells * m_cells + 1, 0);
    const auto visit = [&](auto&& take)
    {
        for (std::size_t t = 0; t < m_mesh.triangleCount(); ++t)
        {
            std::size_t low[2] = {m_cells, m_cells}, high[2] = {0, 0};
            for (std::size_t corner = 0; corner < 3; ++corner)
            {
                const float* p = &m_mesh.m_positions[3 * static_cast<std::size_t>(m_mesh.m_triangles[3 * t + corner])];
                for (int axis = 0; axis < 2; ++axis)
                {
                    const std::size_t cell = cellOf(p[2 * axis], 2 * axis);
                    low[axis] = std::min(low[axis], cell);
                    high[axis] = std::max(high[axis], cell);
                }
            }
            for (std::size_t j = low[1]; j <= high[1]; ++j)
                for (std::size_t i = low[0]; i <= high[0]; ++i)
                    take(j * m_cells + i, static_cast<std::uint32_t>(t));
        }
    };
    visit([&](std::size_t cell, std::uint32_t) { ++m_first[cell + 1]; });
    for (std::size_t cell = 0; cell < m_cells * m_cells; ++cell)
        m_first[cell + 1] += m_first[cell];
    m_triangles.resize(m_first.back());
    std::vector<std::uint32_t> next(m_first.begin(), m_first.end() - 1);
    visit([&](std::size_t cell, std::uint32_t triangle) { m_triangles[next[cell]++] = triangle; });
}

std::size_t HeightField::cellOf(double value, int axis) const
{
    const double low = m_bounds.m_low[static_cast<std::size_t>(axis)];
    const double cell =
        (value - low) / std::max(static_cast<double>(m_bounds.extent(axis)), 1e-30) * static_cast<double>(m_cells);
    return static_cast<std::size_t>(std::min(std::max(cell, 0.0), static_cast<double>(m_cells - 1)));
}

bool HeightField::highest(double x, double z, double& height) const
{
    if (x < m_bounds.m_low[0] || x > m_bounds.m_high[0] || z < m_bounds.m_low[2] || z > m_bounds.m_high[2])
        return false;
    const std::size_t cell = cellOf(z, 2) * m_cells + cellOf(x, 0);
    bool found = false;
    for (std::uint32_t i = m_first[cell]; i < m_first[cell + 1]; ++i)
    {
        const float* corners[3];
        for (std::size_t corner = 0; corner < 3; ++corner)
            corners[corner] =
                &m_mesh.m_positions[3 * static_cast<std::size_t>(m_mesh.m_triangles[3 * m_triangles[i] + corner])];
        double y = 0;
        if (!heightOver(corners, x, z, y)) continue;
        if (!found || y > height) height = y;
        found = true;
    }
    return found;
}
}  // namespace drape
