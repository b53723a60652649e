#include "tests/support/oracle.h"

#include <algorithm>

#include "oracle/exact_predicates.h"

namespace drape::test
{
namespace
{
double nearestParameter(const Vector3& p, const Vector3& a, const Vector3& b)
{
    const Vector3 along = b - a;
    const double squared = dot(along, along);
    return squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
}

Vector3 mix(const Vector3& a, const Vector3& b, double t)
{
    return (1 - t) * a + t * b;
}

void improve(NearestOnSegments& best, const Vector3& first, const Vector3& second, double s, double t)
{
    const double distance = length(first - second);
    if (distance >= best.m_distance) return;
    best = {distance, s, t, first, second};
}
}  // namespace

Vector3 position(const std::vector<float>& positions, std::uint32_t vertex)
{
    const float* p = &positions[3 * std::size_t(vertex)];
    return {p[0], p[1], p[2]};
}

NearestOnTriangle nearestOnTriangle(const Vector3& p, const Vector3 corners[3])
{
    const Vector3 u = corners[1] - corners[0], v = corners[2] - corners[0], w = p - corners[0];
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
    const double determinant = uu * vv - uv * uv;
    if (determinant > 1e-24 * uu * vv)
    {
        double second = (wu * vv - wv * uv) / determinant, third = (wv * uu - wu * uv) / determinant;
        // The determinant of a thin triangle has lost digits. The remainder along its edges is solved for again.
        for (int round = 0; round < 3; ++round)
        {
            const Vector3 left = w - (second * u + third * v);
            const double leftU = dot(left, u), leftV = dot(left, v);
            second += (leftU * vv - leftV * uv) / determinant;
            third += (leftV * uu - leftU * uv) / determinant;
        }
        if (second > 0 && third > 0 && second + third < 1)
        {
            const Vector3 point = corners[0] + second * u + third * v;
            return {length(p - point), {1 - second - third, second, third}, point};
        }
    }
    NearestOnTriangle best = {1e300, {0, 0, 0}, {}};
    for (int i = 0; i < 3; ++i)
    {
        const int next = (i + 1) % 3;
        const double t = nearestParameter(p, corners[i], corners[next]);
        const Vector3 point = mix(corners[i], corners[next], t);
        if (length(p - point) >= best.m_distance) continue;
        best = {length(p - point), {0, 0, 0}, point};
        best.m_weights[i] = 1 - t;
        best.m_weights[next] = t;
    }
    return best;
}

NearestOnSegments nearestOnSegments(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d)
{
    NearestOnSegments best = {1e300, 0, 0, {}, {}};
    const Vector3 u = b - a, v = d - c, w = a - c;
    const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v);
    const Vector3 across = cross(u, v);
    if (dot(across, across) > 1e-24 * uu * vv)
    {
        const double determinant = dot(across, across);
        const double s = (uv * dot(v, w) - vv * dot(u, w)) / determinant;
        const double t = (uu * dot(v, w) - uv * dot(u, w)) / determinant;
        if (s > 0 && s < 1 && t > 0 && t < 1) improve(best, mix(a, b, s), mix(c, d, t), s, t);
    }
    for (int end = 0; end < 2; ++end)
    {
        const Vector3& first = end ? b : a;
        const double t = nearestParameter(first, c, d);
        improve(best, first, mix(c, d, t), end, t);
        const Vector3& second = end ? d : c;
        const double s = nearestParameter(second, a, b);
        improve(best, mix(a, b, s), second, s, end);
    }
    return best;
}

double triangleDistance(const Vector3 a[3], const Vector3 b[3])
{
    if (drape::trianglesIntersect(a, b)) return 0;
    double best = 1e300;
    for (int i = 0; i < 3; ++i)
    {
        best = std::min({best, nearestOnTriangle(a[i], b).m_distance, nearestOnTriangle(b[i], a).m_distance});
        for (int j = 0; j < 3; ++j)
        {
            best = std::min(best, nearestOnSegments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]).m_distance);
        }
    }
    return best;
}

bool DirectionCone::admits(const Vector3& direction) const
{
    return m_everything || std::fabs(dot(m_axis, direction)) >= m_cosine;
}

namespace
{
void finish(std::vector<DirectionCone>& cones)
{
    for (DirectionCone& cone : cones)
    {
        if (length(cone.m_axis) < 1e-12) cone.m_everything = true;
        cone.m_axis = normalized(cone.m_axis);
    }
}
}  // namespace

SurfaceCones surfaceCones(const std::vector<Triangle>& triangles, std::size_t edgeCount,
                          const std::vector<float>& positions)
{
    SurfaceCones cones;
    cones.m_vertices.resize(positions.size() / 3);
    cones.m_edges.resize(edgeCount);
    std::vector<int> uses(edgeCount, 0);
    for (int pass = 0; pass < 2; ++pass)
    {
        for (const Triangle& triangle : triangles)
        {
            const Vector3 a = position(positions, triangle.m_vertices[0]);
            const Vector3 normal = normalized(cross(position(positions, triangle.m_vertices[1]) - a,
                                                    position(positions, triangle.m_vertices[2]) - a));
            for (int i = 0; i < 3; ++i)
            {
                for (DirectionCone* cone :
                     {&cones.m_vertices[triangle.m_vertices[i]], &cones.m_edges[triangle.m_edges[i]]})
                {
                    if (pass == 0) cone->m_axis += normal;
                    cone->m_cosine = pass == 0 ? 1 : std::min(cone->m_cosine, dot(cone->m_axis, normal));
                    if (length(normal) == 0) cone->m_everything = true;
                }
                if (pass == 0) ++uses[triangle.m_edges[i]];
            }
        }
        if (pass == 0) finish(cones.m_vertices);
        if (pass == 0) finish(cones.m_edges);
    }
    for (const Triangle& triangle : triangles)
    {
        for (int i = 0; i < 3; ++i)
        {
            if (uses[triangle.m_edges[i]] == 2) continue;
            cones.m_edges[triangle.m_edges[i]].m_everything = true;
            cones.m_vertices[triangle.m_vertices[i]].m_everything = true;
            cones.m_vertices[triangle.m_vertices[(i + 1) % 3]].m_everything = true;
        }
    }
    return cones;
}
}  // namespace drape::test
