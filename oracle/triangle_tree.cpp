#include "oracle/triangle_tree.h"

#include <algorithm>
#include <utility>

namespace drape
{
namespace
{
constexpr std::uint32_t kLeafTriangles = 4;
constexpr int kStack = 128;  // depth is log2 of the triangles, since splits are medians

double squaredDistance(const Vector3& p, const TriangleTree::Node& node)
{
    const double dx = std::max({node.m_low.x - p.x, 0.0, p.x - node.m_high.x});
    const double dy = std::max({node.m_low.y - p.y, 0.0, p.y - node.m_high.y});
    const double dz = std::max({node.m_low.z - p.z, 0.0, p.z - node.m_high.z});
    return dx * dx + dy * dy + dz * dz;
}

bool boxesMeet(const Vector3& lowA, const Vector3& highA, const Vector3& lowB, const Vector3& highB)
{
    return lowA.x <= highB.x && lowB.x <= highA.x && lowA.y <= highB.y && lowB.y <= highA.y && lowA.z <= highB.z &&
           lowB.z <= highA.z;
}

Vector3 lower(const Vector3& a, const Vector3& b)
{
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Vector3 upper(const Vector3& a, const Vector3& b)
{
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

// Returns the closest point by the Voronoi regions of vertices, edges and face (Ericson, Real-Time Collision Detection,
// 5.1.5).
ClosestPoint closestOnTriangle(const Vector3& p, const Vector3 t[3])
{
    const auto result = [&p](const Vector3& point, Feature feature, int index)
    {
        ClosestPoint closest;
        closest.m_point = point;
        closest.m_feature = feature;
        closest.m_featureIndex = index;
        closest.m_squaredDistance = dot(p - point, p - point);
        return closest;
    };
    const Vector3 ab = t[1] - t[0], ac = t[2] - t[0];
    const double d1 = dot(ab, p - t[0]), d2 = dot(ac, p - t[0]);
    if (d1 <= 0 && d2 <= 0) return result(t[0], Feature::OnVertex, 0);
    const double d3 = dot(ab, p - t[1]), d4 = dot(ac, p - t[1]);
    if (d3 >= 0 && d4 <= d3) return result(t[1], Feature::OnVertex, 1);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return result(t[0] + (d1 / (d1 - d3)) * ab, Feature::OnEdge, 0);
    const double d5 = dot(ab, p - t[2]), d6 = dot(ac, p - t[2]);
    if (d6 >= 0 && d5 <= d6) return result(t[2], Feature::OnVertex, 2);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return result(t[0] + (d2 / (d2 - d6)) * ac, Feature::OnEdge, 2);
    const double va = d3 * d6 - d5 * d4;
    const double along = d4 - d3, back = d5 - d6;
    if (va <= 0 && along >= 0 && back >= 0 && along + back > 0)
        return result(t[1] + (along / (along + back)) * (t[2] - t[1]), Feature::OnEdge, 1);
    const double sum = va + vb + vc;
    return result(t[0] + (vb / sum) * ab + (vc / sum) * ac, Feature::OnFace, 0);
}
}  // namespace

TriangleTree::TriangleTree(const float* positions, std::size_t vertexCount, const std::int32_t* triangles,
                           std::size_t triangleCount)
    : m_vertices(vertexCount), m_triangles(triangles, triangles + 3 * triangleCount), m_order(triangleCount)
{
    copyPositions(positions);
    std::vector<Vector3> centres(triangleCount);
    for (std::size_t i = 0; i < triangleCount; ++i)
    {
        Vector3 c[3];
        corners(static_cast<std::int32_t>(i), c);
        centres[i] = c[0] + c[1] + c[2];
        m_order[i] = static_cast<std::int32_t>(i);
    }
    m_nodes.reserve(triangleCount);
    if (triangleCount > 0) build(0, static_cast<std::uint32_t>(triangleCount), centres);
    refit(positions);
}

void TriangleTree::copyPositions(const float* positions)
{
    for (std::size_t i = 0; i < m_vertices.size(); ++i)
        m_vertices[i] = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
}

std::uint32_t TriangleTree::build(std::uint32_t first, std::uint32_t count, const std::vector<Vector3>& centres)
{
    const auto self = static_cast<std::uint32_t>(m_nodes.size());
    m_nodes.emplace_back();
    m_nodes[self].m_first = first;
    m_nodes[self].m_count = count;
    if (count <= kLeafTriangles) return self;
    const auto centre = [&](std::uint32_t i) { return centres[static_cast<std::size_t>(m_order[i])]; };
    Vector3 low = centre(first), high = low;
    for (std::uint32_t i = first; i < first + count; ++i)
    {
        low = lower(low, centre(i));
        high = upper(high, centre(i));
    }
    const Vector3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t half = count / 2;
    std::nth_element(m_order.begin() + first, m_order.begin() + first + half, m_order.begin() + first + count,
                     [&](std::int32_t a, std::int32_t b) {
                         return centres[static_cast<std::size_t>(a)][axis] < centres[static_cast<std::size_t>(b)][axis];
                     });
    build(first, half, centres);
    const std::uint32_t right = build(first + half, count - half, centres);
    m_nodes[self].m_right = right;
    return self;
}

void TriangleTree::fitLeaf(Node& node) const
{
    node.m_low = node.m_high = vertex(indices(m_order[node.m_first])[0]);
    for (std::uint32_t i = node.m_first; i < node.m_first + node.m_count; ++i)
        for (int corner = 0; corner < 3; ++corner)
        {
            const Vector3& p = vertex(indices(m_order[i])[corner]);
            node.m_low = lower(node.m_low, p);
            node.m_high = upper(node.m_high, p);
        }
}

void TriangleTree::refit(const float* positions)
{
    copyPositions(positions);
    for (std::size_t i = m_nodes.size(); i-- > 0;)
    {
        Node& node = m_nodes[i];
        if (node.m_right == 0)
        {
            fitLeaf(node);
            continue;
        }
        node.m_low = lower(m_nodes[i + 1].m_low, m_nodes[node.m_right].m_low);
        node.m_high = upper(m_nodes[i + 1].m_high, m_nodes[node.m_right].m_high);
    }
}

void TriangleTree::corners(std::int32_t triangle, Vector3 out[3]) const
{
    for (int corner = 0; corner < 3; ++corner)
        out[corner] = vertex(indices(triangle)[corner]);
}

ClosestPoint TriangleTree::closest(const Vector3& point, double squaredRadius) const
{
    ClosestPoint best;
    best.m_squaredDistance = squaredRadius;
    std::pair<std::uint32_t, double> stack[kStack];
    int top = 0;
    if (!m_nodes.empty()) stack[top++] = {0, squaredDistance(point, m_nodes[0])};
    while (top > 0)
    {
        const auto [index, distance] = stack[--top];
        if (distance > best.m_squaredDistance) continue;
        const Node& node = m_nodes[index];
        if (node.m_right != 0)
        {
            const double left = squaredDistance(point, m_nodes[index + 1]);
            const double right = squaredDistance(point, m_nodes[node.m_right]);
            const bool leftFirst = left <= right;
            stack[top++] = leftFirst ? std::make_pair(node.m_right, right) : std::make_pair(index + 1, left);
            stack[top++] = leftFirst ? std::make_pair(index + 1, left) : std::make_pair(node.m_right, right);
            continue;
        }
        for (std::uint32_t i = node.m_first; i < node.m_first + node.m_count; ++i)
        {
            Vector3 c[3];
            corners(m_order[i], c);
            ClosestPoint candidate = closestOnTriangle(point, c);
            if (!(candidate.m_squaredDistance <= best.m_squaredDistance)) continue;
            best = candidate;
            best.m_triangle = m_order[i];
        }
    }
    return best;
}

void TriangleTree::visitBox(const Vector3& low, const Vector3& high,
                            const std::function<void(std::int32_t)>& visit) const
{
    std::uint32_t stack[kStack];
    int top = 0;
    if (!m_nodes.empty()) stack[top++] = 0;
    while (top > 0)
    {
        const std::uint32_t index = stack[--top];
        const Node& node = m_nodes[index];
        if (!boxesMeet(low, high, node.m_low, node.m_high)) continue;
        if (node.m_right != 0)
        {
            stack[top++] = node.m_right;
            stack[top++] = index + 1;
            continue;
        }
        for (std::uint32_t i = node.m_first; i < node.m_first + node.m_count; ++i)
        {
            Vector3 c[3];
            corners(m_order[i], c);
            if (boxesMeet(low, high, lower(lower(c[0], c[1]), c[2]), upper(upper(c[0], c[1]), c[2]))) visit(m_order[i]);
        }
    }
}

void TriangleTree::visitPairs(const TriangleTree& other,
                              const std::function<void(std::int32_t, std::int32_t)>& visit) const
{
    if (m_nodes.empty() || other.m_nodes.empty()) return;
    const Node& root = other.m_nodes[0];
    visitBox(root.m_low, root.m_high,
             [&](std::int32_t own)
             {
                 Vector3 c[3];
                 corners(own, c);
                 other.visitBox(lower(lower(c[0], c[1]), c[2]), upper(upper(c[0], c[1]), c[2]),
                                [&](std::int32_t theirs) { visit(own, theirs); });
             });
}
}  // namespace drape
