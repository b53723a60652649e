#include "mesh_probe.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "bullet_plugin/core/bvh/morton_order.h"
#include "bullet_plugin/core/bvh/refit.h"
#include "bullet_plugin/core/exact/triangles.h"
#include "kernels/lib/closest.h"
#include "kernels/lib/triangle_pair.h"

namespace drape
{
namespace
{
// Rays that are tried before a point counts as outside. Each leans by other shares of its length, so that no regular
// mesh has edges in the way of all.
constexpr int kRays = 12;

ExactPoint exactPoint(Vec3 p)
{
    return {p.x, p.y, p.z};
}

ExactTriangle exactTriangle(const Vec3 corners[3])
{
    return ExactTriangle{{exactPoint(corners[0]), exactPoint(corners[1]), exactPoint(corners[2])}};
}

float& at(Vec3& v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

float at(const Vec3& v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

enum class Crossing
{
    None,
    One,
    Unclear  // the segment runs into an edge or along the face
};

// Whether the segment passes through the triangle's inside.
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

// Where the segment p q passes through the triangle, in double arithmetic; false where it does not.
bool passes(Vec3 p, Vec3 q, const Vec3 face[3], std::array<double, 3>& place)
{
    const ExactTriangle triangle = exactTriangle(face);
    if (crossingOf(exactPoint(p), exactPoint(q), triangle) != Crossing::One) return false;
    const auto minus = [](Vec3 a, Vec3 b) {
        return std::array<double, 3>{double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z};
    };
    const std::array<double, 3> ab = minus(face[1], face[0]), ac = minus(face[2], face[0]), way = minus(q, p),
                                ap = minus(p, face[0]);
    const std::array<double, 3> n = {ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2],
                                     ab[0] * ac[1] - ab[1] * ac[0]};
    const double rate = n[0] * way[0] + n[1] * way[1] + n[2] * way[2];
    if (rate == 0) return false;
    const double t = std::min(1.0, std::max(0.0, -(n[0] * ap[0] + n[1] * ap[1] + n[2] * ap[2]) / rate));
    place = {p.x + t * way[0], p.y + t * way[1], p.z + t * way[2]};
    return true;
}

// Unit vectors along a triangle's first edge, across it and along its normal.
struct TriangleFrame
{
    Vec3 m_along, m_across, m_normal;
};

// False where the triangle has no area.
bool frameOf(const Vec3 corners[3], TriangleFrame& frame)
{
    const Vec3 edge = vec3Sub(corners[1], corners[0]), normal = vec3Cross(edge, vec3Sub(corners[2], corners[0]));
    const float length = vec3Length(edge), area = vec3Length(normal);
    if (!(length > 0) || !(area > 0)) return false;
    frame.m_along = vec3Scale(edge, 1 / length);
    frame.m_normal = vec3Scale(normal, 1 / area);
    frame.m_across = vec3Cross(frame.m_normal, frame.m_along);
    return true;
}

double squaredDistanceToBox(const BvhNode& node, Vec3 p)
{
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double below = double(node.m_low[axis]) - at(p, axis), above = double(at(p, axis)) - node.m_high[axis];
        const double off = std::max(0.0, std::max(below, above));
        sum += off * off;
    }
    return sum;
}

// Equal for vertices at one position.
std::vector<std::uint32_t> joinedVertices(const std::vector<float>& positions)
{
    std::vector<std::uint32_t> order(positions.size() / 3), joined(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[i] = i;
    const auto less = [&](std::uint32_t a, std::uint32_t b)
    {
        const float *const p = &positions[3 * std::size_t(a)], *const q = &positions[3 * std::size_t(b)];
        return std::lexicographical_compare(p, p + 3, q, q + 3);
    };
    std::sort(order.begin(), order.end(), less);
    for (std::size_t i = 0; i < order.size(); ++i)
        joined[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? joined[order[i - 1]] : order[i];
    return joined;
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
    for (Triangle& triangle : m_triangles)
        triangle.m_mesh = 0;
    m_layout = makeBvhLayout(std::uint32_t(m_order.size()));
    m_nodes = makeBvhNodes(m_layout);
    refit();
}

void MeshProbe::refit()
{
    std::size_t ignored = 0;  // no triangle with an invalid vertex meets another
    refitOnHost(m_nodes, m_layout, m_order, m_triangles, m_positions.data(), m_positions.data(), {0.0f}, ignored);
}

void MeshProbe::move(const std::vector<float>& positions)
{
    m_positions = positions;
    m_closed = Closed::Unknown;
    refit();
}

float MeshProbe::mostMotion(const std::vector<float>& positions) const
{
    float most = 0;
    for (const Triangle& triangle : m_triangles)
        for (const std::uint32_t vertex : triangle.m_vertices)
            most = std::max(
                most, vec3Length(vec3Sub(vec3Load(positions.data(), vertex), vec3Load(m_positions.data(), vertex))));
    return most;
}

float MeshProbe::size() const
{
    if (m_nodes.empty()) return 0;
    const BvhNode& root = m_nodes[m_layout.root()];
    float size = 0;
    for (int axis = 0; axis < 3; ++axis)
        size = std::max(size, root.m_high[axis] - root.m_low[axis]);
    return size;
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
    std::vector<std::uint32_t> stack = {m_layout.root()};
    while (!stack.empty())
    {
        const BvhNode& node = m_nodes[stack.back()];
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

void MeshProbe::listMeeting(const Vec3 corners[3], std::vector<std::uint32_t>& triangles) const
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
        if (trianglePairTest(corners, other, -1.0f) == 0) return;
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

Vec3 MeshProbe::wayOutOfBox(const std::vector<Vec3>& points) const
{
    const BvhNode& root = m_nodes[m_layout.root()];
    Vec3 best = vec3(0, 1, 0);
    float least = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis)
    {
        float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();
        for (const Vec3& point : points)
        {
            if (!positionIsValid(point)) continue;
            low = std::min(low, at(point, axis));
            high = std::max(high, at(point, axis));
        }
        for (const float sign : {1.0f, -1.0f})
        {
            const float way = sign > 0 ? root.m_high[axis] - low : high - root.m_low[axis];
            if (!(way < least)) continue;
            least = way;
            best = vec3(0, 0, 0);
            at(best, axis) = sign;
        }
    }
    return best;
}

bool MeshProbe::isClosed()
{
    if (m_closed != Closed::Unknown) return m_closed == Closed::Yes;
    const std::vector<std::uint32_t> joined = joinedVertices(m_positions);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Triangle& triangle : m_triangles)
    {
        for (int i = 0; i < 3; ++i)
        {
            const std::uint32_t a = joined[triangle.m_vertices[i]], b = joined[triangle.m_vertices[(i + 1) % 3]];
            if (a != b) edges.emplace_back(std::min(a, b), std::max(a, b));
        }
    }
    std::sort(edges.begin(), edges.end());
    bool even = !edges.empty();
    for (std::size_t first = 0, next; even && first < edges.size(); first = next)
    {
        for (next = first; next < edges.size() && edges[next] == edges[first];)
            ++next;
        even = (next - first) % 2 == 0;
    }
    m_closed = even ? Closed::Yes : Closed::No;
    return even;
}

double MeshProbe::volume() const
{
    double sixfold = 0;
    const Vec3 origin = m_triangles.empty() ? vec3(0, 0, 0) : corner(0, 0);
    for (std::uint32_t t = 0; t < m_triangles.size(); ++t)
    {
        double p[3][3];
        for (int i = 0; i < 3; ++i)
            for (int axis = 0; axis < 3; ++axis)
                p[i][axis] = double(at(corner(t, i), axis)) - at(origin, axis);
        sixfold += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
                   p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
                   p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return sixfold / 6;
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
    const BvhNode& root = m_nodes[m_layout.root()];
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

Vec3 MeshProbe::nearest(Vec3 point) const
{
    Place place;
    if (!nearestWithin(point, std::numeric_limits<float>::infinity(), place)) return point;
    return trianglePoint(corner(place.m_triangle, 0), corner(place.m_triangle, 1), corner(place.m_triangle, 2),
                         place.m_weights);
}

bool MeshProbe::nearestWithin(Vec3 point, float distance, Place& place) const
{
    if (m_nodes.empty() || !positionIsValid(point)) return false;
    double least = double(distance) * distance;
    bool found = false;
    std::vector<std::uint32_t> stack = {m_layout.root()};
    while (!stack.empty())
    {
        const BvhNode& node = m_nodes[stack.back()];
        stack.pop_back();
        if (!(squaredDistanceToBox(node, point) < least)) continue;
        if (node.m_count == 0)
        {
            const std::uint32_t triangle = m_order[node.m_first];
            Vec3 p[3];
            for (int i = 0; i < 3; ++i)
                p[i] = vec3Sub(corner(triangle, i), point);
            const Vec3 weights = closestOnTriangle(vec3(0, 0, 0), p[0], p[1], p[2]);
            const Vec3 off = trianglePoint(p[0], p[1], p[2], weights);
            const double squared = double(off.x) * off.x + double(off.y) * off.y + double(off.z) * off.z;
            if (!(squared < least)) continue;
            least = squared;
            found = true;
            place = Place{triangle, weights, vec3Length(off)};
            continue;
        }
        // The nearer child is the last one pushed.
        const std::size_t first = stack.size();
        for (std::uint32_t child = 0; child < node.m_count; ++child)
            stack.push_back(node.m_first + child);
        std::sort(stack.begin() + std::ptrdiff_t(first), stack.end(),
                  [&](std::uint32_t a, std::uint32_t b)
                  { return squaredDistanceToBox(m_nodes[a], point) > squaredDistanceToBox(m_nodes[b], point); });
    }
    return found;
}

Vec3 MeshProbe::carriedWith(const Place& place, Vec3 point, const std::vector<float>& positions) const
{
    Vec3 before[3], after[3];
    for (int i = 0; i < 3; ++i)
    {
        before[i] = corner(place.m_triangle, i);
        after[i] = vec3Load(positions.data(), m_triangles[place.m_triangle].m_vertices[i]);
    }
    const Vec3 off = vec3Sub(point, trianglePoint(before[0], before[1], before[2], place.m_weights));
    const Vec3 carried = trianglePoint(after[0], after[1], after[2], place.m_weights);
    TriangleFrame from, to;
    if (!frameOf(before, from) || !frameOf(after, to)) return vec3Add(carried, off);
    Vec3 turned = vec3Scale(to.m_along, vec3Dot(from.m_along, off));
    turned = vec3AddScaled(turned, to.m_across, vec3Dot(from.m_across, off));
    return vec3AddScaled(vec3Add(carried, turned), to.m_normal, vec3Dot(from.m_normal, off));
}
}  // namespace drape
