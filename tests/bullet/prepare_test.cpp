// Preparation by an app before a step needs the data on the device.
#include <gtest/gtest.h>

#include <functional>

#include "BulletCollision/CollisionShapes/btBoxShape.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr btScalar kFar = 100;  // m

ClothSpec above(double height)
{
    ClothSpec spec;
    spec.m_centre = btVector3(btScalar(0.02), btScalar(height), btScalar(-0.03));
    return spec;
}

btTransform shifted(btScalar x, btScalar y)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(x, y, 0));
}

// A cloth above a sphere.
struct PreparedWorld
{
    explicit PreparedWorld(const Settings& settings, const ClothSpec& cloth = above(0.45))
        : m_plugin(settings),
          m_shape(makeSphere(0.4f, 3)),
          m_world(&m_plugin),
          m_obstacle(m_world.addObstacle(m_shape.shape())),
          m_cloth(m_world.addCloth(cloth))
    {
    }

    // Obstacles that the next step finds as it wants them.
    std::size_t keptInNextStep()
    {
        m_world.step();
        return m_plugin.statistics().m_obstaclesKept;
    }

    Plugin m_plugin;
    MeshShape m_shape;
    DropWorld m_world;
    btCollisionObject& m_obstacle;
    btSoftBody& m_cloth;
};

// Prepared data stays while the cloth is elsewhere, and is gone after its release.
void staysUntil(const Settings& settings, const std::function<void(PreparedWorld&)>& release)
{
    PreparedWorld world(settings);
    world.m_plugin.prepare(&world.m_obstacle);
    world.m_plugin.prepare(&world.m_obstacle);
    EXPECT_EQ(world.keptInNextStep(), 1u);
    MeshShape floorShape(makeBox(4.0f, 0.1f, 4.0f));
    world.m_world.addObstacle(floorShape.shape(), shifted(kFar, -1));
    const auto visitFloor = [&]
    {
        world.m_cloth.translate(btVector3(kFar, 0, 0));
        world.m_world.step(200);
        world.m_cloth.translate(btVector3(-kFar, btScalar(1.37), 0));
    };
    visitFloor();
    EXPECT_EQ(world.keptInNextStep(), 1u);
    release(world);
    EXPECT_EQ(world.keptInNextStep(), 1u) << "its pair has it";
    visitFloor();
    EXPECT_EQ(world.keptInNextStep(), 0u);
    EXPECT_GT(world.m_plugin.statistics().m_obstacleTriangles, 1000u);
}
}  // namespace

class Prepared : public BackendTest
{
};

TEST_P(Prepared, TheFirstStepFindsWhatItNeeds)
{
    PreparedWorld prepared(GetParam().m_settings), plain(GetParam().m_settings);
    prepared.m_plugin.prepare(&prepared.m_obstacle);
    prepared.m_plugin.prepare(&prepared.m_cloth);
    EXPECT_EQ(prepared.keptInNextStep(), 1u);
    EXPECT_EQ(plain.keptInNextStep(), 0u);
    for (int step = 0; step < 60; ++step)
    {
        prepared.m_world.step();
        plain.m_world.step();
        ASSERT_EQ(hashOf(prepared.m_cloth), hashOf(plain.m_cloth)) << "step " << step;
    }
    EXPECT_GT(prepared.m_plugin.statistics().m_contacts, 100u);
}

// The cloth has turned before its pair cuts it into parts. Its bits depend on the order of work of these parts.
TEST_P(Prepared, ALargeClothTakesTheSamePath)
{
    ClothSpec spec = above(0.8);
    spec.m_nodes = 50;
    PreparedWorld prepared(GetParam().m_settings, spec), plain(GetParam().m_settings, spec);
    prepared.m_plugin.prepare(&prepared.m_cloth);
    for (PreparedWorld* world : {&prepared, &plain})
    {
        const btVector3 centre = spec.m_centre;
        for (int i = 0; i < world->m_cloth.m_nodes.size(); ++i)
        {
            btSoftBody::Node& node = world->m_cloth.m_nodes[i];
            node.m_v = btVector3(2, 3, 4).cross(node.m_x - centre);
        }
        world->m_world.step(60);
    }
    EXPECT_GT(plain.m_plugin.statistics().m_contacts, 100u);
    EXPECT_EQ(hashOf(prepared.m_cloth), hashOf(plain.m_cloth));
}

TEST_P(Prepared, PreparedDataStaysUntilItsRelease)
{
    staysUntil(GetParam().m_settings,
               [](PreparedWorld& world)
               {
                   world.m_plugin.release(&world.m_obstacle);
                   world.m_plugin.release(&world.m_cloth);
               });
}

TEST_P(Prepared, AWorldIsReleasedAtOnce)
{
    staysUntil(GetParam().m_settings, [](PreparedWorld& world) { world.m_plugin.release(world.m_world.world()); });
}

// Meshes that come are numbered anew; those of the last step's contacts keep their names.
TEST_P(Prepared, ContactsOfTheLastStepStay)
{
    PreparedWorld world(GetParam().m_settings);
    world.m_world.addCloth(above(0.5));
    world.m_world.step(60);
    const std::vector<ContactInfo> before = world.m_plugin.contacts();
    ASSERT_GT(before.size(), 200u);
    MeshShape other(makeBox(1.0f, 0.1f, 1.0f));
    for (int i = 1; i < 4; ++i)
    {
        world.m_plugin.prepare(&world.m_world.addObstacle(other.shape(), shifted(kFar, btScalar(i))));
        EXPECT_TRUE(sameContacts(before, world.m_plugin.contacts())) << i;
    }
    world.m_world.step();
    EXPECT_FALSE(sameContacts(before, world.m_plugin.contacts()));
}

TEST_P(Prepared, AWorldIsPreparedAtOnce)
{
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    plugin.prepare(world.world());
    MeshShape sphere(makeSphere(0.4f, 2)), slab(makeBox(2.0f, 0.1f, 2.0f));
    world.addObstacle(sphere.shape());
    world.addObstacle(slab.shape(), shifted(0, btScalar(0.35)));
    btSoftBody& cloth = world.addCloth(above(0.41));
    plugin.prepare(world.world());
    for (int step = 0; step == 0 || (step < 10 && plugin.statistics().m_skipped); ++step)
        world.step();
    EXPECT_EQ(plugin.statistics().m_obstaclesKept, 2u);
    EXPECT_EQ(plugin.whyStock(&cloth, world.world().getCollisionObjectArray()[0]), "");
}

// Prepares a compound's children, and changes after the preparation.
TEST_P(Prepared, ChildrenAndChangesArePrepared)
{
    MeshShape sphere(makeSphere(0.3f, 2)), slab(makeBox(2.0f, 0.1f, 2.0f));
    btBoxShape box(btVector3(1, 1, 1));
    btCompoundShape compound;
    compound.addChildShape(shifted(0, 0), &sphere.shape());
    compound.addChildShape(shifted(kFar, 0), &box);
    compound.addChildShape(shifted(0, btScalar(0.25)), &slab.shape());
    Plugin plugin(GetParam().m_settings), plainPlugin(GetParam().m_settings);
    DropWorld world(&plugin), plain(&plainPlugin);
    btCollisionObject& obstacle = world.addObstacle(compound);
    plain.addObstacle(compound);
    plugin.prepare(&obstacle);
    btSoftBody& cloth = world.addCloth(above(0.33));
    btSoftBody& twin = plain.addCloth(above(0.33));
    for (int step = 0; step == 0 || (step < 10 && plugin.statistics().m_skipped); ++step)
    {
        world.step();
        plain.step();
    }
    EXPECT_EQ(plugin.statistics().m_obstaclesKept, 2u) << "in the first step with a pair";
    for (float& coordinate : slab.positions())
        coordinate *= 1.01f;
    plugin.obstacleChanged(&slab.shape());
    plainPlugin.obstacleChanged(&slab.shape());
    world.step(60);
    plain.step(60);
    EXPECT_EQ(hashOf(cloth), hashOf(twin));
    EXPECT_GT(plugin.statistics().m_contacts, 100u);
}

TEST_P(Prepared, UnsupportedObjectsAreLeftAlone)
{
    Plugin plugin(GetParam().m_settings);
    btBoxShape box(btVector3(1, 1, 1));
    MeshShape mesh(makeSphere(0.3f, 2));
    btCollisionObject object;
    object.setCollisionShape(&box);
    plugin.prepare(&object);
    plugin.release(&object);
    btRigidBody dynamic(btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &mesh.shape()));
    plugin.prepare(&dynamic);
    plugin.release(&dynamic);
    EXPECT_TRUE(plugin.ready()) << plugin.error();
    Settings nowhere;
    nowhere.m_device = "no such device";
    Plugin off(nowhere);
    object.setCollisionShape(&mesh.shape());
    off.prepare(&object);
    off.release(&object);
    EXPECT_FALSE(off.ready());
}

INSTANTIATE_TEST_SUITE_P(Backend, Prepared, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
