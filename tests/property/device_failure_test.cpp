// A device whose kernels do not build: at the start, if it was not requested, and between steps. The host continues
// with the same contacts, and status, report and error say so to the end.
#include <gtest/gtest.h>

#include "drape/queries.h"
#include "tests/support/backends.h"
#include "tests/support/environment.h"
#include "tests/support/own_process.h"

namespace drape::test
{
namespace
{
// PoCL adds these to every build, and none of our kernels is valid C with them. It remembers a failed build for as long
// as the process lives, so that each test has one of its own.
constexpr const char* kBuildFlags = "POCL_EXTRA_BUILD_FLAGS";
constexpr const char* kBroken = "-Dvec3Sub=@";

constexpr std::int32_t kTriangle[3] = {0, 1, 2};
constexpr float kAbove[9] = {0, 0.05f, 0, 0, 0.05f, 1, 1, 0.05f, 0}, kBelow[9] = {0, 0, 0, 0, 0, 1, 1, 0, 0};

MeshDescription triangle(const float* positions, float selfThickness = 0)
{
    MeshDescription mesh;
    mesh.m_triangles = kTriangle;
    mesh.m_triangleCount = 1;
    mesh.m_positions = positions;
    mesh.m_vertexCount = 3;
    mesh.m_selfThickness = selfThickness;
    return mesh;
}

std::size_t contactsOfStep(Pipeline& pipeline, MeshId cloth, MeshId obstacle)
{
    pipeline.copyNodes({cloth}, kAbove, kAbove);
    pipeline.addPair(cloth, obstacle, 0.1f);
    pipeline.submit();
    return pipeline.finish().size();
}

class DeviceFailureTest : public BackendTest
{
protected:
    void SetUp() override
    {
        BackendTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        const DeviceInfo info = listDevices()[std::size_t(GetParam().m_device)];
        if (info.m_platform != "Portable Computing Language")
            GTEST_SKIP() << info.m_platform << ": only PoCL can be told to fail";
        m_settings = GetParam().m_settings;
        m_settings.m_cacheFolder = "none";
        m_settings.m_crossover = 0;
        m_name = info.m_name;
    }

    void expectHostGoesOn(const Pipeline& pipeline)
    {
        const DeviceReport& report = pipeline.deviceReport();
        EXPECT_TRUE(report.m_onHost);
        EXPECT_FALSE(report.m_byCost);
        EXPECT_EQ(report.m_device.m_name, "host");
        EXPECT_EQ(report.m_reason.find("the host, since " + m_name + " failed: "), 0u) << report.m_reason;
        EXPECT_NE(pipeline.lastError().text().find(".cl"), std::string::npos) << pipeline.lastError().text();
    }
    void expectStepsOnHost(Pipeline& pipeline, MeshId cloth, MeshId obstacle, std::size_t contacts)
    {
        for (int step = 0; step < 3; ++step)
        {
            EXPECT_EQ(contactsOfStep(pipeline, cloth, obstacle), contacts);
            EXPECT_TRUE(pipeline.statistics().m_onHost);
            EXPECT_EQ(pipeline.statistics().m_status, std::uint32_t(kStepDeviceFailed)) << "step " << step;
        }
    }

    Settings m_settings;
    std::string m_name;
};
}  // namespace

TEST_P(DeviceFailureTest, ADeviceThatFailsBetweenStepsIsLeftForGood)
{
    inOwnProcess(
        [&]
        {
            const std::unique_ptr<Pipeline> pipeline = makePipeline(m_settings);
            ASSERT_TRUE(pipeline);
            const MeshId cloth = pipeline->addCloth(triangle(kAbove)),
                         obstacle = pipeline->addObstacle(triangle(kBelow));
            const std::size_t contacts = contactsOfStep(*pipeline, cloth, obstacle);
            EXPECT_GT(contacts, 0u);
            EXPECT_FALSE(pipeline->statistics().m_onHost);
            EXPECT_EQ(pipeline->statistics().m_status, std::uint32_t(kStepGood));
            {
                const ScopedVariable broken(kBuildFlags, kBroken);
                pipeline->addCloth(triangle(kAbove, 0.02f));  // needs kernels that are not there yet
            }
            expectHostGoesOn(*pipeline);
            expectStepsOnHost(*pipeline, cloth, obstacle, contacts);
            pipeline->addObstacle(triangle(kBelow));
            expectStepsOnHost(*pipeline, cloth, obstacle, contacts);
            expectHostGoesOn(*pipeline);
        });
}

TEST_P(DeviceFailureTest, OneThatWasAskedForIsAnErrorWithTheLog)
{
    inOwnProcess(
        [&]
        {
            const ScopedVariable broken(kBuildFlags, kBroken);
            Error error;
            EXPECT_FALSE(Pipeline::create(m_settings, error));
            EXPECT_NE(error.text().find(".cl"), std::string::npos) << error.text();
        });
}

TEST_P(DeviceFailureTest, OneThatNobodyAskedForLeavesTheHost)
{
    if (GetParam().m_device != 0) GTEST_SKIP() << "not the device that would be chosen";
    inOwnProcess(
        [&]
        {
            const ScopedVariable unnamed("DRAPE_DEVICE", nullptr), broken(kBuildFlags, kBroken);
            m_settings.m_backend = Backend::ByCost;
            m_settings.m_device.clear();
            Error error;
            const std::unique_ptr<Pipeline> pipeline = Pipeline::create(m_settings, error);
            ASSERT_TRUE(pipeline) << error.text();
            EXPECT_FALSE(error.failed());
            pipeline->endStart();
            expectHostGoesOn(*pipeline);
            const MeshId cloth = pipeline->addCloth(triangle(kAbove)),
                         obstacle = pipeline->addObstacle(triangle(kBelow));
            expectStepsOnHost(*pipeline, cloth, obstacle, 3);
            expectHostGoesOn(*pipeline);
        });
}

TEST_P(DeviceFailureTest, QueriesGoOnOnTheHostLikewise)
{
    if (GetParam().m_device != 0) GTEST_SKIP() << "not the device that would be chosen";
    inOwnProcess(
        [&]
        {
            const ScopedVariable unnamed("DRAPE_DEVICE", nullptr), broken(kBuildFlags, kBroken);
            Error error;
            EXPECT_FALSE(Queries::create(m_settings, error));
            EXPECT_NE(error.text().find(".cl"), std::string::npos) << error.text();
            m_settings.m_backend = Backend::ByCost;
            m_settings.m_device.clear();
            const std::unique_ptr<Queries> queries = Queries::create(m_settings, error);
            ASSERT_TRUE(queries) << error.text();
            EXPECT_FALSE(error.failed());
            EXPECT_TRUE(queries->deviceReport().m_onHost);
            EXPECT_EQ(queries->deviceReport().m_reason.find("the host, since " + m_name + " failed: "), 0u);
            EXPECT_NE(queries->error().text().find(".cl"), std::string::npos) << queries->error().text();
            MeshPairs pairs;
            const MeshDescription above = triangle(kAbove), below = triangle(kBelow);
            EXPECT_TRUE(queries->meshPairs(above, &below, 0.1f, pairs));
            EXPECT_EQ(pairs.m_withinCount, 1u);
        });
}

INSTANTIATE_TEST_SUITE_P(Devices, DeviceFailureTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
