// Work on a thread of its own: its result, its failure, and its end with the owner or the process.
#include "bullet_plugin/core/device/background_work.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

namespace drape::test
{
namespace
{
// A job that runs until it is stopped.
void untilStopped(const StopFlag& stop)
{
    while (!*stop)
        std::this_thread::yield();
}
}  // namespace

TEST(BackgroundWork, TheResultIsVisibleOnceItIsDone)
{
    std::vector<int> result;
    StopFlag flag;
    {
        BackgroundWork work(
            [&](const StopFlag& stop)
            {
                flag = stop;
                result.assign(1000, 7);
            });
        while (!work.isDone())
            std::this_thread::yield();
        EXPECT_EQ(result, std::vector<int>(1000, 7));
        work.wait();
    }
    EXPECT_FALSE(*flag) << "what the job made would count as stopped";
}

TEST(BackgroundWork, EndsWithItsOwner)
{
    for (int i = 0; i < 100; ++i)
    {
        const BackgroundWork work(untilStopped);
        EXPECT_FALSE(work.isDone());
    }
}

TEST(BackgroundWork, EndsWithTheProcess)
{
    BackgroundWork one(untilStopped), two(untilStopped);
    BackgroundWork::stopAll();
    EXPECT_TRUE(one.isDone());
    EXPECT_TRUE(two.isDone());
    BackgroundWork::stopAll();
}

TEST(BackgroundWork, WaitThrowsWhatTheJobThrew)
{
    BackgroundWork work([](const StopFlag&) { throw std::runtime_error("failed"); });
    EXPECT_THROW(work.wait(), std::runtime_error);
    EXPECT_TRUE(work.isDone());
}
}  // namespace drape::test
