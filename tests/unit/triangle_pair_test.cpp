// Triangles that intersect or come within a radius: nothing within is denied, nothing farther than the rounding allows
// is reported, wherever the pair lies. And Möller's test, which is right where the tolerance does not matter.
#include "kernels/lib/triangle_pair.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/cases.h"
#include "tests/support/oracle.h"

namespace drape::test
{
namespace
{
struct Pair
{
    Vec3 m_a[3], m_b[3];

    double distance() const
    {
        Vector3 p[3], q[3];
        for (int i = 0; i < 3; ++i)
        {
            p[i] = {m_a[i].x, m_a[i].y, m_a[i].z};
            q[i] = {m_b[i].x, m_b[i].y, m_b[i].z};
        }
        return triangleDistance(p, q);
    }
};

// Makes two triangles of a size around an offset, the second shifted.
Pair randomPair(Random& random, float size, float offset, float shift)
{
    Pair pair;
    for (int i = 0; i < 3; ++i)
    {
        pair.m_a[i] = vec3(offset + size * random.uniform(-1, 1), offset + size * random.uniform(-1, 1),
                           size * random.uniform(-1, 1));
        pair.m_b[i] = vec3(offset + size * random.uniform(-1, 1), offset + size * random.uniform(-1, 1),
                           shift + size * random.uniform(-1, 1));
    }
    return pair;
}
}  // namespace

TEST(TrianglePair, ReportsEveryPairWithinTheRoundedRadius)
{
    Random random(93);
    for (float offset : {0.0f, 100.0f})
    {
        for (float size : {1.0f, 1e-2f})
        {
            SCOPED_TRACE("seed 93, offset " + std::to_string(offset) + ", size " + std::to_string(size));
            int near = 0, judged = 0;
            for (int i = 0; i < 4000; ++i)
            {
                const Pair pair = randomPair(random, size, offset, 2 * size);
                const double distance = pair.distance();
                const float radius = float(distance) * random.uniform(0.5f, 1.5f);
                const bool found = (trianglePairTest(pair.m_a, pair.m_b, radius) & DRAPE_PAIR_NEAR) != 0;
                // A pair is kept unnecessarily only within 6.6e-5 of the extent, which is at most 6 sizes.
                ASSERT_TRUE(found || distance > radius) << i;
                ASSERT_TRUE(!found || distance <= radius + 4e-4 * size) << i;
                near += found;
                ++judged;
            }
            EXPECT_GT(near, judged * 3 / 10);
            EXPECT_LT(near, judged * 8 / 10);
        }
    }
}

TEST(TrianglePair, TheRadiusCountsToTheLastBit)
{
    // The faces are parallel at a gap that the radius meets exactly, exceeds by a bit, or misses by one in ten
    // thousand.
    for (float gap : {1.0f, 0.01f, 3e-5f})
    {
        const Vec3 a[3] = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
        const Vec3 b[3] = {vec3(0.2f, 0.2f, gap), vec3(1.2f, 0.2f, gap), vec3(0.2f, 1.2f, gap)};
        EXPECT_EQ(trianglePairTest(a, b, gap), DRAPE_PAIR_NEAR);
        EXPECT_EQ(trianglePairTest(a, b, std::nextafter(gap, 2.0f)), DRAPE_PAIR_NEAR);
        EXPECT_EQ(trianglePairTest(a, b, gap * 0.9999f - 7e-5f), 0u);
    }
}

TEST(TrianglePair, UnitsOfLengthThatArePowersOfTwoChangeNothing)
{
    Random random(94);
    int meets = 0;
    for (int i = 0; i < 1000; ++i)
    {
        const Pair pair = randomPair(random, 1, 0, 0.5f);
        const float radius = random.uniform(0, 0.4f);
        const std::uint32_t bits = trianglePairTest(pair.m_a, pair.m_b, radius);
        meets += (bits & DRAPE_PAIR_MEETS) != 0;
        for (int exponent : {-90, -20, 20, 100, 120})
        {
            const float scale = std::ldexp(1.0f, exponent);
            Pair other;
            for (int k = 0; k < 3; ++k)
            {
                other.m_a[k] = vec3Scale(pair.m_a[k], scale);
                other.m_b[k] = vec3Scale(pair.m_b[k], scale);
            }
            ASSERT_EQ(trianglePairTest(other.m_a, other.m_b, radius * scale), bits)
                << "seed 94, case " << i << ", 2^" << exponent;
        }
    }
    EXPECT_GT(meets, 100);
}

TEST(TrianglePair, BadNumbersAreNoHit)
{
    Pair pair;
    for (int i = 0; i < 3; ++i)
        pair.m_a[i] = pair.m_b[i] = vec3(float(i), float(i * i), 1);
    EXPECT_EQ(trianglePairTest(pair.m_a, pair.m_b, 0), DRAPE_PAIR_MEETS | DRAPE_PAIR_NEAR);
    EXPECT_EQ(trianglePairTest(pair.m_a, pair.m_b, -1), DRAPE_PAIR_MEETS);
    pair.m_b[1].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(trianglePairTest(pair.m_a, pair.m_b, 1e30f), 0u);
}

TEST(Moller, IsRightWhereTheToleranceDoesNotMatter)
{
    Random random(95);
    int meets = 0, judged = 0;
    for (int i = 0; i < 4000; ++i)
    {
        const Pair pair = randomPair(random, 1, 0, 0.3f);
        const FeatureTriangle a = {{pair.m_a[0], pair.m_a[1], pair.m_a[2]}};
        const FeatureTriangle b = {{pair.m_b[0], pair.m_b[1], pair.m_b[2]}};
        const double distance = pair.distance();
        if (distance > 0 && distance < 1e-2) continue;
        const float barely = 1e-3f;
        // A triangle shrunk towards its middle that still meets does not barely touch.
        Pair small = pair;
        const Vec3 middle = vec3Scale(vec3Add(vec3Add(pair.m_a[0], pair.m_a[1]), pair.m_a[2]), 1.0f / 3.0f);
        for (Vec3& p : small.m_a)
            p = vec3Mix(p, middle, barely);
        if (distance == 0 && small.distance() > 0) continue;
        ++judged;
        meets += distance == 0;
        ASSERT_EQ(mollerIntersect(a, b) != 0, distance == 0) << "seed 95, case " << i;
    }
    EXPECT_GT(meets, judged / 5);
    EXPECT_LT(meets, judged * 4 / 5);
}

TEST(Moller, ReportsLayersThatDoNotMeetAndTheCertifiedTestDoesNot)
{
    Random random(96);
    int moller = 0;
    for (int i = 0; i < 1000; ++i)
    {
        // The triangles have 1 cm and lie in layers 1 mm apart.
        Pair pair = randomPair(random, 0.01f, 0, 0);
        for (int k = 0; k < 3; ++k)
        {
            pair.m_a[k].z = 0;
            pair.m_b[k].z = 0.001f;
        }
        const FeatureTriangle a = {{pair.m_a[0], pair.m_a[1], pair.m_a[2]}};
        const FeatureTriangle b = {{pair.m_b[0], pair.m_b[1], pair.m_b[2]}};
        moller += mollerIntersect(a, b);
        ASSERT_EQ(trianglePairTest(pair.m_a, pair.m_b, -1), 0u) << "seed 96, case " << i;
    }
    EXPECT_GT(moller, 200) << "the absolute tolerance no longer shows: say so where it is documented";
}
}  // namespace drape::test
