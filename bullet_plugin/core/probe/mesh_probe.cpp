#include "mesh_probe.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "bullet_plugin/core/probe/bvh_layout.h"
#include "bullet_plugin/core/scene/morton_order.h"
#include "bullet_plugin/core/exact/triangles.h"
#include "axis.h"
#include "kernels/lib/queries/triangle_pair.h"

namespace drape
{
namespace
{
// Rays that are tried before a point counts as outside. Each is inclined differently, so that no regular mesh has
// edges in the way of all.
constexpr int kRays = 12;

ExactPoint exactPoint(Vec3 p)
{
    return {p.x, p.y, p.z};
}

ExactTriangle exactTriangle(const Vec3 corners[3])
{
    return ExactTriangle{{exactPoint(corners[0]), exactPoint(corners[1]), exactPoint(corners[2])}};
}

enum class Crossing
{
    None,
    One,
    Unclear  // the segment runs into an edge or along the face
};

// Decides whether the segment passes through the triangle's inside.
Crossing crossingOf(const ExactPoint& p, const ExactPoint& q, const ExactTriangle& face)
{
    const ExactPoint &a = face.m_p[0], &b = face.m_p[1], &c = face.m_p[2];
    const int start = orientation3(a, b, c, p), end = orientation3(a, b, c, q);
    if (start * end > 0) return Crossing::None;
    const auto [least, most] =
        std::minmax({orientation3(p, q, a, b), orientation3(p, q, b, c), orientation3(p, q, c, a)});
    if (least < 0 && most > 0) return Crossing::None;
    return start * end < 0 && least * most > 0 ? Crossing::One : Crossing::Unclear;
}

// Computes where the segment p q passes through the triangle, in double arithmetic; false if it does not.
bool passes(Vec3 p, Vec3 q, const Vec3 face[3], std::array<double, 3>& place)
{
    const ExactTriangle triangle = exactTriangle(face);
    if (crossingOf(exactPoint(p), exactPoint(q), triangle) != Crossing::One) return false;
    const auto minus = [](Vec3 a, Vec3 b) {
        return std::array<double, 3>{double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z};
    };
    const std::array<double, 3> ab = minus(face[1], face[0]), ac = minus(face[2], face[0]), pq = minus(q, p),
                                ap = minus(p, face[0]);
    const std::array<double, 3> n = {ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2],
                                     ab[0] * ac[1] - ab[1] * ac[0]};
    const double rate = n[0] * pq[0] + n[1] * pq[1] + n[2] * pq[2];
    if (rate == 0) return false;
    const double t = std::min(1.0, std::max(0.0, -(n[0] * ap[0] + n[1] * ap[1] + n[2] * ap[2]) / rate));
    place = {p.x + t * pq[0], p.y + t * pq[1], p.z + t * pq[2]};
    return true;
}

}  // namespace

MeshProbe::MeshProbe(const Topology& topology, const std::vector<std::uint32_t>& order,
                     const std::vector<float>& positions)
    : m_triangles(topology.m_triangles), m_positions(positions)
{
    build(order);
}

MeshProbe::MeshProbe(const MeshDescription& mesh)
    : m_triangles(buildTopology(mesh.m_triangles, mesh.m_triangleCount, mesh.m_vertexCount).m_triangles),
      m_positions(mesh.m_positions, mesh.m_positions + 3 * mesh.m_vertexCount)
{
    build(mortonOrderOnHost(m_triangles, m_positions.data()));
}

void MeshProbe::build(const std::vector<std::uint32_t>& order)
{
    m_order = order;
    const BvhLayout layout = makeBvhLayout(std::uint32_t(m_order.size()));
    for (const BvhNode& node : makeBvhNodes(layout))
        m_nodes.push_back(Node{{}, {}, node.m_first, node.m_count});
    if (!m_nodes.empty()) m_root = layout.root();
    refit();
}

void MeshProbe::refit()
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (Node& node : m_nodes)
    {
        std::fill_n(node.m_low, 3, infinity);
        std::fill_n(node.m_high, 3, -infinity);
        const auto add = [&](const float low[3], const float high[3])
        {
            for (int axis = 0; axis < 3; ++axis)
            {
                node.m_low[axis] = std::min(node.m_low[axis], low[axis]);
                node.m_high[axis] = std::max(node.m_high[axis], high[axis]);
            }
        };
        for (std::uint32_t child = 0; child < node.m_count; ++child)
            add(m_nodes[node.m_first + child].m_low, m_nodes[node.m_first + child].m_high);
        for (int i = 0; node.m_count == 0 && i < 3; ++i)
        {
            const Vec3 place = corner(m_order[node.m_first], i);
            const float coordinates[3] = {place.x, place.y, place.z};
            if (positionIsValid(place)) add(coordinates, coordinates);
        }
    }
}

Vec3 MeshProbe::corner(std::uint32_t triangle, int i) const
{
    return vec3Load(m_positions.data(), m_triangles[triangle].m_vertices[i]);
}

// Calls visit(triangle) for every triangle whose volume meets the box.
template <class Visit>
void MeshProbe::forTrianglesIn(const Box& box, const Visit& visit) const
{
    if (m_nodes.empty()) return;
    std::vector<std::uint32_t> stack = {m_root};
    while (!stack.empty())
    {
        const Node& node = m_nodes[stack.back()];
        stack.pop_back();
        bool meets = true;
        for (int axis = 0; axis < 3; ++axis)
            meets = meets && node.m_low[axis] <= at(box.m_high, axis) && node.m_high[axis] >= at(box.m_low, axis);
        if (!meets) continue;
        if (node.m_count == 0) visit(m_order[node.m_first]);
        for (std::uint32_t child = 0; child < node.m_count; ++child)
            stack.push_back(node.m_first + child);
    }
}

void MeshProbe::listMeeting(const Vec3 corners[3], std::vector<std::uint32_t>& triangles,
                            const std::function<bool(std::uint32_t)>& takes) const
{
    triangles.clear();
    Box box = {corners[0], corners[0]};
    for (int i = 0; i < 3; ++i)
    {
        if (!positionIsValid(corners[i])) return;
        for (int axis = 0; axis < 3; ++axis)
        {
            at(box.m_low, axis) = std::min(at(box.m_low, axis), at(corners[i], axis));
            at(box.m_high, axis) = std::max(at(box.m_high, axis), at(corners[i], axis));
        }
    }
    const ExactTriangle exact = exactTriangle(corners);
    const auto test = [&](std::uint32_t triangle)
    {
        const Vec3 other[3] = {corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)};
        if (!positionIsValid(other[0]) || !positionIsValid(other[1]) || !positionIsValid(other[2])) return;
        if (!takes(triangle) || trianglePairTest(corners, other, -1.0f) == 0) return;
        if (trianglesMeet(exact, exactTriangle(other))) triangles.push_back(triangle);
    };
    forTrianglesIn(box, test);
    std::sort(triangles.begin(), triangles.end());
}

bool MeshProbe::middleOfMeeting(const Vec3 corners[3], const std::vector<std::uint32_t>& triangles, Vec3& middle) const
{
    double sum[3] = {0, 0, 0}, count = 0;
    const auto add = [&](Vec3 p, Vec3 q, const Vec3 face[3])
    {
        std::array<double, 3> place;
        if (!passes(p, q, face, place)) return;
        for (int axis = 0; axis < 3; ++axis)
            sum[axis] += place[std::size_t(axis)];
        ++count;
    };
    for (const std::uint32_t triangle : triangles)
    {
        const Vec3 other[3] = {corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)};
        for (int i = 0; i < 3; ++i)
        {
            add(corners[i], corners[(i + 1) % 3], other);
            add(other[i], other[(i + 1) % 3], corners);
        }
    }
    if (count == 0) return false;
    middle = vec3(float(sum[0] / count), float(sum[1] / count), float(sum[2] / count));
    return true;
}

Vec3 MeshProbe::sumOfNormals(const std::vector<std::uint32_t>& triangles, Vec3 point) const
{
    Vec3 sum = vec3(0, 0, 0);
    for (const std::uint32_t triangle : triangles)
    {
        const Vec3 a = corner(triangle, 0);
        const Vec3 normal = vec3Cross(vec3Sub(corner(triangle, 1), a), vec3Sub(corner(triangle, 2), a));
        const float length = vec3Length(normal);
        if (!(length > 0)) continue;
        const float side = vec3Dot(normal, vec3Sub(point, a)) < 0 ? -1.0f : 1.0f;
        sum = vec3AddScaled(sum, normal, side / length);
    }
    return sum;
}

// False where a crossing is unclear.
bool MeshProbe::countCrossings(Vec3 point, Vec3 target, unsigned& crossings) const
{
    Box box = {point, point};
    for (int axis = 0; axis < 3; ++axis)
    {
        at(box.m_low, axis) = std::min(at(point, axis), at(target, axis));
        at(box.m_high, axis) = std::max(at(point, axis), at(target, axis));
    }
    crossings = 0;
    bool clear = true;
    const ExactPoint p = exactPoint(point), q = exactPoint(target);
    const auto test = [&](std::uint32_t triangle)
    {
        const Vec3 other[3] = {corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)};
        const Crossing crossing = crossingOf(p, q, exactTriangle(other));
        if (crossing == Crossing::One) ++crossings;
        clear = clear && crossing != Crossing::Unclear;
    };
    forTrianglesIn(box, test);
    return clear;
}

bool MeshProbe::isInside(Vec3 point) const
{
    if (m_nodes.empty() || !positionIsValid(point)) return false;
    const Node& root = m_nodes[m_root];
    for (int axis = 0; axis < 3; ++axis)
        if (at(point, axis) < root.m_low[axis] || at(point, axis) > root.m_high[axis]) return false;
    for (int ray = 0; ray < kRays; ++ray)
    {
        const int axis = ray % 3;
        const float extent = root.m_high[axis] - root.m_low[axis];
        Vec3 target = point;
        at(target, axis) = ray / 3 % 2 == 0 ? root.m_high[axis] + extent : root.m_low[axis] - extent;
        const float lean = 0.0017f * float(ray + 1) * (at(target, axis) - at(point, axis));
        at(target, (axis + 1) % 3) += lean;
        at(target, (axis + 2) % 3) += 0.618f * lean;
        unsigned crossings;
        if (countCrossings(point, target, crossings)) return crossings % 2 != 0;
    }
    return false;
}

}  // namespace drape
