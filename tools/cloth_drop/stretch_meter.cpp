#include "tools/cloth_drop/stretch_meter.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drape
{
namespace
{
double lengthOf(const std::vector<float>& positions, const std::int32_t vertices[2])
{
    double square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double apart = double(positions[3 * std::size_t(vertices[1]) + axis]) -
                             double(positions[3 * std::size_t(vertices[0]) + axis]);
        square += apart * apart;
    }
    return std::sqrt(square);
}
}  // namespace

StretchMeter::StretchMeter(const TriangleMesh& cloth, const std::vector<std::int32_t>& lines)
{
    std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
    for (std::size_t i = 0; i < cloth.m_triangles.size(); ++i)
    {
        const std::int32_t a = cloth.m_triangles[i], b = cloth.m_triangles[i % 3 == 2 ? i - 2 : i + 1];
        pairs.emplace_back(std::min(a, b), std::max(a, b));
    }
    for (std::size_t i = 0; i + 1 < lines.size(); i += 2)
        pairs.emplace_back(std::min(lines[i], lines[i + 1]), std::max(lines[i], lines[i + 1]));
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [a, b] : pairs)
    {
        Edge edge = {{a, b}, 0};
        edge.m_length = lengthOf(cloth.m_positions, edge.m_vertices);
        if (edge.m_length > 0) m_edges.push_back(edge);
    }
}

MeshStretch StretchMeter::measure(const std::vector<float>& positions) const
{
    MeshStretch stretch;
    if (m_edges.empty()) return stretch;
    stretch.m_max = -1;
    for (const Edge& edge : m_edges)
    {
        const double share = lengthOf(positions, edge.m_vertices) / edge.m_length - 1;
        stretch.m_mean += share / static_cast<double>(m_edges.size());
        stretch.m_max = std::max(stretch.m_max, share);
    }
    return stretch;
}
}  // namespace drape
