// kernels/lib/geometry/closest.h against the double oracle, on random and degenerate features.
#include "kernels/lib/geometry/closest.h"

#include <gtest/gtest.h>

#include "tests/support/cases.h"
#include "tests/support/oracle.h"

namespace drape::test
{
namespace
{
// A float closest point errs by some units of the extent; the distance between two such points by as much. 32 u.
constexpr double kDistanceError = 2e-6;

Vec3 randomPoint(Random& random)
{
    return vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}
Vector3 wide(Vec3 p)
{
    return {p.x, p.y, p.z};
}

double distanceByWeights(Vec3 p, const Vec3* corners, Vec3 weights)
{
    return length(wide(p) - (double(weights.x) * wide(corners[0]) + double(weights.y) * wide(corners[1]) +
                             double(weights.z) * wide(corners[2])));
}
}  // namespace

TEST(Closest, PointAndTriangleAgreeWithTheOracle)
{
    constexpr std::uint32_t kSeed = 1;
    Random random(kSeed);
    int inside = 0;
    for (int i = 0; i < 20000; ++i)
    {
        SCOPED_TRACE("seed 1, case " + std::to_string(i));
        const Vec3 corners[3] = {randomPoint(random), randomPoint(random), randomPoint(random)};
        const Vec3 p = vec3Scale(randomPoint(random), i % 2 ? 1.0f : 0.3f);
        const Vec3 weights = closestOnTriangle(p, corners[0], corners[1], corners[2]);
        const Vector3 wideCorners[3] = {wide(corners[0]), wide(corners[1]), wide(corners[2])};
        const NearestOnTriangle nearest = nearestOnTriangle(wide(p), wideCorners);
        ASSERT_NEAR(weights.x + weights.y + weights.z, 1.0f, 1e-6f);
        ASSERT_GE(drapeMin(drapeMin(weights.x, weights.y), weights.z), 0.0f);
        // Thin triangles lose digits in the quotient, not in the nearness: the point stays on the triangle.
        ASSERT_NEAR(distanceByWeights(p, corners, weights), nearest.m_distance, 50 * kDistanceError);
        inside += weights.x > 0 && weights.y > 0 && weights.z > 0;
    }
    EXPECT_GT(inside, 20000 * 0.1);
    EXPECT_LT(inside, 20000 * 0.7);
}

TEST(Closest, ZeroWeightsTellTheFeature)
{
    const Vec3 a = vec3(0, 0, 0), b = vec3(1, 0, 0), c = vec3(0, 1, 0);
    const struct
    {
        Vec3 m_point;
        Vec3 m_weights;
    } cases[] = {{vec3(0.25f, 0.25f, 3), vec3(0.5f, 0.25f, 0.25f)},
                 {vec3(-1, -1, 1), vec3(1, 0, 0)},
                 {vec3(3, -1, 0), vec3(0, 1, 0)},
                 {vec3(-1, 3, 0), vec3(0, 0, 1)},
                 {vec3(0.5f, -1, 0), vec3(0.5f, 0.5f, 0)},
                 {vec3(-1, 0.5f, 0), vec3(0.5f, 0, 0.5f)},
                 {vec3(1, 1, -2), vec3(0, 0.5f, 0.5f)}};
    for (const auto& one : cases)
    {
        const Vec3 weights = closestOnTriangle(one.m_point, a, b, c);
        EXPECT_EQ(weights.x, one.m_weights.x);
        EXPECT_EQ(weights.y, one.m_weights.y);
        EXPECT_EQ(weights.z, one.m_weights.z);
    }
}

TEST(Closest, TriangleWithoutAreaActsAsSegmentOrPoint)
{
    const Vec3 p = vec3(0.5f, 1, 0);
    const Vec3 segment[3] = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(2, 0, 0)};
    const Vec3 point[3] = {vec3(1, 0, 0), vec3(1, 0, 0), vec3(1, 0, 0)};
    const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& order : orders)
    {
        const Vec3 corners[3] = {segment[order[0]], segment[order[1]], segment[order[2]]};
        const Vec3 weights = closestOnTriangle(p, corners[0], corners[1], corners[2]);
        ASSERT_TRUE(vec3IsFinite(weights));
        EXPECT_NEAR(distanceByWeights(p, corners, weights), 1.0, 1e-6);
    }
    const Vec3 weights = closestOnTriangle(p, point[0], point[1], point[2]);
    ASSERT_TRUE(vec3IsFinite(weights));
    EXPECT_NEAR(distanceByWeights(p, point, weights), std::sqrt(1.25), 1e-6);
}

TEST(Closest, SegmentsAgreeWithTheOracle)
{
    constexpr std::uint32_t kSeed = 2;
    Random random(kSeed);
    int inside = 0;
    for (int i = 0; i < 20000; ++i)
    {
        SCOPED_TRACE("seed 2, case " + std::to_string(i));
        const Vec3 a = randomPoint(random), b = randomPoint(random), c = randomPoint(random), d = randomPoint(random);
        float s, t;
        closestOnSegments(a, b, c, d, &s, &t);
        ASSERT_TRUE(s >= 0 && s <= 1 && t >= 0 && t <= 1);
        const NearestOnSegments nearest = nearestOnSegments(wide(a), wide(b), wide(c), wide(d));
        const double found =
            length((wide(a) + double(s) * (wide(b) - wide(a))) - (wide(c) + double(t) * (wide(d) - wide(c))));
        // Nearly parallel edges: the parameters slide along the edges, the distance hardly grows.
        const double sine = length(cross(wide(b) - wide(a), wide(d) - wide(c))) /
                            (length(wide(b) - wide(a)) * length(wide(d) - wide(c)));
        ASSERT_NEAR(found, nearest.m_distance, kDistanceError * (1 + 1 / std::max(sine, 1e-3)));
        inside += s > 0 && s < 1 && t > 0 && t < 1;
    }
    EXPECT_GT(inside, 20000 * 0.1);
    EXPECT_LT(inside, 20000 * 0.7);
}

TEST(Closest, DegenerateSegments)
{
    const Vec3 o = vec3(0, 0, 0), x = vec3(1, 0, 0), above = vec3(0.5f, 2, 0), beside = vec3(2, 0, 0);
    float s = -1, t = -1;
    closestOnSegments(above, above, o, x, &s, &t);  // a point and a segment
    EXPECT_EQ(t, 0.5f);
    closestOnSegments(o, x, above, above, &s, &t);
    EXPECT_EQ(s, 0.5f);
    closestOnSegments(o, o, above, above, &s, &t);  // two points
    EXPECT_TRUE(s >= 0 && s <= 1 && t >= 0 && t <= 1);
    closestOnSegments(o, x, vec3(0, 1, 0), vec3(1, 1, 0), &s, &t);  // parallel and overlapping
    EXPECT_EQ(s, t);
    closestOnSegments(o, x, beside, vec3(3, 0, 0), &s, &t);  // collinear and apart
    EXPECT_EQ(s, 1.0f);
    EXPECT_EQ(t, 0.0f);
    closestOnSegments(o, x, vec3(0.5f, 0, 0), beside, &s, &t);  // collinear and overlapping
    EXPECT_NEAR(s, 0.5f + 1.5f * t, 1e-6f);
}
}  // namespace drape::test
