// The automatic choice of scenes that run on the host: the expected work of meshes, the crossover of measured times,
// its file, and the rule by which a scene changes its back end.
#include "bullet_plugin/core/backend_choice/crossover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "bullet_plugin/core/device/cache_file.h"
#include "bullet_plugin/core/scene/topology.h"
#include "bullet_plugin/core/backend_choice/backend_choice.h"
#include "bullet_plugin/core/backend_choice/machine_load.h"
#include "bullet_plugin/core/backend_choice/expected_pairs.h"
#include "bullet_plugin/core/scene/topology.h"
#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Surface surfaceOf(const TriangleMesh& mesh)
{
    const Topology topology = buildTopology(mesh.m_triangles.data(), mesh.triangleCount(), mesh.vertexCount());
    return {topology.m_triangles.size(), surfaceArea(topology.m_triangles, mesh.m_positions.data())};
}

// Host 1 µs a pair; device 100 µs and a tenth: they are even at 111 pairs.
CrossoverRung idealRung(double pairs)
{
    return {pairs, 1e-3 * pairs, 0.1 + 1e-4 * pairs};
}
}  // namespace

TEST(SceneWork, AreaOfAGridAndOfABall)
{
    EXPECT_NEAR(surfaceOf(makeClothGrid(9, 9, 2.0f, 0).m_mesh).m_area, 4.0, 1e-5);
    EXPECT_NEAR(surfaceOf(makeSphere(1.0f, 5)).m_area, 4 * 3.14159265, 0.02);
    TriangleMesh broken = makeClothGrid(9, 9, 2.0f, 0).m_mesh;
    broken.m_positions[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NEAR(surfaceOf(broken).m_area, 4.0, 0.1);
}

TEST(SceneWork, GrowsWithBothSidesAndTheReach)
{
    const Surface cloth = {128, 1.0}, fine = {512, 1.0}, obstacle = {1280, 3.0}, denser = {5120, 3.0};
    const double pairs = expectedPairs(cloth, obstacle, 0.03);
    EXPECT_GT(pairs, 128);
    EXPECT_GT(expectedPairs(fine, obstacle, 0.03), pairs);
    EXPECT_GT(expectedPairs(cloth, denser, 0.03), pairs);
    EXPECT_GT(expectedPairs(cloth, obstacle, 0.06), pairs);
    // Only the density counts: an obstacle twice as large in area with twice the triangles gives no more pairs.
    EXPECT_DOUBLE_EQ(expectedPairs(cloth, {2560, 6.0}, 0.03), pairs);
    // Both sides have equal roles.
    EXPECT_DOUBLE_EQ(expectedPairs(obstacle, cloth, 0.03), pairs);
}

TEST(SceneWork, NeverMoreThanAllPairs)
{
    const Surface small = {2, 1e-4}, obstacle = {1280, 3.0};
    EXPECT_LE(expectedPairs(small, obstacle, 1e6), 2 * 1280.0);
    EXPECT_EQ(expectedPairs({128, 0}, obstacle, 0.03), 128 * 1280.0);
    EXPECT_EQ(expectedPairs({0, 0}, obstacle, 0.03), 0);
    EXPECT_EQ(expectedPairs({128, kInfinity}, obstacle, 0.03), 128 * 1280.0);
}

TEST(BestCrossover, LiesWhereTheTimesCross)
{
    std::vector<CrossoverRung> rungs;
    for (double pairs = 1000; pairs > 10; pairs /= 1.5)  // in any order
        rungs.push_back(idealRung(pairs));
    EXPECT_NEAR(std::log(bestCrossover(rungs) / 111), 0, std::log(1.5) / 2);
}

TEST(BestCrossover, OneRungThatWasDisturbedDoesNotMoveIt)
{
    std::vector<CrossoverRung> rungs;
    for (double pairs = 10; pairs < 2000; pairs *= 1.5)
        rungs.push_back(idealRung(pairs));
    const double undisturbed = bestCrossover(rungs);
    rungs[1].m_hostMs *= 20;
    EXPECT_EQ(bestCrossover(rungs), undisturbed);
    rungs[rungs.size() - 2].m_deviceMs *= 20;
    EXPECT_EQ(bestCrossover(rungs), undisturbed);
}

TEST(BestCrossover, EndsAreAlwaysAndNever)
{
    EXPECT_EQ(bestCrossover({{10, 2, 1}, {100, 20, 1}}), 0);
    EXPECT_EQ(bestCrossover({{10, 1, 2}, {100, 1, 20}}), kInfinity);
}

TEST(LeastTimes, LeastTimesAreTakenForEachRung)
{
    const std::vector<CrossoverRung> rungs = leastTimes({{10, 1, 4}, {100, 5, 6}}, {{1000, 7, 8}, {10, 2, 3}});
    ASSERT_EQ(rungs.size(), 3u);
    EXPECT_EQ(rungs[0].m_hostMs, 1);
    EXPECT_EQ(rungs[0].m_deviceMs, 3);
    EXPECT_EQ(rungs[1].m_hostMs, 5);
    EXPECT_EQ(rungs[2].m_deviceMs, 8);
}

TEST(MachineLoad, ReadsWhatTheSystemCounts)
{
    std::istringstream stat("cpu  100 20 30 1000 50 6 7 8 90 9\ncpu0 1 2 3\ncpu1 1 2 3\nintr 5\n"),
        cut("cpu 1 2\ncpu0 1\n"), none("");
    CoreTimes times;
    ASSERT_TRUE(readCoreTimes(stat, 100, times));
    EXPECT_DOUBLE_EQ(times.m_busy, 1.71);
    EXPECT_DOUBLE_EQ(times.m_all, 12.21);
    EXPECT_EQ(times.m_cores, 2u);
    EXPECT_FALSE(readCoreTimes(cut, 100, times));
    EXPECT_FALSE(readCoreTimes(none, 100, times));
    EXPECT_EQ(times.m_cores, 2u);
}

TEST(MachineLoad, TheMachineIsBusyIfOthersLeaveTooFewCores)
{
    const CoreTimes first = {10, 100, 8};
    const auto busy = [&](double busySeconds, unsigned threads) {
        return isBusyBetween(first, {10 + busySeconds, 108, 8}, 1.5, threads);
    };  // one second
    EXPECT_FALSE(busy(1.5, 8));
    EXPECT_FALSE(busy(1.7, 8));
    EXPECT_TRUE(busy(2.5, 8));
    EXPECT_FALSE(busy(2.5, 2));
    EXPECT_FALSE(busy(7.5, 2));
    EXPECT_TRUE(busy(8, 2));
    EXPECT_FALSE(isBusyBetween(first, first, 0, 8));
}

TEST(BackendChoice, AGrowingSceneMovesOnceAndComesBackBelowHalf)
{
    BackendChoice choice;
    EXPECT_FALSE(choice.active());
    choice.begin(1000);
    EXPECT_TRUE(choice.active());
    EXPECT_TRUE(choice.chooseHost());
    choice.setWork(1, 7, 600);
    choice.setWork(1, 8, 900);  // the worst of one cloth's obstacles counts
    EXPECT_EQ(choice.work(), 900);
    EXPECT_TRUE(choice.chooseHost());
    choice.setWork(2, 7, 200);
    EXPECT_EQ(choice.work(), 1100);
    EXPECT_FALSE(choice.chooseHost());
    choice.forget(2);
    EXPECT_FALSE(choice.chooseHost()) << "900 is below the crossover, but above its half";
    choice.forget(8);
    EXPECT_FALSE(choice.chooseHost());
    choice.setWork(1, 7, 499);
    EXPECT_TRUE(choice.chooseHost());
    choice.setWork(1, 7, 600);
    EXPECT_TRUE(choice.chooseHost());
    choice.end();
    EXPECT_FALSE(choice.active());
}

TEST(BackendChoice, ZeroIsTheDeviceAndInfinityTheHost)
{
    BackendChoice choice;
    choice.begin(0);
    EXPECT_FALSE(choice.chooseHost());
    choice.setWork(1, 2, 1);
    choice.forget(1);
    EXPECT_FALSE(choice.chooseHost());
    choice.begin(kInfinity);
    choice.setWork(1, 2, 1e30);
    EXPECT_TRUE(choice.chooseHost());
}

class CrossoverCacheTest : public testing::Test
{
protected:
    CrossoverCacheTest()
    {
        m_settings.m_cacheFolder = m_folder.path();
        m_device.m_platform = "platform";
        m_device.m_name = "device\nof two lines";
        m_device.m_driver = "1";
        m_stored.m_pairs = 1234.5;
        m_stored.m_rungs = {{10, 0.25, 0.5}, {1e5, 30, 1.5}};
    }
    CrossoverCache cache(std::size_t units = 2) const { return CrossoverCache(m_settings, m_device, units); }
    std::string path() const { return m_folder.path() + "/" + cache().fileName(); }
    std::string text() const
    {
        std::string bytes;
        EXPECT_TRUE(readCacheFile(m_folder.path(), cache().fileName(), 1 << 20, bytes));
        return bytes;
    }
    bool loads(const CrossoverCache& from) const
    {
        Crossover loaded;
        return from.load(loaded);
    }

    TemporaryFolder m_folder;
    Settings m_settings;
    DeviceInfo m_device;
    Crossover m_stored;
};

TEST_F(CrossoverCacheTest, RoundTrip)
{
    EXPECT_FALSE(loads(cache()));
    for (const double pairs : {1234.5, 0.0, kInfinity})
    {
        m_stored.m_pairs = pairs;
        cache().store(m_stored);
        Crossover loaded;
        ASSERT_TRUE(cache().load(loaded));
        EXPECT_EQ(loaded.m_pairs, pairs);
        ASSERT_EQ(loaded.m_rungs.size(), 2u);
        EXPECT_EQ(loaded.m_rungs[1].m_pairs, 1e5);
        EXPECT_EQ(loaded.m_rungs[1].m_hostMs, 30);
        EXPECT_EQ(loaded.m_rungs[1].m_deviceMs, 1.5);
    }
    EXPECT_NE(text().find("device of two lines"), std::string::npos) << "it can be read";
}

TEST_F(CrossoverCacheTest, ABusyMachineIsRememberedForSomeStarts)
{
    for (const int busyStarts : {0, 1, kMostBusyStarts - 1, kMostBusyStarts})
    {
        m_stored.m_busyStarts = busyStarts;
        cache().store(m_stored);
        Crossover loaded;
        ASSERT_TRUE(cache().load(loaded));
        EXPECT_EQ(loaded.m_busyStarts, busyStarts);
        EXPECT_EQ(isProvisional(loaded), busyStarts > 0 && busyStarts < kMostBusyStarts);
    }
}

TEST_F(CrossoverCacheTest, AnotherDriverIsStaleAndReplaced)
{
    cache().store(m_stored);
    m_device.m_driver = "2";
    EXPECT_FALSE(loads(cache()));
    m_stored.m_pairs = 99;
    cache().store(m_stored);
    Crossover loaded;
    ASSERT_TRUE(cache().load(loaded));
    EXPECT_EQ(loaded.m_pairs, 99);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(m_folder.path()), {}), 1);
}

TEST_F(CrossoverCacheTest, OtherDevicesUnitsAndSettingsHaveTheirOwn)
{
    cache().store(m_stored);
    EXPECT_TRUE(loads(cache()));
    EXPECT_FALSE(loads(cache(3)));
    for (std::string DeviceInfo::*field : {&DeviceInfo::m_platform, &DeviceInfo::m_name})
    {
        const DeviceInfo before = m_device;
        m_device.*field += "x";
        EXPECT_FALSE(loads(cache()));
        m_device = before;
    }
    m_settings.m_mode = ContactMode::Discrete;
    EXPECT_FALSE(loads(cache()));
}

TEST_F(CrossoverCacheTest, ProcessorsWhoseThreadsKeepToTheirCoresHaveTheirOwn)
{
    setVariable("POCL_AFFINITY", "1");
    cache().store(m_stored);
    EXPECT_TRUE(loads(cache()));
    setVariable("POCL_AFFINITY", nullptr);
    EXPECT_FALSE(loads(cache()));
    m_device.m_isGpu = true;
    cache().store(m_stored);
    setVariable("POCL_AFFINITY", "1");
    EXPECT_TRUE(loads(cache()));
    setVariable("POCL_AFFINITY", nullptr);
}

TEST_F(CrossoverCacheTest, EveryTruncationAndEveryFlippedByteReadsAsNotThere)
{
    cache().store(m_stored);
    const std::string good = text();
    for (std::size_t at = 0; at < good.size(); ++at)
    {
        std::ofstream(path(), std::ios::binary) << good.substr(0, at);
        ASSERT_FALSE(loads(cache())) << at << " bytes";
        std::string bad = good;
        bad[at] = char(bad[at] ^ 0x01);
        std::ofstream(path(), std::ios::binary) << bad;
        ASSERT_FALSE(loads(cache())) << "byte " << at;
    }
    std::ofstream(path(), std::ios::binary) << good;
    EXPECT_TRUE(loads(cache()));
}

TEST_F(CrossoverCacheTest, NoFolderIsNoTrouble)
{
    for (const char* folder : {"none", "/proc/drape"})
    {
        m_settings.m_cacheFolder = folder;
        cache().store(m_stored);
        EXPECT_FALSE(loads(cache()));
    }
}
}  // namespace drape::test
