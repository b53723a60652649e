// Triangles that intersect or come within a radius: nothing within is denied, nothing farther than the rounding allows
// is reported, wherever the pair lies.
#include "kernels/lib/queries/triangle_pair.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/cases.h"
#include "tests/support/random_pair.h"

namespace drape::test
{
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
}  // namespace drape::test
