// Jobs that threads share: every item once, whatever the sizes, and the caller told of failures.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bullet_plugin/core/threads/thread_team.h"

namespace drape::test
{
namespace
{
class ThreadTeamTest : public testing::TestWithParam<unsigned>
{
};

void expectEachOnce(ThreadTeam& team, std::size_t count)
{
    std::vector<std::atomic<int>> calls(count);
    team.run(count, [&](std::size_t item) { ++calls[item]; });
    for (std::size_t item = 0; item < count; ++item)
        ASSERT_EQ(calls[item], 1) << "item " << item << " of " << count;
}
}  // namespace

TEST_P(ThreadTeamTest, RunsEachItemOnce)
{
    ThreadTeam team(GetParam());
    EXPECT_EQ(team.size(), GetParam());
    for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 8u, 9u, 1000u, 10007u})
        ASSERT_NO_FATAL_FAILURE(expectEachOnce(team, count));
}

// Threads that still look for the items of one job while the next one is offered.
TEST_P(ThreadTeamTest, KeepsJobsApart)
{
    ThreadTeam team(GetParam());
    std::size_t wanted = 0;
    std::atomic<std::size_t> sum{0};
    for (std::size_t job = 0; job < 20000; ++job)
    {
        const std::size_t count = job % 6;
        team.run(count, [&sum, job](std::size_t item) { sum += job * 10 + item; });
        for (std::size_t item = 0; item < count; ++item)
            wanted += job * 10 + item;
        ASSERT_EQ(sum, wanted) << "job " << job;
    }
}

TEST_P(ThreadTeamTest, WakesThreadsThatSleep)
{
    ThreadTeam team(GetParam());
    for (int i = 0; i < 20; ++i)
    {
        std::this_thread::sleep_for(std::chrono::microseconds(5 * ThreadTeam::kAwakeMicroseconds));
        ASSERT_NO_FATAL_FAILURE(expectEachOnce(team, 64));
    }
}

// Results of a job are visible to the caller and to the threads that run the next job.
TEST_P(ThreadTeamTest, ResultsOfJobsAreVisibleToAllThreads)
{
    ThreadTeam team(GetParam());
    constexpr std::size_t kItems = 97;
    std::vector<std::size_t> values(kItems, 0), next(kItems, 0);
    for (std::size_t job = 0; job < 2000; ++job)
    {
        team.run(kItems, [&](std::size_t i) { next[i] = values[(i + 1) % kItems] + 1; });
        values.swap(next);
    }
    for (const std::size_t value : values)
        ASSERT_EQ(value, 2000u);
}

TEST_P(ThreadTeamTest, ReportsFailuresToTheCaller)
{
    ThreadTeam team(GetParam());
    for (int i = 0; i < 100; ++i)
    {
        const auto job = [](std::size_t item)
        {
            if (item == 11) throw std::runtime_error("item 11");
        };
        try
        {
            team.run(32, job);
            FAIL() << "nothing was thrown";
        }
        catch (const std::runtime_error& error)
        {
            EXPECT_STREQ(error.what(), "item 11");
        }
        ASSERT_NO_FATAL_FAILURE(expectEachOnce(team, 32));
    }
}

TEST_P(ThreadTeamTest, SurvivesFailuresOfManyItems)
{
    ThreadTeam team(GetParam());
    for (int i = 0; i < 100; ++i)
    {
        EXPECT_THROW(team.run(64, [](std::size_t) { throw std::runtime_error("each"); }), std::runtime_error);
        ASSERT_NO_FATAL_FAILURE(expectEachOnce(team, 32));
    }
}

// Items round as the caller does, whoever runs them and whatever the caller did before.
TEST_P(ThreadTeamTest, ThreadsRoundLikeTheCaller)
{
    ThreadTeam team(GetParam());
    for (const int mode : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TONEAREST})
    {
        std::fesetround(mode);
        std::vector<int> modes(256, -1);
        for (int i = 0; i < 20; ++i)
        {
            team.run(modes.size(), [&](std::size_t item) { modes[item] = std::fegetround(); });
            EXPECT_EQ(std::count(modes.begin(), modes.end(), mode), static_cast<std::ptrdiff_t>(modes.size()));
        }
    }
}

// The default number of threads is the number of cores, within a limit.
TEST(ThreadTeam, HasADefaultSize)
{
    const ThreadTeam team(0);
    EXPECT_GE(team.size(), 1u);
    EXPECT_LE(team.size(), ThreadTeam::kMostByDefault);
}

INSTANTIATE_TEST_SUITE_P(Sizes, ThreadTeamTest, testing::Values(1u, 2u, 3u, 16u),
                         [](const auto& size) { return std::to_string(size.param); });
}  // namespace drape::test
