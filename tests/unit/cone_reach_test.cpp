// The reach of contacts whose directions lie in a cone, along the volumes' directions.
#include "kernels/lib/broad_phase/cone_reach.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/random.h"

namespace drape::test
{
namespace
{
constexpr std::uint32_t kSeed = 1300;

Vec3 randomUnit(Random& random)
{
    for (;;)
    {
        const Vec3 v = vec3(float(random.within(-1, 1)), float(random.within(-1, 1)), float(random.within(-1, 1)));
        const float length = vec3Length(v);
        if (length > 0.1f && length <= 1.0f) return vec3Scale(v, 1.0f / length);
    }
}

// Returns a direction at the angle to the axis whose cosine is given.
Vec3 turned(Vec3 axis, float cosine, Random& random)
{
    Vec3 across = vec3Cross(axis, randomUnit(random));
    while (vec3Length(across) < 0.1f)
        across = vec3Cross(axis, randomUnit(random));
    return vec3Add(vec3Scale(axis, cosine), vec3Scale(across, sineOf(cosine) / vec3Length(across)));
}
}  // namespace

TEST(ConeReach, BoundsEveryDirectionOfTheCone)
{
    Random random(kSeed);
    for (int trial = 0; trial < 20000; ++trial)
    {
        const NormalCone cone = normalCone(randomUnit(random), float(random.within(0.01f, 1)));
        const Vec3 direction = turned(cone.m_axis, float(random.within(cone.m_cosine, 1)), random);
        for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
            ASSERT_LE(std::fabs(dopProject(direction, i)), coneReach(cone, i))
                << "seed " << kSeed << ", trial " << trial;
    }
}

TEST(ConeReach, IsHardlyMoreThanItMustBe)
{
    const float cosine = std::cos(0.2f);
    const NormalCone cone = normalCone(vec3(0, 0, 1), cosine);
    EXPECT_EQ(coneReach(cone, 2), 1.0f);
    EXPECT_NEAR(coneReach(cone, 0), std::sin(0.2f), 2 * DRAPE_CONE_PAD);
    EXPECT_EQ(coneReach(normalCone(vec3(0, 0, 1), -1), 0), 1.0f);
}

TEST(ConeReach, ConeAroundAnotherHoldsIt)
{
    Random random(kSeed + 1);
    int bounded = 0;
    for (int trial = 0; trial < 20000; ++trial)
    {
        const NormalCone inner = normalCone(randomUnit(random), float(random.within(0.3f, 1)));
        const Vec3 axis = turned(inner.m_axis, float(random.within(0.5f, 1)), random);
        const float cosine = cosineAround(axis, inner);
        if (!(cosine > 0)) continue;
        ++bounded;
        const Vec3 direction = turned(inner.m_axis, float(random.within(inner.m_cosine, 1)), random);
        ASSERT_GE(std::fabs(vec3Dot(axis, direction)), cosine - DRAPE_CONE_PAD)
            << "seed " << kSeed << ", trial " << trial;
    }
    EXPECT_GT(bounded, 5000);
}
}  // namespace drape::test
