// Triangles with corners that are NaN, infinite or too far out.
#include <gtest/gtest.h>

#include <limits>

#include "kernels/lib/geometry/finite_corners.h"

namespace drape::test
{
// Tests every subset of invalid corners, at the start or the end, by each coordinate.
TEST(FiniteCorners, ValidFeaturesAndStandIns)
{
    const float kBad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e10f};
    for (unsigned bad = 0; bad < 8; ++bad)
    {
        for (int variant = 0; variant < 18; ++variant)
        {
            Vec3 start[3] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}, end[3] = {{11, 12, 13}, {14, 15, 16}, {17, 18, 19}};
            const Vec3 startBefore[3] = {start[0], start[1], start[2]};
            for (unsigned i = 0; i < 3; ++i)
            {
                if (!(bad & 1u << i)) continue;
                Vec3& corner = variant % 2 ? start[i] : end[i];
                (variant / 2 % 3 == 0 ? corner.x : variant / 2 % 3 == 1 ? corner.y : corner.z) = kBad[variant / 6];
            }
            const std::uint32_t valid = replaceInvalidCorners(start, end);
            for (unsigned i = 0; i < 3; ++i)
            {
                const bool good = !(bad & 1u << i), nextGood = !(bad & 1u << (i + 1) % 3);
                EXPECT_EQ((valid & DRAPE_OWNS_VERTEX(i)) != 0, good);
                EXPECT_EQ((valid & DRAPE_OWNS_EDGE(i)) != 0, good && nextGood);
                EXPECT_TRUE(!good || std::memcmp(&start[i], &startBefore[i], sizeof start[i]) == 0);
                if (bad == 7) continue;
                EXPECT_TRUE(positionIsValid(start[i]) && positionIsValid(end[i]));
                EXPECT_EQ(end[i].x - start[i].x, 10.0f) << "both of the same corner";
            }
        }
    }
}

TEST(FiniteCorners, FarOutIsNotTooFarOut)
{
    Vec3 start[3] = {{1e9f, 1e9f, 0}, {-1e9f, 0, DRAPE_FARTHEST}, {-1e9f, 1, 2}};
    Vec3 end[3] = {start[0], start[1], start[2]};
    EXPECT_EQ(replaceInvalidCorners(start, end), DRAPE_ALL_FEATURES);
    EXPECT_EQ(start[2].y, 1.0f);
}
}  // namespace drape::test
