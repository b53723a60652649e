// Jobs that threads share: every item once, whatever the sizes, and the caller told of failures.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bullet_plugin/core/threads/shared_sort.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "tests/support/job_pool.h"

namespace drape::test
{
namespace
{
struct TeamCase
{
    unsigned m_size;
    bool m_ofApp;  // jobs run on a pool of the app's
};

class ThreadTeamTest : public testing::TestWithParam<TeamCase>
{
protected:
    JobPool m_pool{GetParam().m_ofApp ? 3u : 0u};
    ThreadTeam team{GetParam().m_size, GetParam().m_ofApp ? m_pool.function() : ParallelFor()};
};

void expectEachOnce(ThreadTeam& team, std::size_t count)
{
    std::vector<std::atomic<int>> calls(count);
    team.run(count, [&](std::size_t item) { ++calls[item]; });
    for (std::size_t item = 0; item < count; ++item)
        ASSERT_EQ(calls[item], 1) << "item " << item << " of " << count;
}
}  // namespace

TEST_P(ThreadTeamTest, SortsLikeOneThread)
{
    for (const std::size_t count : {0u, 1u, 1000u, 16384u, 100001u})
    {
        std::vector<unsigned> list(count);
        for (std::size_t i = 0; i < count; ++i)
            list[i] = unsigned(i * 2654435761u) % 50021u;
        std::vector<unsigned> sorted = list;
        std::sort(sorted.begin(), sorted.end());
        sharedSort(list, team, std::less<unsigned>());
        EXPECT_EQ(list, sorted) << count;
    }
}

TEST_P(ThreadTeamTest, RunsEachItemOnce)
{
    EXPECT_EQ(team.size(), GetParam().m_size);
    for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 8u, 9u, 1000u, 10007u})
        ASSERT_NO_FATAL_FAILURE(expectEachOnce(team, count));
    EXPECT_EQ(m_pool.calls() > 0, GetParam().m_ofApp && team.size() > 1) << "one thread works alone";
}

// Threads that still look for the items of one job while the next one is offered.
TEST_P(ThreadTeamTest, KeepsJobsApart)
{
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
    for (int i = 0; i < 20; ++i)
    {
        std::this_thread::sleep_for(std::chrono::microseconds(5 * ThreadTeam::kAwakeMicroseconds));
        ASSERT_NO_FATAL_FAILURE(expectEachOnce(team, 64));
    }
}

// Results of a job are visible to the caller and to the threads that run the next job.
TEST_P(ThreadTeamTest, ResultsOfJobsAreVisibleToAllThreads)
{
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
    for (int i = 0; i < 100; ++i)
    {
        EXPECT_THROW(team.run(64, [](std::size_t) { throw std::runtime_error("each"); }), std::runtime_error);
        ASSERT_NO_FATAL_FAILURE(expectEachOnce(team, 32));
    }
}

// Items round as the caller does, whoever runs them and whatever the caller did before.
TEST_P(ThreadTeamTest, ThreadsRoundLikeTheCaller)
{
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

// The caller does what a function of the app's leaves undone.
TEST(ThreadTeam, DoesTheJobsThatTheAppLeavesOut)
{
    const ParallelFor functions[] = {[](std::size_t, const std::function<void(std::size_t)>&) {},
                                     [](std::size_t, const std::function<void(std::size_t)>& job) { job(1); },
                                     [](std::size_t count, const std::function<void(std::size_t)>& job)
                                     {
                                         job(count - 1);
                                         throw std::runtime_error("the app's");
                                     },
                                     [](std::size_t count, const std::function<void(std::size_t)>& job)
                                     {
                                         for (std::size_t i = 2 * count; i-- > 0;)
                                             job(i % count);
                                     }};
    for (const ParallelFor& function : functions)
    {
        ThreadTeam team(4, function);
        for (const std::size_t count : {2u, 3u, 1000u})
            ASSERT_NO_FATAL_FAILURE(expectEachOnce(team, count));
    }
}

// Threads of the app get their floating-point environment back.
TEST(ThreadTeam, LeavesTheAppsThreadsTheirRounding)
{
    int roundingBefore = -1, roundingWithin = -1, roundingAfter = -1;
    ThreadTeam team(2,
                    [&](std::size_t, const std::function<void(std::size_t)>& job)
                    {
                        std::thread(
                            [&]
                            {
                                std::fesetround(FE_UPWARD);
                                roundingBefore = std::fegetround();
                                job(0);
                                roundingAfter = std::fegetround();
                            })
                            .join();
                    });
    team.run(8, [&](std::size_t) { roundingWithin = std::fegetround(); });
    EXPECT_EQ(roundingBefore, FE_UPWARD);
    EXPECT_EQ(roundingWithin, FE_TONEAREST);
    EXPECT_EQ(roundingAfter, FE_UPWARD);
}

INSTANTIATE_TEST_SUITE_P(Sizes, ThreadTeamTest,
                         testing::Values(TeamCase{1, false}, TeamCase{2, false}, TeamCase{3, false},
                                         TeamCase{16, false}, TeamCase{1, true}, TeamCase{2, true}, TeamCase{16, true}),
                         [](const auto& team)
                         { return std::string(team.param.m_ofApp ? "App" : "") + std::to_string(team.param.m_size); });
}  // namespace drape::test
