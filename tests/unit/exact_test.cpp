// Exact answers about triangles: against rational arithmetic of another hand, on inputs where doubles do not decide.
#include "bullet_plugin/core/exact/triangles.h"

#include <gtest/gtest.h>

#include "bullet_plugin/core/exact/expansion.h"
#include "oracle/exact_predicates.h"
#include "tests/support/cases.h"
#include "tests/support/oracle.h"

namespace drape::test
{
namespace
{
Vector3 asVector(const ExactPoint& p)
{
    return {p[0], p[1], p[2]};
}

ExactPoint asPoint(float x, float y, float z)
{
    return {x, y, z};
}

bool meetByOracle(const ExactTriangle& a, const ExactTriangle& b)
{
    const Vector3 p[3] = {asVector(a.m_p[0]), asVector(a.m_p[1]), asVector(a.m_p[2])};
    const Vector3 q[3] = {asVector(b.m_p[0]), asVector(b.m_p[1]), asVector(b.m_p[2])};
    return drape::trianglesIntersect(p, q);
}

// Corners on a grid of 0 … size - 1, times a step: coplanar, touching and degenerate triangles abound.
ExactTriangle gridTriangle(Random& random, std::uint32_t size, float step)
{
    float corners[9];
    for (float& c : corners)
        c = step * float(random.below(size));
    return exactTriangle(corners);
}
}  // namespace

TEST(Exact, ExpansionsDoNotRound)
{
    const Expansion tiny = Expansion::difference(std::ldexp(1.0, -149), 0);
    const Expansion large = Expansion::difference(std::ldexp(1.0, 127), 0);
    const Expansion sum = large * large * large + tiny * tiny * tiny;
    EXPECT_EQ((sum - large * large * large).sign(), 1);
    EXPECT_EQ((large * large * large - sum).sign(), -1);
    EXPECT_EQ((sum - sum).sign(), 0);
    EXPECT_EQ(Expansion().sign(), 0);
    // (a + b)(a - b) = a² - b²
    const Expansion a = Expansion::difference(1e30, -1e-3), b = Expansion::difference(7e-20, 3e10);
    EXPECT_EQ(((a + b) * (a - b) - (a * a - b * b)).sign(), 0);
}

TEST(Exact, OrientationOfPointsNearlyInAPlaneIsExact)
{
    Random random(90);
    int zero = 0, filtered = 0;
    for (int i = 0; i < 20000; ++i)
    {
        // The point is on the plane through three points, to the last bit of a float, or off it by that bit.
        ExactPoint p[4];
        for (int k = 0; k < 3; ++k)
            p[k] = asPoint(random.uniform(-1, 1) + 100, random.uniform(-1, 1), random.uniform(-1, 1));
        const double u = random.uniform(-1, 2), v = random.uniform(-1, 2);
        for (int axis = 0; axis < 3; ++axis)
            p[3][axis] = i % 4 == 0 ? p[i / 4 % 3][axis]
                                    : double(float((1 - u - v) * p[0][axis] + u * p[1][axis] + v * p[2][axis]));
        const int sign = orientation3(p[0], p[1], p[2], p[3]);
        const int truth = orientation(asVector(p[0]), asVector(p[1]), asVector(p[2]), asVector(p[3]));
        ASSERT_EQ(sign, truth) << "seed 90, case " << i;
        ASSERT_EQ(orientation3(p[1], p[0], p[2], p[3]), -sign) << "seed 90, case " << i;
        zero += sign == 0;
        filtered += sign != 0;
    }
    EXPECT_GT(zero, 4000);
    EXPECT_GT(filtered, 10000);
}

TEST(Exact, TriangleIntersectionsEqualRationalArithmetic)
{
    Random random(91);
    for (std::uint32_t size : {2u, 3u, 5u})
    {
        for (float step : {1.0f, 0.01f, 1e-20f})
        {
            int meet = 0;
            const int cases = 6000;
            for (int i = 0; i < cases; ++i)
            {
                const ExactTriangle a = gridTriangle(random, size, step), b = gridTriangle(random, size, step);
                const bool found = trianglesMeet(a, b);
                ASSERT_EQ(found, meetByOracle(a, b)) << "seed 91, size " << size << ", step " << step << ", case " << i;
                ASSERT_EQ(found, trianglesMeet(b, a)) << "seed 91, case " << i;
                meet += found;
            }
            EXPECT_GT(meet, cases / 10);
            EXPECT_LT(meet, cases);
        }
    }
}

TEST(Exact, DistancesEqualBruteForce)
{
    Random random(92);
    int apart = 0;
    for (int i = 0; i < 4000; ++i)
    {
        float corners[18];
        for (float& c : corners)
            c = random.uniform(-1, 1);
        const ExactTriangle a = exactTriangle(corners), b = exactTriangle(corners + 9);
        if (trianglesMeet(a, b)) continue;
        ++apart;
        const Vector3 p[3] = {asVector(a.m_p[0]), asVector(a.m_p[1]), asVector(a.m_p[2])};
        const Vector3 q[3] = {asVector(b.m_p[0]), asVector(b.m_p[1]), asVector(b.m_p[2])};
        ASSERT_NEAR(std::sqrt(squaredDistance(a, b)), triangleDistance(p, q), 1e-12) << "seed 92, case " << i;
    }
    EXPECT_GT(apart, 1000);
}

TEST(Exact, DistancesOfTrianglesWithoutAreaAreExact)
{
    const float point[9] = {1, 2, 3, 1, 2, 3, 1, 2, 3}, segment[9] = {1, 2, 5, 3, 2, 5, 2, 2, 5};
    const float face[9] = {0, 0, 1, 4, 0, 1, 0, 8, 1};
    EXPECT_DOUBLE_EQ(squaredDistance(exactTriangle(point), exactTriangle(segment)), 4);
    EXPECT_DOUBLE_EQ(squaredDistance(exactTriangle(point), exactTriangle(face)), 4);
    EXPECT_DOUBLE_EQ(squaredDistance(exactTriangle(segment), exactTriangle(face)), 16);
}
}  // namespace drape::test
