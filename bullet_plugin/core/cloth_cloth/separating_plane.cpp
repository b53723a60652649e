#include "separating_plane.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace drape
{
namespace
{
// Bound on the rounding of normal . (point - origin), as a share of the sum of the absolute products: three products,
// two sums and three differences, each less than 2^-53 off. Twice the sum of these.
constexpr double kRounding = 16 * 1.1102230246251565e-16;
// Share of the free way that a shortened path uses, so that its rounded end stays clear.
constexpr double kUsedShare = 0.9;

Vec3d along(Vec3d a, Vec3d b, double t)
{
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

// The position of a point along a normal, and a bound on its rounding.
struct Height
{
    double m_value, m_error;
};

Height heightOf(Vec3d normal, Vec3d origin, Vec3d p)
{
    const Vec3d d = p - origin;
    const double size = std::fabs(normal.x * d.x) + std::fabs(normal.y * d.y) + std::fabs(normal.z * d.z);
    return {dot(normal, d), kRounding * size};
}

double clampShare(double t)
{
    return t > 0 ? std::min(t, 1.0) : 0.0;
}

// Returns the offset from the nearest point of a segment to p.
Vec3d offsetFromSegment(Vec3d p, Vec3d a, Vec3d b)
{
    const Vec3d edge = b - a;
    const double length2 = dot(edge, edge);
    return p - along(a, b, length2 > 0 ? clampShare(dot(p - a, edge) / length2) : 0);
}

Vec3d shorter(Vec3d a, Vec3d b)
{
    return dot(b, b) < dot(a, a) ? b : a;
}

Vec3d offsetFromFace(Vec3d p, const Vec3d f[3])
{
    const Vec3d normal = cross(f[1] - f[0], f[2] - f[0]);
    const double area2 = dot(normal, normal);
    bool inside = area2 > 0;
    for (int i = 0; i < 3; ++i)
        inside = inside && dot(cross(f[(i + 1) % 3] - f[i], p - f[i]), normal) >= 0;
    if (inside)
    {
        const double height = dot(p - f[0], normal) / area2;
        return {height * normal.x, height * normal.y, height * normal.z};
    }
    return shorter(shorter(offsetFromSegment(p, f[0], f[1]), offsetFromSegment(p, f[1], f[2])),
                   offsetFromSegment(p, f[2], f[0]));
}

// Returns the offset between the nearest points of two segments, from the second to the first.
Vec3d offsetOfSegments(const Vec3d p[2], const Vec3d q[2])
{
    const Vec3d u = p[1] - p[0], v = q[1] - q[0], w = p[0] - q[0];
    const double a = dot(u, u), b = dot(u, v), c = dot(v, v), d = dot(u, w), e = dot(v, w);
    const double area2 = a * c - b * b;
    Vec3d best = offsetFromSegment(p[0], q[0], q[1]);
    best = shorter(best, offsetFromSegment(p[1], q[0], q[1]));
    for (int i = 0; i < 2; ++i)
    {
        const Vec3d offset = offsetFromSegment(q[i], p[0], p[1]);
        best = shorter(best, {-offset.x, -offset.y, -offset.z});
    }
    if (!(area2 > 0)) return best;
    const double s = (b * e - c * d) / area2, t = (a * e - b * d) / area2;
    return s > 0 && s < 1 && t > 0 && t < 1 ? shorter(best, along(p[0], p[1], s) - along(q[0], q[1], t)) : best;
}

Vec3d offsetOf(const Vec3d nodes[4], int split)
{
    return split == 1 ? offsetFromFace(nodes[0], nodes + 1) : offsetOfSegments(nodes, nodes + 2);
}

// The heights of a pair's nodes along a normal.
struct Sides
{
    Vec3d m_normal;
    Height m_start[4], m_end[4];
    double m_lowest, m_highest;  // certain bounds of the first feature's start, and of the second's
    double m_low, m_high;        // bounds of the plane that held nodes leave

    double gap() const { return m_lowest - m_highest; }
};

Sides sidesOf(const FeaturePaths& paths, Vec3d normal)
{
    Sides sides = {normal, {}, {}, HUGE_VAL, -HUGE_VAL, 0, 0};
    for (int i = 0; i < 4; ++i)
    {
        sides.m_start[i] = heightOf(normal, paths.m_start[3], paths.m_start[i]);
        sides.m_end[i] = heightOf(normal, paths.m_start[3], paths.m_end[i]);
        const Height& start = sides.m_start[i];
        if (i < paths.m_split)
            sides.m_lowest = std::min(sides.m_lowest, start.m_value - start.m_error);
        else
            sides.m_highest = std::max(sides.m_highest, start.m_value + start.m_error);
    }
    sides.m_low = sides.m_highest;
    sides.m_high = sides.m_lowest;
    for (int i = 0; i < 4; ++i)
    {
        const Height& end = sides.m_end[i];
        if (!paths.m_isHeld[i]) continue;
        if (i < paths.m_split)
            sides.m_high = std::min(sides.m_high, end.m_value - end.m_error);
        else
            sides.m_low = std::max(sides.m_low, end.m_value + end.m_error);
    }
    return sides;
}

// Returns how far apart the features surely end along the normal, m.
double endGap(const Sides& sides, int split)
{
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (int i = 0; i < 4; ++i)
    {
        const Height& end = sides.m_end[i];
        if (i < split)
            lowest = std::min(lowest, end.m_value - end.m_error);
        else
            highest = std::max(highest, end.m_value + end.m_error);
    }
    return lowest - highest;
}

// Normals to try, in this order: between the nearest points at the start and at the end, across both features.
std::array<Vec3d, 4> normalsFor(const FeaturePaths& paths)
{
    const Vec3d* p = paths.m_start;
    const Vec3d across = paths.m_split == 1 ? cross(p[2] - p[1], p[3] - p[1]) : cross(p[1] - p[0], p[3] - p[2]);
    const Vec3d normal = unit(across);
    return {unit(offsetOf(paths.m_start, paths.m_split)),
            unit(offsetOf(paths.m_end, paths.m_split)),
            normal,
            {-normal.x, -normal.y, -normal.z}};
}

// Returns how fast a side's free nodes approach the other, m in the step.
double approachOf(const Sides& sides, const FeaturePaths& paths, bool first)
{
    double most = 0;
    for (int i = first ? 0 : paths.m_split; i < (first ? paths.m_split : 4); ++i)
    {
        const double rise = sides.m_end[i].m_value - sides.m_start[i].m_value;
        most = std::max(most, first ? -rise : rise);
    }
    return most;
}
}  // namespace

double separationOf(const FeaturePaths& paths)
{
    double most = 0;
    for (const Vec3d& normal : normalsFor(paths))
        most = std::max(most, sidesOf(paths, normal).gap());
    return most / (1 + kRounding);  // the normal's length
}

bool stayApart(const FeaturePaths& paths, double clearance)
{
    for (const Vec3d& normal : normalsFor(paths))
    {
        const Sides sides = sidesOf(paths, normal);
        if (sides.gap() > 0 && endGap(sides, paths.m_split) >= std::min(2 * clearance, sides.gap())) return true;
    }
    return false;
}

SeparatingPlane separatingPlane(const FeaturePaths& paths, double clearance)
{
    Sides best = {};
    bool found = false, leaves = false;
    for (const Vec3d& normal : normalsFor(paths))
    {
        const Sides sides = sidesOf(paths, normal);
        if (!(sides.gap() > 0)) continue;
        const bool leavesHeld = sides.m_high > sides.m_low;
        if (found && (leaves || !leavesHeld)) continue;
        best = sides;
        found = true;
        leaves = leavesHeld;
        if (leaves) break;
    }
    SeparatingPlane plane = {best.m_normal, paths.m_start[3], 0, {}, found, leaves};
    if (!found) return plane;
    const double low = leaves ? best.m_low : best.m_highest, high = leaves ? best.m_high : best.m_lowest;
    // The room between both clearances is divided as the sides approach.
    const double kept = std::min(clearance, 0.5 * (high - low)), room = high - low - 2 * kept;
    const double down = approachOf(best, paths, true), up = approachOf(best, paths, false);
    const double share = up + down > 0 && std::isfinite(up + down) ? up / (up + down) : 0.5;
    plane.m_offset = low + kept + room * share;
    for (int i = 0; i < 4; ++i)
    {
        const double sign = i < paths.m_split ? 1 : -1;
        const double start = sign * (best.m_start[i].m_value - plane.m_offset) - best.m_start[i].m_error;
        plane.m_clear[i] = std::min(clearance, start);
    }
    return plane;
}

double lackingDistance(const SeparatingPlane& plane, const FeaturePaths& paths, int node, Vec3d position)
{
    const Height height = heightOf(plane.m_normal, plane.m_origin, position);
    const double sign = node < paths.m_split ? 1 : -1;
    return std::max(0.0, plane.m_clear[node] - (sign * (height.m_value - plane.m_offset) - height.m_error));
}

bool staysClear(const SeparatingPlane& plane, const FeaturePaths& paths, int node, Vec3d position)
{
    return lackingDistance(plane, paths, node, position) == 0;
}

double clearShare(const SeparatingPlane& plane, const FeaturePaths& paths, int node)
{
    if (staysClear(plane, paths, node, paths.m_end[node])) return 1;
    const double sign = node < paths.m_split ? 1 : -1;
    const Height start = heightOf(plane.m_normal, plane.m_origin, paths.m_start[node]);
    const Height end = heightOf(plane.m_normal, plane.m_origin, paths.m_end[node]);
    const double free = sign * (start.m_value - plane.m_offset) - start.m_error - plane.m_clear[node];
    const double approach = sign * (start.m_value - end.m_value) + start.m_error + end.m_error;
    if (!(approach > 0) || !(free > 0)) return 0;
    return kUsedShare * clampShare(free / approach);
}
}  // namespace drape
