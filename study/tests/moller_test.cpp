// Möller's test of two triangles: right where its tolerance does not matter, and wrong where it does.
#include "study/kernels/lib/moller.h"

#include <gtest/gtest.h>

#include "kernels/lib/queries/triangle_pair.h"
#include "tests/support/cases.h"
#include "tests/support/random_pair.h"

namespace drape::test
{
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
        // Shrunk towards its middle, a triangle that still meets does not barely touch.
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
        // 1 cm triangles in layers 1 mm apart.
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
