// Plugins of several threads, each with a device and a world of its own.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include <drape/queries.h>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/environment.h"
#include "tests/support/own_process.h"

namespace drape::test
{
namespace
{
constexpr int kThreads = 4, kRounds = 3;

Settings openClSettings()
{
    Settings settings;
    settings.m_backend = Backend::OpenCl;
    return settings;
}

// Runs the job on all threads at once.
template <class Job>
void onThreads(const Job& job)
{
    std::vector<std::thread> threads;
    for (int i = 0; i < kThreads; ++i)
        threads.emplace_back(job, i);
    for (std::thread& thread : threads)
        thread.join();
}

std::uint64_t dropCloth(Plugin& plugin)
{
    MeshShape ball(makeSphere(0.5f, 2));
    DropWorld world(&plugin);
    world.addObstacle(ball.shape());
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(0.55), 0);
    const btSoftBody& cloth = world.addCloth(spec);
    world.step(20);
    EXPECT_FALSE(plugin.contacts().empty());
    return hashOf(cloth);
}
}  // namespace

TEST(TwoThreads, ListDevicesAtOnce)
{
    inOwnProcess(
        []
        {
            std::size_t found[kThreads] = {};
            onThreads([&](int i) { found[i] = listDevices().size(); });
            for (const std::size_t count : found)
                EXPECT_EQ(count, listDevices().size());
            EXPECT_TRUE(found[0] > 0 || !isDeviceExpected());
        });
}

TEST(TwoThreads, MakeAndUsePluginsAtOnce)
{
    if (!isDeviceExpected()) GTEST_SKIP();
    inOwnProcess(
        []
        {
            for (int round = 0; round < kRounds; ++round)
            {
                std::uint64_t hashes[kThreads] = {};
                onThreads(
                    [&](int i)
                    {
                        Plugin plugin(openClSettings());
                        EXPECT_TRUE(plugin.ready()) << plugin.error();
                        if (plugin.ready()) hashes[i] = dropCloth(plugin);
                    });
                for (const std::uint64_t hash : hashes)
                    EXPECT_EQ(hash, hashes[0]);
            }
        });
}

TEST(TwoThreads, MakeQueriesAndPluginsAtOnce)
{
    if (!isDeviceExpected()) GTEST_SKIP();
    inOwnProcess(
        []
        {
            onThreads(
                [&](int i)
                {
                    Error error;
                    if (i % 2 == 0)
                        EXPECT_TRUE(Queries::create(openClSettings(), error)) << error.text();
                    else
                        EXPECT_TRUE(Plugin(openClSettings()).ready());
                });
        });
}
}  // namespace drape::test
