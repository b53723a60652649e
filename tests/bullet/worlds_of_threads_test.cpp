// Several worlds: of one plugin, of plugins on other threads, and handed from thread to thread. Each keeps its bits.
#include <gtest/gtest.h>

#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/job_pool.h"

namespace drape::test
{
namespace
{
constexpr int kWorlds = 3, kSteps = 20;

// A cloth that falls on a ball; worlds of other numbers have other heights.
class BallWorld
{
public:
    // nodes: along either side of the cloth.
    BallWorld(Plugin& plugin, int number, int nodes = 17) : m_world(&plugin)
    {
        m_world.addObstacle(m_ball.shape());
        ClothSpec spec;
        spec.m_nodes = nodes;
        spec.m_centre = btVector3(0, btScalar(0.55 + 0.01 * number), 0);
        m_cloth = &m_world.addCloth(spec);
    }
    void step() { m_world.step(); }
    std::uint64_t hash() const { return hashOf(*m_cloth); }

private:
    MeshShape m_ball{makeSphere(0.5f, 2)};
    DropWorld m_world;
    btSoftBody* m_cloth;
};

std::uint64_t hashOfRun(const Settings& settings, int number, int nodes = 17, int steps = kSteps)
{
    Plugin plugin(settings);
    BallWorld world(plugin, number, nodes);
    for (int step = 0; step < steps; ++step)
        world.step();
    EXPECT_FALSE(plugin.contacts().empty());
    return world.hash();
}

std::uint64_t hashAlone(int number)
{
    return hashOfRun(hostSettings(), number);
}
}  // namespace

TEST(SeveralWorlds, OfOneThreadShareAPlugin)
{
    Plugin plugin(hostSettings());
    std::vector<std::unique_ptr<BallWorld>> worlds;
    for (int i = 0; i < kWorlds; ++i)
        worlds.push_back(std::make_unique<BallWorld>(plugin, i));
    for (int step = 0; step < kSteps; ++step)
        for (const auto& world : worlds)
            world->step();
    for (int i = 0; i < kWorlds; ++i)
        EXPECT_EQ(worlds[std::size_t(i)]->hash(), hashAlone(i)) << "world " << i;
}

TEST(SeveralWorlds, OfSeveralThreadsHaveAPluginEach)
{
    std::vector<std::uint64_t> hashes(kWorlds);
    std::vector<std::thread> threads;
    for (int i = 0; i < kWorlds; ++i)
        threads.emplace_back([&hashes, i] { hashes[std::size_t(i)] = hashAlone(i); });
    for (std::thread& thread : threads)
        thread.join();
    for (int i = 0; i < kWorlds; ++i)
        EXPECT_EQ(hashes[std::size_t(i)], hashAlone(i)) << "world " << i;
}

// A job system steps a world wherever it likes, one step after the other; nothing is told of two threads in the plugin.
TEST(SeveralWorlds, MayStepOnAnotherThreadEachTime)
{
    int lines = 0;
    Settings settings = hostSettings();
    settings.m_threads = 2;
    settings.m_log = [&](const char*) { ++lines; };
    Plugin plugin(settings);
    BallWorld world(plugin, 0);
    for (int step = 0; step < kSteps; ++step)
        std::thread([&] { world.step(); }).join();
    EXPECT_EQ(world.hash(), hashAlone(0));
    EXPECT_EQ(lines, 0);
}

// Plugins of several threads may have one job system.
TEST(SeveralWorlds, OfSeveralThreadsMayShareAJobSystem)
{
    constexpr int kNodes = 65, kFewSteps = 6;  // large enough for jobs
    std::mutex mutex;
    JobPool pool(2);
    const ParallelFor inTurns = [&](std::size_t count, const std::function<void(std::size_t)>& job)
    {
        const std::lock_guard<std::mutex> lock(mutex);
        pool.parallelFor(count, job);
    };
    std::vector<std::uint64_t> hashes(kWorlds);
    std::vector<std::thread> threads;
    for (int i = 0; i < kWorlds; ++i)
    {
        threads.emplace_back(
            [&, i]
            {
                Settings settings = hostSettings();
                settings.m_threads = 3;
                settings.m_parallelFor = inTurns;
                hashes[std::size_t(i)] = hashOfRun(settings, i, kNodes, kFewSteps);
            });
    }
    for (std::thread& thread : threads)
        thread.join();
    Settings alone = hostSettings();
    alone.m_threads = 1;
    for (int i = 0; i < kWorlds; ++i)
        EXPECT_EQ(hashes[std::size_t(i)], hashOfRun(alone, i, kNodes, kFewSteps)) << "world " << i;
    EXPECT_GT(pool.calls(), 0u);
}
}  // namespace drape::test
