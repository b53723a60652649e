// kernels/lib/geometry/morton.h: codes interleave, keep order, and exist for odd input.
#include "kernels/lib/geometry/morton.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/cases.h"

namespace drape::test
{
TEST(Morton, InterleavesTenBitsAnAxis)
{
    const Vec3 low = vec3(0, 0, 0), high = vec3(1024, 1024, 1024);
    for (std::uint32_t bit = 0; bit < 10; ++bit)
    {
        const float value = float(1u << bit);
        EXPECT_EQ(mortonCode(vec3(value, 0, 0), low, high), 1u << (3 * bit));
        EXPECT_EQ(mortonCode(vec3(0, value, 0), low, high), 2u << (3 * bit));
        EXPECT_EQ(mortonCode(vec3(0, 0, value), low, high), 4u << (3 * bit));
    }
    EXPECT_EQ(mortonCode(high, low, high), (1u << 30) - 1);
}

TEST(Morton, IsMonotonicAlongAnAxis)
{
    const Vec3 low = vec3(-3, -1, 5), high = vec3(2, 4, 6);
    Random random(5);
    for (int i = 0; i < 1000; ++i)
    {
        const float a = random.uniform(-3, 2), b = random.uniform(-3, 2);
        const std::uint32_t least = mortonCode(vec3(std::min(a, b), 0, 5.5f), low, high);
        ASSERT_LE(least, mortonCode(vec3(std::max(a, b), 0, 5.5f), low, high)) << "seed 5: " << a << ' ' << b;
    }
}

TEST(Morton, OddInputGivesACode)
{
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const Vec3 flat = vec3(1, 1, 1);
    EXPECT_EQ(mortonCode(flat, flat, flat), 0u) << "all points equal";
    EXPECT_EQ(mortonCode(vec3(nan, nan, nan), vec3(0, 0, 0), flat), 0u);
    EXPECT_EQ(mortonCode(flat, vec3(infinity, infinity, infinity), vec3(-infinity, -infinity, -infinity)), 0u);
    EXPECT_LT(mortonCode(vec3(9, -9, infinity), vec3(0, 0, 0), flat), 1u << 30) << "outside the box";
    EXPECT_LT(mortonCode(flat, vec3(-3e38f, -3e38f, -3e38f), vec3(3e38f, 3e38f, 3e38f)), 1u << 30)
        << "the extent overflows";
}
}  // namespace drape::test
