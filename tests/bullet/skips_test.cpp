// Skipped work changes nothing: obstacles whose vertices are not read again, sleeping cloth, pinned cloth, and the
// device that a small scene does not use. Compares contacts and trajectories with the skip and with it defeated, bit
// for bit, on every back end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"
#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
btTransform shiftedTo(double x, double y, double z)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

ClothSpec clothAt(double x, double y)
{
    ClothSpec spec;
    spec.m_nodes = 11;
    spec.m_size = 0.8f;
    spec.m_centre = btVector3(btScalar(x), btScalar(y), 0);
    return spec;
}

// Returns the contacts of one cloth without the names of objects of its world.
std::vector<ContactInfo> contactsOf(const Plugin& plugin, const btSoftBody& cloth)
{
    std::vector<ContactInfo> contacts;
    for (ContactInfo contact : plugin.contacts())
    {
        if (contact.m_cloth != &cloth) continue;
        contact.m_cloth = nullptr;
        contact.m_obstacle = nullptr;
        contacts.push_back(contact);
    }
    return contacts;
}

// A ball, a box that a body moves under the cloth, and the cloth on both.
struct SkipWorld
{
    explicit SkipWorld(const Settings& settings)
        : m_plugin(settings),
          m_ball(makeSphere(0.3f, 3)),
          m_slab(makeBox(3.0f, 0.2f, 3.0f)),
          m_world(&m_plugin),
          m_ballObject(m_world.addObstacle(m_ball.shape())),
          m_slabBody(m_world.addKinematic(m_slab.shape(), shiftedTo(0, -0.2, 0))),
          m_cloth(m_world.addCloth(clothAt(0.1, 0.4)))
    {
    }

    // The slab rests, moves on and rests again; the ball jumps a little.
    void step(int count)
    {
        m_ballObject.setWorldTransform(shiftedTo(count < 45 ? 0 : 0.02, 0, 0));
        const double way = count < 30 ? 0 : count < 60 ? 0.01 * (count - 30) : 0.3;
        m_slabBody.setWorldTransform(shiftedTo(way, -0.2, 0));
        m_world.step();
    }

    Plugin m_plugin;
    MeshShape m_ball, m_slab;
    DropWorld m_world;
    btCollisionObject& m_ballObject;
    btRigidBody& m_slabBody;
    btSoftBody& m_cloth;
};

static_assert(sizeof(ContactInfo) == 2 * sizeof(void*) + 3 * sizeof(int) + 11 * sizeof(float), "compared byte by byte");
}  // namespace

class Skips : public BackendTest
{
protected:
    // Steps both worlds; calls `defeat` before each step of the second one. The cloth of both must move equally.
    void expectSame(SkipWorld& skipping, SkipWorld& defeated, const std::function<void()>& defeat)
    {
        std::size_t contacts = 0;
        for (int step = 0; step < 90; ++step)
        {
            SCOPED_TRACE("step " + std::to_string(step));
            defeat();
            skipping.step(step);
            defeated.step(step);
            const std::vector<ContactInfo> found = contactsOf(skipping.m_plugin, skipping.m_cloth);
            ASSERT_TRUE(sameContacts(found, contactsOf(defeated.m_plugin, defeated.m_cloth)));
            ASSERT_EQ(hashOf(skipping.m_cloth), hashOf(defeated.m_cloth));
            contacts += found.size();
        }
        EXPECT_GT(contacts, 2000u);
    }
};

TEST_P(Skips, ObstaclesThatAreNotReadAnew)
{
    SkipWorld skipping(GetParam().m_settings), defeated(GetParam().m_settings);
    std::size_t kept = 0, keptAllTheSame = 0;
    expectSame(skipping, defeated,
               [&]
               {
                   kept += skipping.m_plugin.statistics().m_obstaclesKept;
                   keptAllTheSame += defeated.m_plugin.statistics().m_obstaclesKept;
                   defeated.m_plugin.obstacleChanged(&defeated.m_ball.shape());
                   defeated.m_plugin.obstacleChanged(&defeated.m_slab.shape());
               });
    EXPECT_GT(kept, 60u);
    // Reading vertices anew that have not changed refits nothing.
    EXPECT_EQ(keptAllTheSame, kept);
}

// A second cloth sleeps in touch with the slab in one world only. It keeps its position until the slab moves and wakes
// it.
TEST_P(Skips, ClothThatSleeps)
{
    SkipWorld with(GetParam().m_settings), without(GetParam().m_settings);
    btSoftBody& sleeper = with.m_world.addCloth(clothAt(1.0, -0.09));
    const std::uint64_t hash = hashOf(sleeper);
    int steps = 0;
    expectSame(with, without,
               [&]
               {
                   if (++steps > 30) return;
                   EXPECT_EQ(hashOf(sleeper), hash);
                   EXPECT_EQ(with.m_plugin.statistics().m_clothsSkipped, steps > 1 ? 1u : 0u);
                   EXPECT_EQ(without.m_plugin.statistics().m_clothsSkipped, 0u);
                   sleeper.forceActivationState(ISLAND_SLEEPING);
               });
}

// All of the cloth's nodes are pinned, so that no contact could move it. The pair is tested all the same if another
// node, which belongs to no face, falls far away.
TEST_P(Skips, ClothThatIsPinned)
{
    SkipWorld skipping(GetParam().m_settings), defeated(GetParam().m_settings);
    std::uint64_t hashes[2];
    btSoftBody* pinned[2];
    SkipWorld* worlds[2] = {&skipping, &defeated};
    for (int i = 0; i < 2; ++i)
    {
        pinned[i] = &worlds[i]->m_world.addCloth(clothAt(1.0, -0.09));
        for (int node = 0; node < pinned[i]->m_nodes.size(); ++node)
            pinned[i]->setMass(node, 0);
        hashes[i] = hashOf(*pinned[i]);
    }
    pinned[1]->appendNode(btVector3(1, 50, 0), 1);
    std::size_t looked = 0, counted = 0;
    expectSame(skipping, defeated,
               [&]
               {
                   EXPECT_TRUE(contactsOf(skipping.m_plugin, *pinned[0]).empty());
                   counted += skipping.m_plugin.statistics().m_clothsSkipped;
                   EXPECT_EQ(defeated.m_plugin.statistics().m_clothsSkipped, 0u);
                   looked += contactsOf(defeated.m_plugin, *pinned[1]).size();
               });
    EXPECT_GT(looked, 1000u);
    EXPECT_GT(counted, 80u);
    EXPECT_EQ(hashOf(*pinned[0]), hashes[0]);
    pinned[1]->m_nodes.pop_back();
    EXPECT_EQ(hashOf(*pinned[1]), hashes[1]);
}

// A world without soft bodies while its slab moves; cloth comes later. A listener defeats the skip.
TEST_P(Skips, StepsWithoutSoftBodies)
{
    std::vector<std::vector<std::uint64_t>> hashes(2);
    for (const bool isDefeated : {false, true})
    {
        Plugin plugin(GetParam().m_settings);
        plugin.setContactListener(isDefeated ? ContactListener([](const StepContacts&) {}) : ContactListener());
        MeshShape slab(makeBox(3.0f, 0.2f, 3.0f));
        DropWorld world(&plugin);
        btRigidBody& body = world.addKinematic(slab.shape(), shiftedTo(0, -0.2, 0));
        const auto step = [&](int count)
        {
            body.setWorldTransform(shiftedTo(0.01 * count, -0.2, 0));
            world.step();
        };
        for (int round = 0; round < 2; ++round)
        {
            const int empty = round == 0 ? 20 : 1210;  // the first cloth's data go after 1,200
            for (int i = 0; i < empty; ++i)
                step(i);
            btSoftBody& cloth = world.addCloth(clothAt(0.01 * empty, -0.06));
            for (int i = empty; i < empty + 30; ++i)
            {
                step(i);
                hashes[isDefeated].push_back(hashOf(cloth));
            }
            EXPECT_GT(plugin.statistics().m_contacts, 100u);
            world.remove(cloth);
        }
        step(2000);
        EXPECT_EQ(plugin.statistics().m_contacts, 0u);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

#ifdef NDEBUG
// Limits Drape's time in a step of a world in which all cloth sleeps on its obstacles, some of them kinematic. The step
// runs on the host, and launches nothing on a device.
TEST_P(Skips, AWorldAtRestCostsFiveMicroseconds)
{
    Settings settings = GetParam().m_settings;
    settings.m_profileKernels = true;
    SkipWorld world(settings);
    std::vector<btSoftBody*> cloths = {&world.m_cloth};
    for (int i = 0; i < 9; ++i)
        cloths.push_back(&world.m_world.addCloth(clothAt(-1.0 + 0.2 * i, -0.09)));
    for (int step = 0; step < 5; ++step)
        world.step(0);
    ASSERT_GT(world.m_plugin.statistics().m_contacts, 0u);
    Pipeline& pipeline = world.m_plugin.state()->pipeline();
    pipeline.takeKernelTimes();
    std::vector<double> times;
    for (int step = 0; step < 400; ++step)
    {
        for (btSoftBody* cloth : cloths)
            cloth->forceActivationState(ISLAND_SLEEPING);
        world.step(0);
        const StepStatistics& statistics = world.m_plugin.statistics();
        ASSERT_TRUE(statistics.m_skipped);
        ASSERT_EQ(statistics.m_clothsSkipped, cloths.size());
        times.push_back(1000 * statistics.collisionMs());
    }
    EXPECT_TRUE(pipeline.takeKernelTimes().empty());
    std::nth_element(times.begin(), times.begin() + 200, times.end());
    RecordProperty("median_us", std::to_string(times[200]));
    EXPECT_LT(times[200], 5) << "us, the median";
}
#endif

// A scene runs on the host until a second cloth makes the device faster.
TEST_P(Skips, TheDeviceWhereTheSceneIsTooSmallForIt)
{
    if (GetParam().m_device > 0) GTEST_SKIP() << "cost decides about the first device only";
    const ScopedVariable noDevice("DRAPE_DEVICE", nullptr);
    Settings settings;
    settings.m_backend = Backend::ByCost;
    settings.m_crossover = 16000;
    SkipWorld byCost(settings), fixed(GetParam().m_settings);
    byCost.m_plugin.awaitDevice();
    std::size_t onHost = 0, onDevice = 0;
    SkipWorld* worlds[2] = {&byCost, &fixed};
    int steps = 0;
    expectSame(byCost, fixed,
               [&]
               {
                   const StepStatistics& statistics = byCost.m_plugin.statistics();
                   if (!statistics.m_skipped) ++(statistics.m_onHost ? onHost : onDevice);
                   for (int i = 0; i < 2 && steps == 30; ++i)
                   {
                       ClothSpec spec = clothAt(1.0, 0.05);
                       spec.m_nodes = 61;
                       worlds[i]->m_world.addCloth(spec);
                   }
                   ++steps;
               });
    const bool device = !listDevices().empty();
    EXPECT_GT(onHost, 20u);
    EXPECT_EQ(onDevice > 20u, device);
    const std::string report = byCost.m_plugin.report();
    EXPECT_EQ(report.find("16000") != std::string::npos, device) << report;
}

INSTANTIATE_TEST_SUITE_P(Backend, Skips, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
