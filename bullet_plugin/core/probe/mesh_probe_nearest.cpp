// Finds the nearest points of a mesh's surface, and moves points along with it.
#include <algorithm>
#include <limits>

#include "axis.h"
#include "kernels/lib/geometry/closest.h"
#include "mesh_probe.h"

namespace drape
{
namespace
{
// Unit vectors along a triangle's first edge, across it and along its normal.
struct TriangleFrame
{
    Vec3 m_along, m_across, m_normal;
};

// Returns false if the triangle has no area.
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
}  // namespace

double MeshProbe::squaredDistance(const Node& node, Vec3 p)
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
    std::vector<std::uint32_t> stack = {m_root};
    while (!stack.empty())
    {
        const Node& node = m_nodes[stack.back()];
        stack.pop_back();
        if (!(squaredDistance(node, point) < least)) continue;
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
                  { return squaredDistance(m_nodes[a], point) > squaredDistance(m_nodes[b], point); });
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
    const Node& root = m_nodes[m_root];
    float size = 0;
    for (int axis = 0; axis < 3; ++axis)
        size = std::max(size, root.m_high[axis] - root.m_low[axis]);
    return size;
}

Vec3 MeshProbe::directionOutOfBox(const std::vector<Vec3>& points) const
{
    const Node& root = m_nodes[m_root];
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
            const float distance = sign > 0 ? root.m_high[axis] - low : high - root.m_low[axis];
            if (!(distance < least)) continue;
            least = distance;
            best = vec3(0, 0, 0);
            at(best, axis) = sign;
        }
    }
    return best;
}
}  // namespace drape
