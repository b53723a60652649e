#include "contour_push.h"

#include <algorithm>
#include <cmath>

#include "bullet_plugin/core/vec3d.h"

namespace drape
{
namespace
{
// Least sine of the angle between an edge and a triangle that it pierces. Beside flatter ones the edge would go far
// along itself.
constexpr double kLeastSine = 0.05;

// A triangle's nodes and their positions.
struct Face
{
    const std::uint32_t* m_nodes;
    Vec3d m_p[3];

    Face(const std::uint32_t* nodes, const float* positions) : m_nodes(nodes)
    {
        for (int k = 0; k < 3; ++k)
        {
            const float* const p = positions + 3 * std::size_t(nodes[k]);
            m_p[k] = {p[0], p[1], p[2]};
        }
    }
    Vec3d normal() const { return unit(cross(m_p[1] - m_p[0], m_p[2] - m_p[0])); }
};

// Returns whether a point of the triangle's plane is in it.
bool contains(const Face& face, Vec3d normal, Vec3d at)
{
    for (int k = 0; k < 3; ++k)
        if (dot(cross(face.m_p[(k + 1) % 3] - face.m_p[k], at - face.m_p[k]), normal) < 0) return false;
    return true;
}
}  // namespace

void ContourPush::compute(const std::vector<std::uint32_t>& pairs, const float* positions,
                          const std::vector<unsigned char>& isHeld, const std::vector<double>& most)
{
    m_displacements.clear();
    if (pairs.empty()) return;
    m_displacements.assign(3 * isHeld.size(), 0.0);
    const auto add = [&](std::uint32_t node, Vec3d by)
    {
        double* const sum = m_displacements.data() + 3 * std::size_t(node);
        sum[0] += by.x;
        sum[1] += by.y;
        sum[2] += by.z;
    };
    // Shortens the part of the curve that begins where an edge of one triangle pierces the other.
    const auto push = [&](const Face& own, const Face& other)
    {
        const Vec3d across = own.normal(), normal = other.normal();
        for (int k = 0; k < 3; ++k)
        {
            const Vec3d first = own.m_p[k], second = own.m_p[(k + 1) % 3], third = own.m_p[(k + 2) % 3];
            const double d0 = dot(first - other.m_p[0], normal), d1 = dot(second - other.m_p[0], normal);
            if (!(d0 * d1 < 0)) continue;
            const double share = d0 / (d0 - d1);
            const Vec3d at = first + share * (second - first), edge = unit(second - first);
            if (!contains(other, normal, at)) continue;
            Vec3d along = unit(cross(across, normal));
            if (dot(along, cross(cross(edge, third - first), edge)) < 0) along = -1.0 * along;
            const double sine = dot(edge, normal);
            const double steep = std::copysign(std::max(std::abs(sine), kLeastSine), sine);
            const Vec3d way = 0.5 * (along - (dot(edge, along) / steep) * normal);
            add(own.m_nodes[k], way);
            add(own.m_nodes[(k + 1) % 3], way);
            for (int corner = 0; corner < 3; ++corner)
                add(other.m_nodes[corner], -1.0 * way);
        }
    };
    for (std::size_t i = 0; i < pairs.size(); i += 6)
    {
        const Face first(pairs.data() + i, positions), second(pairs.data() + i + 3, positions);
        push(first, second);
        push(second, first);
    }
    for (std::size_t node = 0; node < isHeld.size(); ++node)
    {
        double* const way = m_displacements.data() + 3 * node;
        const double length = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
        const double scale = isHeld[node] ? 0 : most[node] / std::max(1.0, length);
        for (int axis = 0; axis < 3; ++axis)
            way[axis] *= scale;
    }
}
}  // namespace drape
