// Every back end gives identical contacts, bit for bit, over random sequences of steps in which meshes are added,
// removed and moved. The reference of sequences is the host back end on one thread. Single steps are also compared with
// the contacts of all pairs of triangles, which need no cull.
#include <gtest/gtest.h>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/live_scene.h"
#include "tests/support/self_cases.h"
#include "tests/support/side.h"

namespace drape::test
{
class HostDeviceTest : public BackendTest
{
protected:
    std::unique_ptr<Pipeline> m_host, m_device;

    bool isHost() const { return GetParam().m_settings.m_backend == Backend::Host; }

    bool makeBoth()
    {
        Settings host = allBackends()[0].m_settings, device = GetParam().m_settings;
        host.m_threads = 1;
        if (isHost()) device.m_threads = 4;
        m_host = makePipeline(host);
        m_device = makePipeline(device);
        return m_host && m_device;
    }

    // Expects the contacts of all pairs of triangles from a new pipeline.
    void expectAllPairs(const StepCase& step)
    {
        const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
        ASSERT_TRUE(pipeline);
        const std::vector<Contact> contacts = runCase(*pipeline, step);
        Side cloth = makeSide({step.m_cloth});
        const Side obstacle = makeSide({step.m_obstacle});
        cloth.m_end = step.m_end;
        const float reach = step.m_thickness * (1 + Settings().m_activation);
        const std::vector<Contact> expected = contactsOfAllPairs(cloth, obstacle, reach);
        EXPECT_TRUE(sameBytes(contacts, expected)) << difference(contacts, expected);
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
    EXPECT_EQ(m_device->deviceReport().m_onHost, isHost());
}

// The scene is small enough for a simulator of a device (tests/CMakeLists.txt). Each step runs twice, since a device
// may choose another method once it knows the amount of work.
TEST_P(HostDeviceTest, FewTriangles)
{
    ASSERT_TRUE(makeBoth());
    std::size_t swept = 0, contacts = 0;
    for (const StepCase& step : {soupCase(4, 24, true, 830), fallingCase("box", 3, 0.1f, 832)})
    {
        SCOPED_TRACE(step.trace());
        const auto run = [&](Pipeline& pipeline)
        {
            std::vector<std::vector<Contact>> steps;
            const MeshId cloth = addCloth(pipeline, step.m_cloth), obstacle = addObstacle(pipeline, step.m_obstacle);
            for (int i = 0; i < 2; ++i)
            {
                pipeline.copyNodes({cloth}, step.m_cloth.m_positions.data(), step.m_end.data());
                pipeline.addPair(cloth, obstacle, step.m_thickness);
                steps.push_back(runStep(pipeline));
            }
            return steps;
        };
        const std::vector<std::vector<Contact>> host = run(*m_host), device = run(*m_device);
        for (std::size_t i = 0; i < host.size(); ++i)
            EXPECT_TRUE(sameBytes(device[i], host[i])) << difference(device[i], host[i]);
        contacts += device.back().size();
        swept += m_device->statistics().m_sweptTests;
    }
    const SelfStepCase folded = foldedCase(4, 3, 0.1f, 833);
    const std::vector<Contact> host = runSelfCase(*m_host, folded), device = runSelfCase(*m_device, folded);
    EXPECT_TRUE(sameBytes(device, host)) << difference(device, host);
    EXPECT_GT(device.size(), 5u);
    EXPECT_GT(contacts, 10u);
    EXPECT_GT(swept, 10u);
    EXPECT_EQ(m_device->deviceReport().m_onHost, isHost());
    EXPECT_EQ(m_device->statistics().m_status, std::uint32_t(kStepGood)) << m_device->lastError().text();
}

TEST_P(HostDeviceTest, SingleStepsHaveTheContactsOfAllPairs)
{
    for (const StepCase& step : {soupCase(300, 300, true, 835), fallingCase("box", 9, 0.1f, 836)})
    {
        SCOPED_TRACE(step.trace());
        expectAllPairs(step);
    }
}

TEST_P(HostDeviceTest, LargeStepGrowsBuffersAndAgrees)
{
    ASSERT_TRUE(makeBoth());
    const StepCase step = soupCase(3000, 3000, true, 810);
    SCOPED_TRACE(step.trace());
    const std::vector<Contact> host = runCase(*m_host, step), device = runCase(*m_device, step);
    EXPECT_GT(m_device->statistics().m_retries, 0u);
    EXPECT_TRUE(sameBytes(device, host)) << difference(device, host);
    EXPECT_GT(host.size(), 10000u);
}

// Paths and faces a hundred thousand times as long as contacts reach, where rounding alone is farther than that.
TEST_P(HostDeviceTest, StepsFarLongerThanTheReach)
{
    ASSERT_TRUE(makeBoth());
    const TriangleMesh ball = makeSphere(0.005f, 4), cloth = makeClothGrid(13, 13, 0.012f, 0.0065f).m_mesh;
    for (const float way : {0.1f, 16.67f, 1000.0f})
    {
        for (const bool torn : {false, true})  // every third node stays near
        {
            SCOPED_TRACE(std::to_string(way) + (torn ? " m, torn" : " m"));
            StepCase step = {"long ways", 0, cloth, ball, cloth.m_positions, 1e-4f};
            for (std::size_t i = 1; i < step.m_end.size(); i += 3)
                step.m_end[i] -= torn && i % 9 == 1 ? 0.0012f : way;
            const std::vector<Contact> host = runCase(*m_host, step), device = runCase(*m_device, step);
            EXPECT_TRUE(sameBytes(device, host)) << difference(device, host);
            expectAllPairs(step);
            EXPECT_GT(host.size(), 500u);
            EXPECT_LT(m_device->statistics().m_candidates, 500000u) << "the cull holds";
        }
    }
}

// Two runs on one device are equal: the order of its work-items leaves no trace.
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
INSTANTIATE_TEST_SUITE_P(Host, HostDeviceTest, testing::Values(allBackends()[0]), backendName);
}  // namespace drape::test
