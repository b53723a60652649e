// Refit on a device: the host's bits, nothing written past the end, at sizes around the groups'.
#include "bullet_plugin/core/queries/refit.h"

#include <gtest/gtest.h>

#include "scenes/shapes.h"
#include "tests/support/cases.h"
#include "tests/support/device_side.h"
#include "tests/support/moving_soup.h"

namespace drape::test
{
namespace
{
// Around the work-groups of 64 and 128, and odd thousands.
const int kSizes[] = {1, 2, 3, 63, 64, 65, 127, 128, 129, 255, 257, 511, 512, 513, 1023, 3001, 20011};
}  // namespace

class RefitTest : public BackendTest
{
protected:
    void expectSameAsHost(Side& side, const std::vector<float>& radius)
    {
        const std::unique_ptr<Device> device = openDevice(GetParam());
        ASSERT_TRUE(device);
        RefitStage stage;
        stage.create(*device, programOf(*device, "queries/refit"));
        DeviceSide buffers;
        buffers.upload(*device, side);
        RefitStage::Levels levels;
        stage.makeLevels(*device, side.m_layout, levels);
        Buffer<float> meshRadius;
        guardCopy(*device, meshRadius, radius);
        Buffer<StepCounters> counters;
        clearCounters(*device, counters);
        stage.enqueue(*device, side.m_layout, levels, buffers.m_nodes, buffers.m_order, buffers.m_triangles,
                      buffers.m_start, buffers.m_end, meshRadius, counters);
        const std::size_t invalid = refitSide(side, radius);
        EXPECT_TRUE(sameBytes(contents(*device, buffers.m_nodes, side.m_nodes.size()), side.m_nodes));
        EXPECT_EQ(readCounters(*device, counters).m_invalidNodes, invalid);
        EXPECT_TRUE(buffers.allIntact(*device) && intact(*device, meshRadius) && intact(*device, counters));
        EXPECT_FALSE(device->failed()) << device->error().text();
    }
};

TEST_P(RefitTest, SameBitsAsTheHostAtEverySize)
{
    for (int size : kSizes)
    {
        SCOPED_TRACE("soup of " + std::to_string(size) + ", seed " + std::to_string(size));
        Side side = makeMovingSoup(size, std::uint32_t(size));
        expectSameAsHost(side, {0.013f});
    }
}

TEST_P(RefitTest, SeveralMeshesWithOneLeftOutAndInvalidNodes)
{
    Random random(9);
    SCOPED_TRACE("seed 9");
    Side side = makeSide({makeSoup(1, 0.1f, 300, 1), makeSphere(0.5f, 2), makeSoup(1, 0.1f, 77, 2)});
    disturb(side.m_end, 0.05f, random);
    spoil(side.m_start, random);
    spoil(side.m_end, random);
    expectSameAsHost(side, {0.01f, -1.0f, 0.03f});
}

TEST_P(RefitTest, NoLeavesLaunchNothing)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    RefitStage stage;
    stage.create(*device, programOf(*device, "queries/refit"));
    Side side = makeSide({});
    DeviceSide buffers;
    buffers.upload(*device, side);
    RefitStage::Levels levels;
    stage.makeLevels(*device, side.m_layout, levels);
    Buffer<float> radius;
    guard(*device, radius, 0);
    Buffer<StepCounters> counters;
    clearCounters(*device, counters);
    stage.enqueue(*device, side.m_layout, levels, buffers.m_nodes, buffers.m_order, buffers.m_triangles,
                  buffers.m_start, buffers.m_end, radius, counters);
    device->wait();
    EXPECT_TRUE(buffers.allIntact(*device));
    EXPECT_FALSE(device->failed()) << device->error().text();
}

INSTANTIATE_TEST_SUITE_P(Devices, RefitTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
