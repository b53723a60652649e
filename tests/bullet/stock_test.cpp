// Pairs that Drape leaves to Bullet: the reason it gives, and that Bullet's own algorithm really has them.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "BulletCollision/Gimpact/btGImpactShape.h"
#include "BulletCollision/CollisionShapes/btBox2dShape.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/environment.h"
#include "tests/support/own_process.h"

namespace drape::test
{
namespace
{
class Stock : public testing::Test
{
protected:
    Stock() : m_plugin(hostSettings()), m_shape(makeBox(2.0f, 0.4f, 2.0f)), m_world(&m_plugin) {}

    btSoftBody& addCloth()
    {
        ClothSpec spec;
        spec.m_nodes = 9;
        spec.m_size = 0.6f;
        spec.m_centre = btVector3(0, btScalar(0.25), 0);
        return m_world.addCloth(spec);
    }

    void expectReason(const btSoftBody& cloth, const btCollisionObject& obstacle, const std::string& word) const
    {
        const std::string reason = m_plugin.whyStock(&cloth, &obstacle);
        EXPECT_NE(reason.find(word), std::string::npos) << "'" << reason << "' does not speak of '" << word << "'";
        EXPECT_EQ(reason, m_plugin.whyStock(&obstacle, &cloth));
        EXPECT_EQ(reason.find('\n'), std::string::npos);
    }

    // Bullet's algorithm finds contacts in this many steps, and Drape has no part in it.
    void expectBulletHasIt(const btSoftBody& cloth, int steps)
    {
        int most = 0;
        for (int i = 0; i < steps; ++i)
        {
            m_world.step();
            most = std::max(most, contactsHeld(cloth));
            ASSERT_EQ(m_plugin.statistics().m_contacts, 0u);
        }
        EXPECT_GT(most, 0);
    }

    Plugin m_plugin;
    MeshShape m_shape;
    DropWorld m_world;
};
}  // namespace

TEST_F(Stock, DrapeTakesAStaticMesh)
{
    EXPECT_EQ(m_plugin.whyStock(&addCloth(), &m_world.addObstacle(m_shape.shape())), "");
}

TEST_F(Stock, DrapeTakesAKinematicMesh)
{
    EXPECT_EQ(m_plugin.whyStock(&addCloth(), &m_world.addKinematic(m_shape.shape())), "");
}

TEST_F(Stock, DrapeTakesTheShapesOfADynamicBody)
{
    btBoxShape box(btVector3(1, btScalar(0.2), 1));
    for (btCollisionShape* shape :
         {static_cast<btCollisionShape*>(&m_shape.shape()), static_cast<btCollisionShape*>(&box)})
    {
        btRigidBody body(btScalar(1), nullptr, shape, btVector3(1, 1, 1));
        EXPECT_EQ(m_plugin.whyStock(&addCloth(), &body), "");
    }
}

TEST_F(Stock, ADynamicBodyIsLeftToBulletBesideClothThatBulletSolves)
{
    btRigidBody body(btScalar(1), nullptr, &m_shape.shape(), btVector3(1, 1, 1));
    btSoftBody& cloth = addCloth();
    cloth.m_cfg.viterations = 1;
    expectReason(cloth, body, "Bullet solves the soft body's links");
}

TEST(DynamicConvexShapes, AreLeftToBulletOnRequest)
{
    Settings settings = hostSettings();
    settings.m_dynamicConvex = ShapeContacts::Bullet;
    Plugin plugin(settings);
    DropWorld world(&plugin);
    btBoxShape box(btVector3(1, btScalar(0.2), 1));
    btRigidBody& body = world.addDynamic(box, 1, btTransform::getIdentity());
    EXPECT_NE(plugin.whyStock(&world.addCloth(ClothSpec()), &body).find("m_dynamicConvex"), std::string::npos);
}

TEST_F(Stock, AMeshThatTurnsDynamicAndBackChangesItsOwnerBothTimes)
{
    btCollisionObject& object = m_world.addObstacle(m_shape.shape());
    btSoftBody& cloth = addCloth();
    m_world.step(60);
    EXPECT_GT(m_plugin.statistics().m_contacts, 0u);
    object.setCollisionFlags(0);
    expectReason(cloth, object, "dynamic");
    expectBulletHasIt(cloth, 3);
    object.setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
    // Bullet's algorithm threw the cloth.
    for (int i = 0; i < 30 && m_plugin.statistics().m_contacts == 0; ++i)
        m_world.step();
    EXPECT_GT(m_plugin.statistics().m_contacts, 0u);
}

TEST_F(Stock, ClusterModeIsLeftToBullet)
{
    btCollisionObject& object = m_world.addObstacle(m_shape.shape());
    btSoftBody& cloth = addCloth();
    cloth.generateClusters(4);
    cloth.m_cfg.collisions = btSoftBody::fCollision::CL_RS;
    expectReason(cloth, object, "cluster");
    m_world.step(10);
    EXPECT_EQ(m_plugin.statistics().m_contacts, 0u);
}

TEST_F(Stock, DrapeTakesAGImpactMesh)
{
    btTriangleMesh triangles;
    triangles.addTriangle(btVector3(-1, 0, -1), btVector3(0, 0, 1), btVector3(1, 0, -1));
    btGImpactMeshShape shape(&triangles);
    shape.updateBound();
    EXPECT_EQ(m_plugin.whyStock(&addCloth(), &m_world.addObstacle(shape)), "");
}

TEST_F(Stock, AGImpactCompoundIsLeftToBullet)
{
    btGImpactCompoundShape shape;
    btBoxShape box(btVector3(1, 1, 1));
    shape.addChildShape(btTransform::getIdentity(), &box);
    shape.updateBound();
    expectReason(addCloth(), m_world.addObstacle(shape), "not a triangle mesh");
}

TEST_F(Stock, TheReasonNamesTheChildOfACompound)
{
    btBox2dShape box(btVector3(1, 1, 1));
    btCompoundShape compound;
    compound.addChildShape(btTransform::getIdentity(), &m_shape.shape());
    compound.addChildShape(btTransform::getIdentity(), &box);
    expectReason(addCloth(), m_world.addObstacle(compound), "child 1");
}

// Bullet's own algorithm takes a compound's mesh to be where the compound is.
TEST_F(Stock, AMeshInACompoundIsLeftToBulletAtItsPose)
{
    Settings settings;
    settings.m_backend = Backend::OpenCl;
    settings.m_device = "no such device";
    Plugin plugin(settings);
    ASSERT_FALSE(plugin.ready());
    for (const bool shifted : {false, true})
    {
        SCOPED_TRACE(shifted);
        DropWorld world(&plugin);
        const btTransform place(btQuaternion::getIdentity(), btVector3(0, shifted ? btScalar(0.01) : btScalar(0), 0));
        btCompoundShape compound, nested;
        nested.addChildShape(place, &m_shape.shape());
        compound.addChildShape(btTransform::getIdentity(), &nested);
        const btTransform pose(btQuaternion(btVector3(0, 1, 0), btScalar(0.5)), btVector3(btScalar(0.1), 0, 0));
        btCollisionObject& object = world.addObstacle(compound, pose);
        ClothSpec spec;
        spec.m_centre = btVector3(0, btScalar(0.25), 0);
        btSoftBody& cloth = world.addCloth(spec);
        const std::string reason = plugin.whyStock(&cloth, &object);
        EXPECT_NE(reason.find("child 0"), std::string::npos) << reason;
        EXPECT_EQ(reason.find("collides with nothing") != std::string::npos, shifted) << reason;
        int most = 0;
        for (int step = 0; step < 30; ++step)
        {
            world.step();
            most = std::max(most, contactsHeld(cloth));
        }
        EXPECT_EQ(most == 0, shifted) << most << " contacts";
        world.remove(cloth);
    }
}

TEST_F(Stock, AMeshMovedInACompoundThatDrapeLeavesHasNoContacts)
{
    btCompoundShape compound;
    const btTransform place(btQuaternion::getIdentity(), btVector3(0, btScalar(0.01), 0));
    compound.addChildShape(place, &m_shape.shape());
    btCollisionObject& object = m_world.addObstacle(compound);
    btSoftBody& cloth = addCloth();
    EXPECT_EQ(m_plugin.whyStock(&cloth, &object), "");
    cloth.generateClusters(4);
    cloth.m_cfg.collisions = btSoftBody::fCollision::CL_RS;
    expectReason(cloth, object, "collides with nothing");
    expectReason(cloth, object, "child 0");
    m_world.step(10);
    EXPECT_EQ(contactsHeld(cloth), 0);
}

TEST_F(Stock, ASoftBodyMayOutliveItsSolver)
{
    btSoftBodyWorldInfo info;
    const btVector3 places[] = {btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 0, 1)};
    btSoftBody cloth(&info, 3, places, nullptr);
    cloth.appendFace(0, 1, 2);
    btCollisionObject& object = m_world.addObstacle(m_shape.shape());
    {
        SoftBodySolver solver(m_plugin);
        cloth.setSoftBodySolver(&solver);
        EXPECT_EQ(m_plugin.whyStock(&cloth, &object), "");
    }
    expectReason(cloth, object, "solver");
    cloth.setSoftBodySolver(nullptr);
    expectReason(cloth, object, "deformable world");
}

TEST_F(Stock, OtherPairsThanClothAndObstacleAreLeftToBullet)
{
    btCollisionObject shapeless;
    expectReason(addCloth(), shapeless, "no collision shape");
    EXPECT_NE(m_plugin.whyStock(nullptr, &shapeless), "");
    m_plugin.prepare(&shapeless);
    btCollisionObject& object = m_world.addObstacle(m_shape.shape());
    btSoftBody &one = addCloth(), &two = addCloth();
    EXPECT_NE(m_plugin.whyStock(&object, &object), "");
    EXPECT_NE(m_plugin.whyStock(&one, &two), "");
}

TEST_F(Stock, AWorldWithoutDrapesSolverIsLeftToBullet)
{
    DropWorld other(nullptr);
    btCollisionObject& object = other.addObstacle(m_shape.shape());
    expectReason(other.addCloth(ClothSpec()), object, "solver");
}

TEST(StockWithoutDevice, AnUnknownDeviceIsAnErrorThatListsTheDevices)
{
    Settings settings;
    settings.m_device = "no device has this name";
    for (const Backend backend : {Backend::Auto, Backend::OpenCl})
    {
        settings.m_backend = backend;
        const Plugin plugin(settings);
        EXPECT_FALSE(plugin.ready());
        EXPECT_NE(plugin.error().find(settings.m_device), std::string::npos) << plugin.error();
        for (const DeviceInfo& device : listDevices())
            EXPECT_NE(plugin.error().find(device.m_name), std::string::npos) << plugin.error();
        EXPECT_FALSE(plugin.report().empty());
    }
}

TEST(StockWithoutDevice, AFailingDeviceThatWasNotRequestedLeavesTheHost)
{
    const std::vector<DeviceInfo> devices = listDevices();
    if (devices.empty() || devices[0].m_platform != "Portable Computing Language")
        GTEST_SKIP() << "only PoCL, where it would be chosen, can be told to fail";
    inOwnProcess(
        [&]
        {
            const ScopedVariable unnamed("DRAPE_DEVICE", nullptr), broken("POCL_EXTRA_BUILD_FLAGS", "-Dvec3Sub=@");
            Settings settings;
            settings.m_cacheFolder = "none";
            settings.m_backend = Backend::ByCost;
            std::vector<std::string> lines;
            settings.m_log = [&lines](const char* line) { lines.push_back(line); };
            Plugin plugin(settings);
            EXPECT_TRUE(lines.empty());
            plugin.awaitDevice();
            ASSERT_EQ(lines.size(), 1u);
            EXPECT_EQ(lines[0].find("the host computes: building "), 0u) << lines[0];
            EXPECT_EQ(lines[0].find('\n'), std::string::npos) << lines[0];
            EXPECT_TRUE(plugin.ready());
            EXPECT_NE(plugin.error().find(".cl"), std::string::npos) << plugin.error();
            EXPECT_NE(plugin.report().find("the host, since " + devices[0].m_name + " failed"), std::string::npos)
                << plugin.report();
            MeshShape shape(makeBox(2.0f, 0.4f, 2.0f));
            DropWorld world(&plugin);
            btCollisionObject& object = world.addObstacle(shape.shape());
            ClothSpec spec;
            spec.m_nodes = 9;
            spec.m_centre = btVector3(0, btScalar(0.25), 0);
            btSoftBody& cloth = world.addCloth(spec);
            EXPECT_EQ(plugin.whyStock(&cloth, &object), "");
            for (int i = 0; i < 30; ++i)
                world.step();
            EXPECT_FALSE(plugin.contacts().empty());
            EXPECT_EQ(plugin.statistics().m_status, std::uint32_t(kStepDeviceFailed));
            world.remove(object);
            world.step();
            EXPECT_TRUE(plugin.statistics().m_skipped);
            EXPECT_EQ(plugin.statistics().m_status, std::uint32_t(kStepDeviceFailed)) << "a step without a pair";
        });
}

TEST(StockWithoutDevice, TheAppRunsOnWithBulletsOwnCollision)
{
    Settings settings;
    settings.m_device = "no device has this name";
    Plugin plugin(settings);
    MeshShape shape(makeBox(2.0f, 0.4f, 2.0f));
    DropWorld world(&plugin), plain(nullptr);
    btCollisionObject& object = world.addObstacle(shape.shape());
    plain.addObstacle(shape.shape());
    ClothSpec spec;
    spec.m_nodes = 9;
    spec.m_centre = btVector3(0, btScalar(0.25), 0);
    btSoftBody &cloth = world.addCloth(spec), &same = plain.addCloth(spec);
    EXPECT_NE(plugin.whyStock(&cloth, &object).find("could not start"), std::string::npos);
    int contacts = 0;
    for (int i = 0; i < 30; ++i)
    {
        world.step();
        plain.step();
        contacts = std::max(contacts, contactsHeld(cloth));
        ASSERT_EQ(hashOf(cloth), hashOf(same)) << "step " << i;
    }
    EXPECT_GT(contacts, 0);
}
}  // namespace drape::test
