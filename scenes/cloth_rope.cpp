#include "scenes/cloth_rope.h"

#include <cmath>
#include <utility>

namespace drape
{
namespace
{
constexpr int kSides = 8;  // number of edges around a tube
constexpr double kPi = 3.14159265358979323846;

Vector3 nodeOf(const std::vector<float>& positions, std::size_t node)
{
    const float* const p = &positions[3 * node];
    return {p[0], p[1], p[2]};
}

void addPoint(const Vector3& point, TriangleMesh& mesh)
{
    mesh.m_positions.insert(mesh.m_positions.end(), {float(point.x), float(point.y), float(point.z)});
}

// Adds an open prism from one end to the other, and a tip at each end, so that bends show no gaps.
void addTube(const Vector3& from, const Vector3& to, double radius, TriangleMesh& mesh)
{
    const Vector3 along = normalized(to - from);
    const Vector3 aside = normalized(cross(std::fabs(along.y) < 0.9 ? Vector3{0, 1, 0} : Vector3{1, 0, 0}, along));
    const Vector3 other = cross(along, aside);
    const auto first = std::int32_t(mesh.vertexCount());
    for (int i = 0; i < kSides; ++i)
    {
        const double angle = 2 * kPi * i / kSides;
        const Vector3 out = radius * (std::cos(angle) * aside + std::sin(angle) * other);
        addPoint(from + out, mesh);
        addPoint(to + out, mesh);
    }
    addPoint(from - radius * along, mesh);
    addPoint(to + radius * along, mesh);
    for (std::int32_t i = 0; i < kSides; ++i)
    {
        const std::int32_t low = first + 2 * i, next = first + 2 * ((i + 1) % kSides), tip = first + 2 * kSides;
        mesh.m_triangles.insert(mesh.m_triangles.end(), {low, next, low + 1, next, next + 1, low + 1, next, low, tip,
                                                         low + 1, next + 1, tip + 1});
    }
}
}  // namespace

std::vector<float> nodesBetween(const Vector3& from, const Vector3& to, int count)
{
    std::vector<float> nodes;
    for (int i = 0; i < count; ++i)
    {
        const double share = double(i) / (count - 1);
        const Vector3 node = (1 - share) * from + share * to;
        nodes.insert(nodes.end(), {float(node.x), float(node.y), float(node.z)});
    }
    return nodes;
}

ClothGrid makeRope(std::vector<float> nodes, bool bends)
{
    ClothGrid rope;
    const auto count = std::int32_t(nodes.size() / 3);
    for (std::int32_t node = 0; node + 1 < count; ++node)
        rope.m_edgeSprings.insert(rope.m_edgeSprings.end(), {node, node + 1});
    for (std::int32_t node = 0; bends && node + 2 < count; ++node)
        rope.m_bendingSprings.insert(rope.m_bendingSprings.end(), {node, node + 2});
    rope.m_mesh.m_positions = std::move(nodes);
    return rope;
}

std::vector<double> massesByLength(const std::vector<float>& nodes, double mass)
{
    const std::size_t count = nodes.size() / 3;
    std::vector<double> masses(count);
    double whole = 0;
    for (std::size_t node = 0; node + 1 < count; ++node)
    {
        const double own = length(nodeOf(nodes, node + 1) - nodeOf(nodes, node));
        masses[node] += own / 2;
        masses[node + 1] += own / 2;
        whole += own;
    }
    for (double& share : masses)
        share *= mass / whole;
    return masses;
}

TriangleMesh tubesAround(const std::vector<float>& positions, const std::vector<std::int32_t>& lines, double radius)
{
    TriangleMesh mesh;
    for (std::size_t i = 0; i + 1 < lines.size(); i += 2)
    {
        const Vector3 from = nodeOf(positions, std::size_t(lines[i]));
        const Vector3 to = nodeOf(positions, std::size_t(lines[i + 1]));
        const double size = length(to - from);
        if (size > 0 && std::isfinite(size)) addTube(from, to, radius, mesh);
    }
    return mesh;
}
}  // namespace drape
