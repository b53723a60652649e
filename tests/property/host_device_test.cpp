// Host and device give the same contacts, bit for bit, over random sequences of steps in which meshes come, go and
// move.
#include <gtest/gtest.h>

#include "tests/support/backends.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/live_scene.h"
#include "tests/support/side.h"

namespace drape::test
{
class HostDeviceTest : public BackendTest
{
protected:
    std::unique_ptr<Pipeline> m_host, m_device;

    bool makeBoth(bool intersections = false)
    {
        Settings host = allBackends()[0].m_settings, device = GetParam().m_settings;
        host.m_reportIntersections = device.m_reportIntersections = intersections;
        m_host = makePipeline(host);
        m_device = makePipeline(device);
        return m_host && m_device;
    }
};

TEST_P(HostDeviceTest, RandomSequences)
{
    std::size_t contacts = 0, quiet = 0;
    for (std::uint32_t seed = 800; seed < 804; ++seed)
    {
        ASSERT_TRUE(makeBoth());
        LiveScene scene({m_host.get(), m_device.get()}, seed);
        for (int step = 0; step < 60; ++step)
        {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
            scene.nextStep();
            const std::vector<Contact> host = runStep(*m_host), device = runStep(*m_device);
            ASSERT_TRUE(sameBytes(device, host)) << difference(device, host);
            EXPECT_EQ(m_device->statistics().m_status, m_host->statistics().m_status) << m_device->lastError().text();
            contacts += host.size();
            quiet += host.empty();
        }
    }
    EXPECT_GT(contacts, 10000u);
    EXPECT_LT(quiet, 200u);
    EXPECT_FALSE(m_device->deviceReport().m_onHost);
}

TEST_P(HostDeviceTest, LargeStepGrowsBuffersAndAgrees)
{
    ASSERT_TRUE(makeBoth(true));
    const StepCase step = soupCase(3000, 3000, true, 810);
    SCOPED_TRACE(step.trace());
    const std::vector<Contact> host = runCase(*m_host, step), device = runCase(*m_device, step);
    EXPECT_GT(m_device->statistics().m_retries, 0u);
    EXPECT_EQ(m_host->statistics().m_intersections, m_device->statistics().m_intersections);
    EXPECT_GT(m_host->statistics().m_intersections, 100u);
    EXPECT_TRUE(sameBytes(device, host)) << difference(device, host);
    EXPECT_GT(host.size(), 10000u);
}

// Two runs of the same on one device: the order of its work-items leaves no trace.
TEST_P(HostDeviceTest, RunsRepeat)
{
    const StepCase step = fallingCase("terrain", 33, 0.03f, 820);
    SCOPED_TRACE(step.trace());
    std::vector<Contact> first;
    for (int run = 0; run < 5; ++run)
    {
        const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
        ASSERT_TRUE(pipeline);
        const std::vector<Contact> contacts = runCase(*pipeline, step);
        if (run == 0) first = contacts;
        ASSERT_TRUE(sameBytes(contacts, first)) << difference(contacts, first);
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, HostDeviceTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
