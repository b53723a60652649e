// Drape's integration into a Bullet world, and the choice of an obstacle's pose.
#include <gtest/gtest.h>

#include <string>

#include "BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"

namespace drape::test
{
namespace
{
constexpr int kSteps = 60;

ClothSpec clothAt(const btVector3& centre)
{
    ClothSpec spec;
    spec.m_nodes = 13;
    spec.m_centre = centre;
    return spec;
}

const ClothSpec kAboveSphere = clothAt(btVector3(btScalar(0.02), btScalar(0.5), btScalar(-0.03)));

btTransform tilted()
{
    return btTransform(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)),
                       btVector3(btScalar(0.3), btScalar(-0.2), btScalar(0.1)));
}

// Drops a cloth on the shape at the pose; `mesh` is where its triangles then are.
void expectHeld(btCollisionShape& shape, const btTransform& pose, const TriangleMesh& mesh)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btCollisionObject& object = world.addObstacle(shape, pose);
    const Bounds bounds = boundsOf(mesh);
    btSoftBody& cloth = world.addCloth(
        clothAt(btVector3(btScalar(0.5f * (bounds.m_low[0] + bounds.m_high[0])), btScalar(bounds.m_high[1] + 0.1f),
                          btScalar(0.5f * (bounds.m_low[2] + bounds.m_high[2])))));
    EXPECT_EQ(plugin.whyStock(&cloth, &object), "");
    const Course course = runMeasured(world, cloth, mesh, kSteps);
    expectClean(course);
    EXPECT_GT(plugin.statistics().m_contacts, 0u);
    EXPECT_NEAR(course.m_end.m_gapMin, kThickness, 0.1 * kThickness);
    for (const ContactInfo& contact : plugin.contacts())
        ASSERT_EQ(contact.m_obstacle, &object);
}
}  // namespace

TEST(Wiring, InstallOnALivingDispatcherEqualsTheConfiguration)
{
    MeshShape shape(makeSphere(0.4f, 2));
    Plugin configured(hostSettings()), installed(hostSettings());
    DropWorld first(&configured), second(&installed, Wiring::SolverOnly);
    install(installed, second.dispatcher(), second.world());
    first.addObstacle(shape.shape());
    second.addObstacle(shape.shape());
    btSoftBody& one = first.addCloth(kAboveSphere);
    btSoftBody& two = second.addCloth(kAboveSphere);
    first.step(kSteps);
    second.step(kSteps);
    EXPECT_GT(installed.statistics().m_contacts, 0u);
    EXPECT_EQ(hashOf(one), hashOf(two));
}

// The solver alone, with Bullet's own configuration, is easily mistaken for a complete setup.
TEST(Wiring, WhyStockNamesADispatcherWithoutDrape)
{
    MeshShape shape(makeSphere(0.4f, 2));
    Plugin plugin(hostSettings());
    DropWorld world(&plugin, Wiring::SolverOnly);
    btCollisionObject& object = world.addObstacle(shape.shape());
    btSoftBody& cloth = world.addCloth(kAboveSphere);
    EXPECT_NE(plugin.whyStock(&cloth, &object).find("drape::install()"), std::string::npos);
    install(plugin, world.dispatcher(), world.world());
    EXPECT_EQ(plugin.whyStock(&cloth, &object), "");
}

TEST(Wiring, InstallTakesOverPairsThatExist)
{
    const TriangleMesh mesh = makeBox(3.0f, 0.4f, 3.0f);
    MeshShape shape(mesh);
    Plugin plugin(hostSettings());
    DropWorld world(&plugin, Wiring::SolverOnly);
    world.addObstacle(shape.shape());
    btSoftBody& cloth = world.addCloth(clothAt(btVector3(0, btScalar(0.23), 0)));
    world.step(2);
    EXPECT_EQ(plugin.statistics().m_contacts, 0u) << "Bullet's own algorithm has the pair";
    install(plugin, world.dispatcher(), world.world());
    expectClean(runMeasured(world, cloth, mesh, kSteps));
    EXPECT_GT(plugin.statistics().m_contacts, 0u);
}

namespace
{
// A cloth just above a box of triangles.
struct OwnedWorld
{
    OwnedWorld(Plugin* plugin, Wiring wiring)
        : m_shape(makeBox(3.0f, 0.4f, 3.0f)),
          m_world(plugin, wiring),
          m_object(m_world.addObstacle(m_shape.shape())),
          m_cloth(m_world.addCloth(clothAt(btVector3(0, btScalar(0.225), 0))))
    {
    }

    void expectDrapeHasIt(const Plugin& plugin)
    {
        m_world.step(5);
        EXPECT_EQ(plugin.whyStock(&m_cloth, &m_object), "");
        EXPECT_GT(plugin.statistics().m_contacts, 0u);
        EXPECT_EQ(contactsHeld(m_cloth), 0);
    }
    // Steps until Bullet's own algorithm has found contacts.
    void expectBulletHasIt()
    {
        int most = 0;
        for (int i = 0; i < 30 && most == 0; ++i)
        {
            m_world.step();
            most = contactsHeld(m_cloth);
        }
        EXPECT_GT(most, 0);
    }
    void expectReason(const Plugin& plugin, const std::string& word)
    {
        const std::string reason = plugin.whyStock(&m_cloth, &m_object);
        EXPECT_NE(reason.find(word), std::string::npos) << "'" << reason << "'";
    }

    MeshShape m_shape;
    DropWorld m_world;
    btCollisionObject& m_object;
    btSoftBody& m_cloth;
};
}  // namespace

TEST(Wiring, ADispatcherKeepsItsPluginWhenAnotherIsInstalled)
{
    for (const Wiring wiring : {Wiring::Configuration, Wiring::SolverOnly})
    {
        SCOPED_TRACE(int(wiring));
        Plugin first(hostSettings()), second(hostSettings());
        OwnedWorld scene(&first, wiring);
        const bool isInstalled =
            wiring == Wiring::Configuration || install(first, scene.m_world.dispatcher(), scene.m_world.world());
        EXPECT_TRUE(isInstalled);
        EXPECT_FALSE(install(second, scene.m_world.dispatcher(), scene.m_world.world()));
        scene.expectDrapeHasIt(first);
        scene.expectReason(second, "solver");
        EXPECT_TRUE(install(first, scene.m_world.dispatcher(), scene.m_world.world())) << "once more";
        scene.expectDrapeHasIt(first);
    }
}

TEST(Wiring, UninstallGivesPairsBackToBullet)
{
    for (const Wiring wiring : {Wiring::Configuration, Wiring::SolverOnly})
    {
        SCOPED_TRACE(int(wiring));
        Plugin first(hostSettings()), second(hostSettings());
        OwnedWorld scene(&first, wiring);
        btCollisionDispatcher& dispatcher = scene.m_world.dispatcher();
        if (wiring == Wiring::SolverOnly) install(first, dispatcher, scene.m_world.world());
        EXPECT_FALSE(uninstall(second, dispatcher, scene.m_world.world()));
        scene.expectDrapeHasIt(first);
        EXPECT_TRUE(uninstall(first, dispatcher, scene.m_world.world()));
        EXPECT_FALSE(uninstall(first, dispatcher, scene.m_world.world()));
        scene.expectReason(first, "drape::install()");
        scene.expectBulletHasIt();
        EXPECT_TRUE(install(second, dispatcher, scene.m_world.world()));
        scene.expectReason(second, "solver");
        scene.expectReason(first, "another plugin");
        scene.expectBulletHasIt();
        EXPECT_TRUE(uninstall(second, dispatcher, scene.m_world.world()));
        EXPECT_TRUE(install(first, dispatcher, scene.m_world.world()));
        scene.expectDrapeHasIt(first);
    }
}

// The solver of a body does not decide which solver steps it.
TEST(Wiring, ABodyGivenAnotherPluginsSolverStaysWithTheSolverOfItsWorld)
{
    Plugin first(hostSettings()), second(hostSettings());
    SoftBodySolver other(second);
    OwnedWorld scene(&first, Wiring::Configuration);
    scene.m_cloth.setSoftBodySolver(&other);
    scene.expectDrapeHasIt(first);
    scene.expectReason(second, "algorithm");
}

TEST(Wiring, ABodyWhoseSolverStepsNoWorldIsLeftToBullet)
{
    Plugin plugin(hostSettings());
    SoftBodySolver solver(plugin);
    OwnedWorld scene(nullptr, Wiring::SolverOnly);
    EXPECT_TRUE(install(plugin, scene.m_world.dispatcher(), scene.m_world.world()));
    scene.m_cloth.setSoftBodySolver(&solver);
    scene.expectBulletHasIt();
    scene.expectReason(plugin, "solver");
}

// Bullet orders a pair by the age of its members, so the order of adding gives both.
TEST(Wiring, BothOrdersOfAPairGiveTheSameMotion)
{
    MeshShape shape(makeSphere(0.4f, 2));
    Plugin plugin(hostSettings());
    DropWorld meshFirst(&plugin), clothFirst(&plugin);
    meshFirst.addObstacle(shape.shape());
    btSoftBody& one = meshFirst.addCloth(kAboveSphere);
    btSoftBody& two = clothFirst.addCloth(kAboveSphere);
    clothFirst.addObstacle(shape.shape());
    meshFirst.step(kSteps);
    EXPECT_GT(plugin.statistics().m_contacts, 0u);
    clothFirst.step(kSteps);
    EXPECT_GT(plugin.statistics().m_contacts, 0u);
    EXPECT_EQ(hashOf(one), hashOf(two));
}

TEST(Wiring, ThePoseOfTheObjectIsUsed)
{
    const TriangleMesh mesh = makeStairs(1.0f, 0.5f, 1.0f, 3);
    MeshShape shape(mesh);
    expectHeld(shape.shape(), tilted(), placed(mesh, tilted()));
}

TEST(Wiring, TheTransformOfACompoundsChildIsUsed)
{
    const TriangleMesh mesh = makeTorus(0.4f, 0.15f, 24, 12);
    MeshShape shape(mesh);
    const btTransform child(btQuaternion(btVector3(0, 0, 1), btScalar(1.1)), btVector3(btScalar(-0.4), 1, 0));
    btCompoundShape compound;
    compound.addChildShape(child, &shape.shape());
    expectHeld(compound, tilted(), placed(mesh, tilted() * child));
}

TEST(Wiring, TwoChildrenOfTheSameShapeAreTwoObstacles)
{
    const TriangleMesh mesh = makeSphere(0.2f, 2);
    MeshShape shape(mesh);
    btCompoundShape compound;
    TriangleMesh both;
    for (const btScalar x : {btScalar(-0.3), btScalar(0.3)})
    {
        const btTransform child(btQuaternion::getIdentity(), btVector3(x, 0, 0));
        compound.addChildShape(child, &shape.shape());
        const TriangleMesh moved = placed(mesh, child);
        const std::int32_t offset = static_cast<std::int32_t>(both.vertexCount());
        both.m_positions.insert(both.m_positions.end(), moved.m_positions.begin(), moved.m_positions.end());
        for (std::int32_t index : moved.m_triangles)
            both.m_triangles.push_back(offset + index);
    }
    expectHeld(compound, btTransform::getIdentity(), both);
}

TEST(Wiring, ScaledAndMirroredShapesAreHandled)
{
    const TriangleMesh mesh = makeStairs(1.0f, 0.5f, 1.0f, 3);
    for (const btVector3& scaling : {btVector3(btScalar(0.7), btScalar(1.3), btScalar(0.9)),
                                     btVector3(btScalar(-0.8), btScalar(1.1), 1), btVector3(-1, 1, btScalar(-0.9))})
    {
        SCOPED_TRACE(testing::Message() << scaling.x() << " " << scaling.y() << " " << scaling.z());
        MeshShape shape(mesh);
        btScaledBvhTriangleMeshShape scaled(&shape.shape(), scaling);
        scaled.setMargin(kMargin);
        expectHeld(scaled, tilted(), placed(mesh, tilted(), scaling));
    }
}

// Bullet's bounds of a scaled shape include the margin of the unscaled shape, here 0.
TEST(Wiring, AScaledShapeKeepsItsOwnMargin)
{
    constexpr float kOwn = 0.1f;
    MeshShape shape(makeBox(3.0f, 0.4f, 3.0f));
    shape.shape().setMargin(0);
    btScaledBvhTriangleMeshShape scaled(&shape.shape(), btVector3(1, 1, 1));
    scaled.setMargin(kOwn);
    btCompoundShape compound;
    compound.addChildShape(btTransform::getIdentity(), &scaled);
    for (btCollisionShape* ground :
         {static_cast<btCollisionShape*>(&scaled), static_cast<btCollisionShape*>(&compound)})
    {
        SCOPED_TRACE(ground->getName());
        Plugin plugin(hostSettings());
        DropWorld world(&plugin);
        world.addObstacle(*ground);
        btSoftBody& cloth = world.addCloth(clothAt(btVector3(0, btScalar(0.4), 0)));
        world.step(2 * kSteps);
        for (int step = 0; step < 30; ++step)
        {
            world.step();
            ASSERT_GT(plugin.statistics().m_contacts, 0u) << "step " << step;
            ASSERT_NEAR(static_cast<double>(lowestOf(cloth)) - 0.2, double(kMargin + kOwn), 0.02 * double(kOwn));
        }
    }
}

TEST(Wiring, AMirroredShapeKeepsItsFront)
{
    const TriangleMesh mesh = makeBox(3.0f, 0.4f, 3.0f);
    MeshShape shape(mesh);
    for (const btScalar scale : {btScalar(1), btScalar(-1)})
    {
        SCOPED_TRACE(testing::Message() << "scaled by " << scale);
        btScaledBvhTriangleMeshShape scaled(&shape.shape(), btVector3(scale, 1, 1));
        scaled.setMargin(kMargin);
        Plugin plugin(hostSettings());
        plugin.setOneSided(&shape.shape(), true);
        DropWorld world(&plugin);
        world.addObstacle(scaled);
        btSoftBody& cloth = world.addCloth(clothAt(btVector3(0, btScalar(0.24), 0)));
        world.step(kSteps);
        EXPECT_NEAR(static_cast<double>(lowestOf(cloth)) - 0.2, kThickness, 0.1 * kThickness);
    }
}

TEST(Wiring, VerticesMovedInPlaceAreNoticed)
{
    const TriangleMesh mesh = makeBox(3.0f, 0.4f, 3.0f);
    MeshShape shape(mesh);
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btCollisionObject& object = world.addObstacle(shape.shape());
    btSoftBody& cloth = world.addCloth(clothAt(btVector3(0, btScalar(0.24), 0)));
    world.step(kSteps);
    for (std::size_t i = 1; i < shape.positions().size(); i += 3)
        shape.positions()[i] -= 0.1f;
    shape.shape().refitTree(btVector3(-2, -1, -2), btVector3(2, 1, 2));
    world.world().updateSingleAabb(&object);
    plugin.obstacleChanged(&shape.shape());
    world.step(2 * kSteps);
    EXPECT_NEAR(static_cast<double>(lowestOf(cloth)) - 0.1, kThickness, 0.1 * kThickness);
}
}  // namespace drape::test
