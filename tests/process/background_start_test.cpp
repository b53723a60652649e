// A plugin that no setting gives a device starts at once. A device is prepared in the background, and the world moves
// to it.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "bullet_plugin/core/device/driver_files.h"
#include "bullet_plugin/core/device/missing_device.h"
#include "bullet_plugin/core/device/opencl_lock.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/environment.h"
#include "tests/support/memory.h"
#include "tests/support/own_process.h"

namespace drape::test
{
namespace
{
// Returns settings that leave every step to a device, even PoCL, once it is there.
Settings anyDevice()
{
    Settings settings;
    settings.m_backend = Backend::ByCost;
    settings.m_crossover = 0;
    return settings;
}

bool isLoaded(const std::string& library)
{
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
        if (line.find(library) != std::string::npos) return true;
    return false;
}

// A cloth that drops onto a ball.
class BallWorld
{
public:
    explicit BallWorld(const Settings& settings) : m_plugin(settings), m_world(&m_plugin)
    {
        m_world.addObstacle(m_ball.shape());
        ClothSpec spec;
        spec.m_centre = btVector3(0, btScalar(0.55), 0);
        m_cloth = &m_world.addCloth(spec);
    }

    Plugin m_plugin;
    MeshShape m_ball{makeSphere(0.5f, 2)};
    DropWorld m_world;
    btSoftBody* m_cloth = nullptr;
};

std::uint64_t hashOnHost(int steps)
{
    Settings settings;
    settings.m_backend = Backend::Host;
    BallWorld world(settings);
    world.m_world.step(steps);
    return hashOf(*world.m_cloth);
}
}  // namespace

TEST(BackgroundStart, NoDriverIsLoadedWhereNoneIsAGpus)
{
    if (whyNoGpu().empty()) GTEST_SKIP() << "there may be a GPU";
    inOwnProcess(
        []
        {
            const ScopedVariable unnamed("DRAPE_DEVICE", nullptr);
            const std::size_t before = residentBytes();
            const Plugin plugin;
            EXPECT_LT(residentBytes(), before + 10000000);
            EXPECT_TRUE(plugin.ready());
            EXPECT_FALSE(plugin.device().m_isStarting);
            EXPECT_TRUE(plugin.device().m_onHost);
            EXPECT_NE(plugin.device().m_reason, "");
            EXPECT_FALSE(isLoaded("libOpenCL")) << "the loader is linked, or opened too early";
            EXPECT_FALSE(isLoaded("libpocl"));
        });
}

TEST(BackgroundStart, TheWorldMovesToTheDeviceAndKeepsItsBits)
{
    if (!isDeviceExpected()) GTEST_SKIP();
    inOwnProcess(
        []
        {
            const ScopedVariable unnamed("DRAPE_DEVICE", nullptr);
            std::unique_ptr<BallWorld> scene;
            int steps = 10;
            {
                const OpenClLock lock;  // no other thread finds a device meanwhile
                scene = std::make_unique<BallWorld>(anyDevice());
                scene->m_world.step(steps);
                EXPECT_TRUE(scene->m_plugin.device().m_isStarting);
                EXPECT_TRUE(scene->m_plugin.statistics().m_onHost);
                EXPECT_FALSE(scene->m_plugin.contacts().empty());
            }
            for (; scene->m_plugin.device().m_isStarting && steps < 60000; ++steps)
            {
                scene->m_world.step();
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
            scene->m_world.step(5);
            EXPECT_FALSE(scene->m_plugin.statistics().m_onHost) << scene->m_plugin.report();
            EXPECT_FALSE(scene->m_plugin.device().m_device.m_platform.empty());
            EXPECT_EQ(hashOf(*scene->m_cloth), hashOnHost(steps + 5)) << steps;
        });
}

TEST(BackgroundStart, KeptNodesWaitForTheDevice)
{
    if (!isDeviceExpected()) GTEST_SKIP();
    inOwnProcess(
        []
        {
            const ScopedVariable unnamed("DRAPE_DEVICE", nullptr);
            Settings settings = anyDevice();
            settings.m_solverPlace = SolverPlace::Device;
            BallWorld scene(settings);
            EXPECT_EQ(scene.m_plugin.keepOnDevice(*scene.m_cloth, true), "");
            EXPECT_FALSE(scene.m_plugin.device().m_isStarting);
            scene.m_plugin.keepOnDevice(*scene.m_cloth, false);
        });
}

TEST(BackgroundStart, EndsWithItsPluginAtAnyTime)
{
    if (!isDeviceExpected()) GTEST_SKIP();
    inOwnProcess(
        []
        {
            const ScopedVariable unnamed("DRAPE_DEVICE", nullptr);
            for (int i = 0; i < 12; ++i)
            {
                Plugin plugin(anyDevice());
                EXPECT_TRUE(plugin.ready());
                std::this_thread::sleep_for(std::chrono::milliseconds(30 * i));
            }
        });
}

// PoCL's own cache is empty, so that it compiles. Caches of other drivers may be full.
TEST(BackgroundStart, TellsHowLongKernelsWereCompiled)
{
    if (!isDeviceExpected()) GTEST_SKIP();
    inOwnProcess(
        []
        {
            const TemporaryFolder folder;
            const ScopedVariable unnamed("DRAPE_DEVICE", nullptr), cache("POCL_CACHE_DIR", folder.path().c_str());
            std::vector<std::string> lines;
            Settings settings = anyDevice();
            settings.m_cacheFolder = "none";
            settings.m_log = [&](const char* line) { lines.push_back(line); };
            Plugin plugin(settings);
            plugin.awaitDevice();
            if (listDevices()[0].m_platform != kPoclPlatform) return;
            ASSERT_EQ(lines.size(), 1u);
            EXPECT_NE(lines[0].find("the kernels for " + listDevices()[0].m_name + " were compiled in "),
                      std::string::npos)
                << lines[0];
        });
}
}  // namespace drape::test
