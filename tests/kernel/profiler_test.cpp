// The profiler returns one time per launch, in order, and none unless it is requested.
#include "bullet_plugin/core/device/profiler.h"

#include <gtest/gtest.h>

#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/cases.h"
#include "tests/support/pipeline_driver.h"

namespace drape::test
{
class ProfilerTest : public BackendTest
{
};

TEST_P(ProfilerTest, AStepsLaunchesAreTimed)
{
    Settings settings = GetParam().m_settings;
    settings.m_profileKernels = true;
    const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
    ASSERT_TRUE(pipeline);
    pipeline->takeKernelTimes();  // discards those of the warm-up
    const StepCase step = drapedCase("sphere", 9, 0.02f, 3);
    SCOPED_TRACE(step.trace());
    runCase(*pipeline, step);
    const std::vector<KernelTime> times = pipeline->takeKernelTimes();
    std::size_t culls = 0;
    double before = 0;
    for (const KernelTime& launch : times)
    {
        if (launch.m_kernel.compare(0, 9, "patchCull") == 0) ++culls;  // on a GPU patchCullPairs
        EXPECT_GE(launch.m_ms, 0.0) << launch.m_kernel;
        EXPECT_GE(launch.m_startMs, before) << launch.m_kernel;
        before = launch.m_startMs;
    }
    EXPECT_GT(totalMs(times), 0.0);
    EXPECT_EQ(culls, 1u);
    EXPECT_TRUE(pipeline->takeKernelTimes().empty());
}

TEST_P(ProfilerTest, NothingIsTimedUnasked)
{
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    runCase(*pipeline, drapedCase("sphere", 9, 0.02f, 3));
    EXPECT_TRUE(pipeline->takeKernelTimes().empty());
}

INSTANTIATE_TEST_SUITE_P(Devices, ProfilerTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
