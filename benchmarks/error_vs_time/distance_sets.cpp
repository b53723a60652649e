#include "benchmarks/error_vs_time/distance_sets.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/error_vs_time/round_to_float.h"
#include "scenes/random.h"

namespace drape::bench
{
namespace
{
constexpr double kPairThickness = 0.02;  // m
constexpr double kSize = 0.05;           // m, of features
constexpr double kBorder = 0.02;         // edges' closest points are so far inside, in parts of the edges

Vector3 randomDirection(Random& random)
{
    for (;;)
    {
        const double x = random.within(-1, 1), y = random.within(-1, 1), z = random.within(-1, 1);
        const Vector3 v = {x, y, z};
        if (length(v) > 0.1 && length(v) < 1) return normalized(v);
    }
}

Vector3 nearestOnSegment(const Vector3& p, const Vector3& a, const Vector3& b)
{
    const double square = dot(b - a, b - a);
    return a + (square > 0 ? std::min(std::max(dot(p - a, b - a) / square, 0.0), 1.0) : 0.0) * (b - a);
}

double randomDistance(Random& random)
{
    if (random.unit() < 0.5) return random.within(0, 2) * kPairThickness;
    const double off = std::pow(10.0, random.within(-8, -3));
    return kPairThickness * (random.unit() < 0.5 ? 1 - off : 1 + off);
}

// Makes the pair before rounding.
void placePair(std::uint32_t kind, const Vector3& origin, Random& random, Vector3 points[4])
{
    const Vector3 u = randomDirection(random), other = randomDirection(random);
    const Vector3 normal = normalized(cross(u, other)), v = normalized(cross(normal, u));
    const double distance = randomDistance(random);
    if (kind == DRAPE_EDGES)
    {
        const Vector3 along = normalized(u + random.within(0.2, 2) * v);
        const Vector3 middle = origin + distance * normal;
        points[0] = middle - random.within(0.1, 1) * kSize * along;
        points[1] = middle + random.within(0.1, 1) * kSize * along;
        points[2] = origin - random.within(0.1, 1) * kSize * u;
        points[3] = origin + random.within(0.1, 1) * kSize * u;
        return;
    }
    points[1] = origin;
    points[2] = origin + random.within(0.2, 1) * kSize * u;
    points[3] = origin + random.within(0.2, 1) * kSize * v + random.within(-0.5, 0.5) * kSize * u;
    // Aims at the face's middle, one of its edges or one of its corners.
    const double where = random.unit();
    if (where < 0.5)
        points[0] = (1.0 / 3) * (points[1] + points[2] + points[3]) + distance * normal;
    else if (where < 0.8)
        points[0] = points[1] + 0.4 * (points[2] - points[1]) + distance * normalized(normal - random.unit() * v);
    else
        points[0] = points[1] + distance * normalized(normal - random.unit() * (u + 2.0 * v));
}

// Returns false if the closest points of edges are too near to an end for a certain answer.
bool findTruth(DistancePair& pair, const Vector3 p[4])
{
    Vector3 offset;
    if (pair.m_kind == DRAPE_VERTEX_FACE)
        offset = p[0] - nearestOnTriangle(p[0], p + 1);
    else
    {
        const Vector3 e = p[1] - p[0], g = p[3] - p[2], d = p[2] - p[0], normal = cross(e, g);
        const double area = dot(normal, normal);
        const double s = dot(cross(d, g), normal) / area, t = dot(cross(d, e), normal) / area;
        if (!(std::min({s, 1 - s, t, 1 - t}) > kBorder)) return false;
        offset = offsetOfEdges(p);
    }
    pair.m_distance = length(offset);
    pair.m_direction = normalized(offset);
    pair.m_extent = 0;
    for (int i = 0; i < 4; ++i)
    {
        for (int axis = 0; axis < 3; ++axis)
            pair.m_extent = std::max(pair.m_extent, std::abs(p[i][axis] - p[pair.m_kind == DRAPE_EDGES ? 2 : 1][axis]));
    }
    return pair.m_distance > 0;
}

DistanceSet makeSet(const std::string& name, std::size_t count, double distance, std::uint32_t seed)
{
    Random random(seed);
    DistanceSet set;
    set.m_name = name;
    set.m_thickness = float(kPairThickness);
    while (set.m_pairs.size() < count)
    {
        DistancePair pair;
        pair.m_kind = set.m_pairs.size() % 2 ? DRAPE_EDGES : DRAPE_VERTEX_FACE;
        Vector3 meant[4], points[4];
        placePair(pair.m_kind, distance * randomDirection(random), random, meant);
        for (int i = 0; i < 4; ++i)
        {
            points[i] = {roundToFloat(meant[i].x), roundToFloat(meant[i].y), roundToFloat(meant[i].z)};
            for (int axis = 0; axis < 3; ++axis)
                pair.m_points[3 * i + axis] = float(points[i][axis]);
        }
        if (findTruth(pair, points)) set.m_pairs.push_back(pair);
    }
    return set;
}
}  // namespace

Vector3 nearestOnTriangle(const Vector3& p, const Vector3 corners[3])
{
    const Vector3 e = corners[1] - corners[0], g = corners[2] - corners[0], d = p - corners[0], normal = cross(e, g);
    const double area = dot(normal, normal);
    const double u = dot(cross(d, g), normal) / area, v = dot(cross(e, d), normal) / area;
    if (area > 0 && u >= 0 && v >= 0 && u + v <= 1) return corners[0] + u * e + v * g;
    Vector3 best = nearestOnSegment(p, corners[0], corners[1]);
    for (int i = 1; i < 3; ++i)
    {
        const Vector3 other = nearestOnSegment(p, corners[i], corners[(i + 1) % 3]);
        if (length(p - other) < length(p - best)) best = other;
    }
    return best;
}

Vector3 offsetOfEdges(const Vector3 p[4])
{
    const Vector3 normal = cross(p[1] - p[0], p[3] - p[2]);
    return (dot(p[0] - p[2], normal) / dot(normal, normal)) * normal;
}

std::vector<DistanceSet> makeDistanceSets(std::size_t pairs)
{
    return {makeSet("pairs at 1 m", pairs, 1, 81), makeSet("pairs at 100 m", pairs, 100, 82),
            makeSet("pairs at 10 km", pairs, 10000, 83)};
}
}  // namespace drape::bench
