// Volumes of packets, a lane at a time: as those of single triangles, never smaller.
#include "kernels/lib/cull_packet.h"

#include <gtest/gtest.h>

#include "tests/support/cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr float kRadius = 0.03f;  // m

struct Counts
{
    int m_volumes = 0, m_near = 0, m_unswept = 0;
};

// Of valid triangles.
void expectSameVolume(const StepCase& step, const Triangle& triangle, std::uint32_t mode, const ObstacleMotion* motion,
                      Counts& counts)
{
    CullVolume single;
    const int mayComeNear =
        cullVolume(&single, motion, &triangle, step.m_cloth.m_positions.data(), step.m_end.data(), kRadius, mode);
    Vec3 corners[6];
    LanesVec3 lanes[6];
    cornersSeen(corners, motion, &triangle, step.m_cloth.m_positions.data(), step.m_end.data());
    for (int k = 0; k < 6; ++k)
        lanes[k] = lanesVec3(corners[k].x, corners[k].y, corners[k].z);
    CullVolumes packet;
    EXPECT_EQ(cullVolumes(&packet, lanes, kRadius, 1, mode, motion), mayComeNear);
    ++counts.m_volumes;
    if (!mayComeNear) return;
    ++counts.m_near;
    counts.m_unswept += !isSwept(corners, kRadius, mode);
    EXPECT_EQ(packet.m_radius, single.m_radius);
    EXPECT_NEAR(packet.m_least, single.m_least, 1e-6f);
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        EXPECT_LE(packet.m_low[i], single.m_volume.m_low[i]);
        EXPECT_GE(packet.m_high[i], single.m_volume.m_high[i]);
        EXPECT_NEAR(packet.m_low[i], single.m_volume.m_low[i], 5e-6f);
        EXPECT_NEAR(packet.m_high[i], single.m_volume.m_high[i], 5e-6f);
    }
}
}  // namespace

TEST(CullPacket, VolumesAreThoseOfSingleTriangles)
{
    // A turn by a right angle and a shift, of an obstacle in one half of the cloth.
    const ObstacleMotion motion = {{0, -1, 0, 0.02f, 1, 0, 0, -0.01f, 0, 0, 1, 0.005f}, {-2, -2, -2}, {0, 2, 2}, 0};
    Counts counts;
    for (const bool moving : {false, true})
    {
        const StepCase steps[] = {soupCase(200, 1, moving, 600), needleCase(Thin::Cloth, 200, 1.0f, moving, 601),
                                  fallingCase("sphere", 17, kRadius, 602)};
        for (const StepCase& step : steps)
        {
            SCOPED_TRACE(step.trace());
            for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
            {
                const Side cloth = makeSide({step.m_cloth});
                for (const Triangle& triangle : cloth.m_pool.triangles())
                {
                    for (const ObstacleMotion* seen : {static_cast<const ObstacleMotion*>(nullptr), &motion})
                        expectSameVolume(step, triangle, mode, seen, counts);
                }
            }
        }
    }
    EXPECT_GT(counts.m_near, counts.m_volumes / 2);
    EXPECT_LT(counts.m_near, counts.m_volumes * 9 / 10);
    EXPECT_GT(counts.m_unswept, counts.m_near / 5);
}

// What is not in the step is near nothing, wherever it is.
TEST(CullPacket, NegativeRadiusIsEmpty)
{
    LanesVec3 corners[6] = {};
    CullVolumes packet;
    EXPECT_EQ(cullVolumes(&packet, corners, -1.0f, 1, DRAPE_AUTOMATIC, nullptr), 0);
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        EXPECT_EQ(packet.m_low[i], DRAPE_INFINITY);
        EXPECT_EQ(packet.m_high[i], -DRAPE_INFINITY);
    }
}
}  // namespace drape::test
