// Leaf order on a device: the host's bits, nothing written past the end, at sizes around the groups'.
#include "study/trees/morton_codes.h"

#include <gtest/gtest.h>

#include "bullet_plugin/core/scene/morton_order.h"
#include "scenes/shapes.h"
#include "study/kernel_programs.h"
#include "tests/support/cases.h"
#include "tests/support/device_side.h"
#include "tests/support/moving_soup.h"

namespace drape::test
{
namespace
{
// Around the work-groups and the sort's stretch of 512, and odd thousands.
const int kSizes[] = {1, 2, 3, 63, 64, 65, 127, 128, 129, 255, 257, 511, 512, 513, 1023, 3001, 20011};

std::vector<std::uint32_t> orderOnDevice(Device& device, MortonOrderStage& stage, const Side& side)
{
    const std::vector<Triangle>& triangles = side.m_pool.triangles();
    Buffer<Triangle> triangleBuffer;
    Buffer<float> positions;
    Buffer<cl_uint> order, high, low;
    guardCopy(device, triangleBuffer, triangles);
    guardCopy(device, positions, side.m_start);
    stage.enqueue(device, triangleBuffer, positions, cl_uint(triangles.size()), 30, WorkShape::Device, order, high,
                  low);
    return contents(device, order, triangles.size());
}
}  // namespace

class MortonOrderTest : public BackendTest
{
};

TEST_P(MortonOrderTest, LeafOrderSameAsTheHost)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    MortonOrderStage stage;
    stage.create(*device, studyPrograms(*device));
    for (bool spoiled : {false, true})
    {
        for (int size : kSizes)
        {
            SCOPED_TRACE("soup of " + std::to_string(size) + ", seed " + std::to_string(size));
            Random random{std::uint32_t(size)};
            Side side = makeMovingSoup(size, std::uint32_t(size));
            if (spoiled) spoil(side.m_start, random);
            const std::vector<Triangle>& triangles = side.m_pool.triangles();
            EXPECT_EQ(orderOnDevice(*device, stage, side), mortonOrderOnHost(triangles, side.m_start.data()));
        }
    }
    EXPECT_FALSE(device->failed()) << device->error().text();
}

TEST_P(MortonOrderTest, LeafOrderOfEqualCentroidsIsByNumber)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    MortonOrderStage stage;
    stage.create(*device, studyPrograms(*device));
    std::vector<float> corners;
    for (int i = 0; i < 1000; ++i)
        corners.insert(corners.end(), {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const Side side = makeSide({looseTriangles(corners)});
    const std::vector<std::uint32_t> order = orderOnDevice(*device, stage, side);
    ASSERT_EQ(order.size(), 1000u);
    for (std::uint32_t i = 0; i < 1000; ++i)
        ASSERT_EQ(order[i], i);
}

INSTANTIATE_TEST_SUITE_P(Devices, MortonOrderTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
