// The memory that a device's buffers hold, by name.
#include "bullet_plugin/core/device/memory_ledger.h"

#include <gtest/gtest.h>

#include "bullet_plugin/core/device/buffer.h"
#include "kernels/shared/contact.h"
#include "kernels/shared/mesh.h"
#include "scenes/draped_cloth.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/cases.h"
#include "tests/support/pipeline_driver.h"

namespace drape::test
{
namespace
{
std::size_t bytesOf(const std::vector<MemoryUse>& uses, const std::string& name)
{
    for (const MemoryUse& use : uses)
    {
        if (use.m_name == name) return use.m_bytes;
    }
    return 0;
}
}  // namespace

class MemoryLedgerTest : public BackendTest
{
};

TEST_P(MemoryLedgerTest, BuffersAreListedWhileTheyLive)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    {
        Buffer<float> one("fruit"), other("fruit");
        Buffer<double> third;
        one.reserve(*device, 10);
        other.reserve(*device, 3);
        third.reserve(*device, 2);
        EXPECT_EQ(bytesOf(device->memory().list(), "fruit"), 52u);
        EXPECT_EQ(bytesOf(device->memory().list(), "other"), 16u);
        one.reserve(*device, 100);  // grows: the smaller one is gone
        EXPECT_EQ(bytesOf(device->memory().list(), "fruit"), 412u);
        std::swap(one, other);
        other = Buffer<float>("fruit");
        EXPECT_EQ(bytesOf(device->memory().list(), "fruit"), 12u);
    }
    EXPECT_TRUE(device->memory().list().empty());
}

TEST_P(MemoryLedgerTest, APipelineNamesItsBuffers)
{
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    const StepCase step = drapedCase("sphere", 9, 0.02f, 3);
    SCOPED_TRACE(step.trace());
    runCase(*pipeline, step);
    const std::vector<MemoryUse> uses = pipeline->deviceMemory();
    EXPECT_EQ(bytesOf(uses, "cloth triangles"), step.m_cloth.triangleCount() * sizeof(Triangle));
    EXPECT_EQ(bytesOf(uses, "obstacle triangles"), step.m_obstacle.triangleCount() * sizeof(Triangle));
    EXPECT_GE(bytesOf(uses, "step contacts"), sizeof(Contact));
}

// Bounds the memory of a step per triangle: at most 400 bytes of a cloth and 250 of a resting obstacle. All memory that
// is not an obstacle's counts to the cloth, including buffers that still have their initial size.
TEST_P(MemoryLedgerTest, BytesATriangle)
{
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    const TriangleMesh obstacle = makeSphere(1.0f, 6);
    const HeightField field(obstacle);
    ClothPlace place;
    place.m_cells = 256;
    place.m_size = 2.4;
    place.m_gap = 0.007;
    const TriangleMesh cloth = drapeCloth(field, place);
    const MeshId clothId = addCloth(*pipeline, cloth), obstacleId = addObstacle(*pipeline, obstacle);
    for (int step = 0; step < 2; ++step)
    {
        setMotion(*pipeline, clothId, cloth.m_positions, cloth.m_positions);
        pipeline->addPair(clothId, obstacleId, 0.009f);
        EXPECT_GT(runStep(*pipeline).size(), 10000u);
        std::size_t ofCloth = 0, ofObstacle = 0;
        for (const MemoryUse& use : pipeline->deviceMemory())
            (use.m_name.rfind("obstacle", 0) == 0 ? ofObstacle : ofCloth) += use.m_bytes;
        EXPECT_LE(ofCloth, 400 * cloth.triangleCount());
        EXPECT_LE(ofObstacle, 250 * obstacle.triangleCount());
        EXPECT_EQ(bytesOf(pipeline->deviceMemory(), "sorting"), 0u);
        EXPECT_EQ(bytesOf(pipeline->deviceMemory(), "other"), 0u) << "every buffer has a name";
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, MemoryLedgerTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
