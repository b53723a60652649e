// A large scene's memory is released once a small scene is left.
#include <gtest/gtest.h>

#include <malloc.h>

#include <memory>
#include <vector>

#include "bullet_plugin/core/usage_watch.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
std::size_t heapBytes()
{
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

// Runs many cloths on many balls for this number of steps.
void runCrowd(DropWorld& world, int steps)
{
    std::vector<std::unique_ptr<MeshShape>> shapes;
    std::vector<btCollisionObject*> balls;
    std::vector<btSoftBody*> cloths;
    for (int i = 0; i < 6; ++i)
    {
        const btVector3 place(btScalar(-3 + i), btScalar(0.2), 2);
        shapes.push_back(std::make_unique<MeshShape>(makeSphere(0.3f, 3)));
        balls.push_back(&world.addObstacle(shapes.back()->shape(), btTransform(btQuaternion::getIdentity(), place)));
        ClothSpec spec;
        spec.m_nodes = 33;
        spec.m_centre = place + btVector3(0, btScalar(0.35), 0);
        cloths.push_back(&world.addCloth(spec));
    }
    world.step(steps);
    for (btSoftBody* cloth : cloths)
        world.remove(*cloth);
    for (btCollisionObject* ball : balls)
        world.remove(*ball);
}

struct Scene
{
    explicit Scene(const Settings& settings = hostSettings())
        : m_plugin(settings), m_floor(makeBox(8, 0.2f, 8)), m_world(&m_plugin)
    {
        m_world.addObstacle(m_floor.shape());
        ClothSpec spec;
        spec.m_nodes = 12;
        spec.m_centre = btVector3(0, btScalar(0.2), 0);
        m_cloth = &m_world.addCloth(spec);
    }

    Plugin m_plugin;
    MeshShape m_floor;
    DropWorld m_world;
    btSoftBody* m_cloth;
};
}  // namespace

TEST(Memory, MemoryOfACrowdIsReleased)
{
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "the sanitizer's allocator counts nothing";
#endif
    constexpr std::size_t kAllowed = std::size_t(1) << 20;
    Scene scene;
    scene.m_world.step(100);
    const std::size_t before = heapBytes();
    for (int round = 0; round < 2; ++round)
    {
        runCrowd(scene.m_world, 60);
        EXPECT_GT(heapBytes(), before + 4 * kAllowed);
        scene.m_world.step(2 * UsageWatch::kWindow);
        EXPECT_LT(heapBytes(), before + kAllowed);
        EXPECT_FALSE(scene.m_plugin.contacts().empty());
    }
}

TEST(Memory, GivingItBackChangesNoTrajectory)
{
    std::uint64_t hashes[2];
    for (const bool crowded : {false, true})
    {
        Scene scene;
        if (crowded)
            runCrowd(scene.m_world, 60);
        else
            scene.m_world.step(60);
        hashes[crowded] = kHashStart;
        for (int step = 0; step < 2 * UsageWatch::kWindow + 100; ++step)
        {
            scene.m_world.step();
            hashes[crowded] = hashOf(*scene.m_cloth, hashes[crowded]);
        }
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Memory, MemoryOfADeviceIsReleasedWithoutAChange)
{
    if (!isDeviceExpected()) GTEST_SKIP();
    Settings settings;
    settings.m_backend = Backend::OpenCl;
    Scene scene(settings), onHost;
    for (Scene* each : {&scene, &onHost})
    {
        runCrowd(each->m_world, 30);
        each->m_world.step(2 * UsageWatch::kWindow);
        runCrowd(each->m_world, 10);
    }
    EXPECT_EQ(hashOf(*scene.m_cloth), hashOf(*onHost.m_cloth));
    EXPECT_EQ(scene.m_plugin.statistics().m_status, kStepGood);
}

TEST(UsageWatch, FallsOnceAfterAWindowWellBelowTheMost)
{
    UsageWatch watch;
    const auto falls = [&](std::size_t used)
    {
        int count = 0;
        for (int step = 0; step < UsageWatch::kWindow; ++step)
            count += watch.hasFallen(used);
        return count;
    };
    EXPECT_EQ(falls(100000), 0);
    EXPECT_EQ(falls(100000), 0);
    EXPECT_EQ(falls(30000), 0);
    EXPECT_EQ(falls(20000), 1);
    EXPECT_EQ(falls(20000), 0);
    EXPECT_EQ(falls(10), 1);
    EXPECT_EQ(falls(0), 0) << "what is left is little";
}
}  // namespace drape::test
