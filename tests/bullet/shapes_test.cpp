// Convex shapes at rest and moved by the app, children that move in compounds, and links of multibodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>

#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletCollision/CollisionShapes/btStaticPlaneShape.h"
#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "BulletSoftBody/btSoftMultiBodyDynamicsWorld.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
btTransform at(const btVector3& place)
{
    return btTransform(btQuaternion::getIdentity(), place);
}

ClothSpec clothAt(btScalar height)
{
    ClothSpec spec;
    spec.m_centre = btVector3(0, height, 0);
    return spec;
}

// Returns the number of triangles of cloth and mesh that intersect.
std::size_t pairsOf(const btSoftBody& cloth, const TriangleMesh& mesh)
{
    return PenetrationMeter(mesh, meshOf(cloth)).measure(positionsOf(cloth).data()).m_intersectingPairs;
}

// Steps until the cloth rests, and requires that it never intersects the mesh.
void expectHeld(DropWorld& world, const btSoftBody& cloth, const TriangleMesh& mesh)
{
    for (int i = 0; i < 150; ++i)
    {
        world.step();
        ASSERT_EQ(pairsOf(cloth, mesh), 0u) << "step " << i;
    }
    EXPECT_GT(cloth.m_nodes[cloth.m_nodes.size() / 2].m_x.y(), 0);
}

// Blades of boxes in a nested compound, whose inner children an app turns.
class Fan
{
public:
    Fan() : m_blade(btVector3(btScalar(0.4), btScalar(0.02), btScalar(0.15)))
    {
        m_inner.addChildShape(at(btVector3(btScalar(0.45), 0, 0)), &m_blade);
        m_inner.addChildShape(at(btVector3(btScalar(-0.45), 0, 0)), &m_blade);
        m_outer.addChildShape(at(btVector3(0, btScalar(0.1), 0)), &m_inner);
    }
    // angle: about z, radians. Blades turn with the inner compound, and each about its own axis, too.
    void turn(btScalar angle)
    {
        m_outer.updateChildTransform(
            0, btTransform(btQuaternion(btVector3(0, 0, 1), angle), btVector3(0, btScalar(0.1), 0)));
        m_inner.updateChildTransform(
            1, btTransform(btQuaternion(btVector3(1, 0, 0), angle), btVector3(btScalar(-0.45), 0, 0)));
    }
    std::vector<TriangleMesh> blades(const btTransform& pose)
    {
        std::vector<TriangleMesh> all;
        for (int i = 0; i < 2; ++i)
            all.push_back(
                placed(makeBox(0.8f, 0.04f, 0.3f), pose * m_outer.getChildTransform(0) * m_inner.getChildTransform(i)));
        return all;
    }
    btCompoundShape& shape() { return m_outer; }

private:
    btBoxShape m_blade;
    btCompoundShape m_inner, m_outer;
};

class MovingChildren : public BackendTest
{
};

// An arm that a motor turns about z at the origin: a base and one link, in a world of multibodies.
class ArmWorld
{
public:
    explicit ArmWorld(Plugin* plugin)
        : m_configuration(plugin ? std::unique_ptr<btCollisionConfiguration>(new CollisionConfiguration(*plugin))
                                 : std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>()),
          m_softSolver(plugin ? std::make_unique<SoftBodySolver>(*plugin) : nullptr),
          m_dispatcher(m_configuration.get()),
          m_world(&m_dispatcher, &m_broadphase, &m_solver, m_configuration.get(), m_softSolver.get()),
          m_blade(btVector3(btScalar(0.5), btScalar(0.03), btScalar(0.5))),
          m_arm(1, 0, btVector3(0, 0, 0), true, false)
    {
        m_world.setGravity(btVector3(0, btScalar(-9.81), 0));
        m_world.getWorldInfo().m_gravity = m_world.getGravity();
        m_arm.setupRevolute(0, btScalar(5), btVector3(1, 1, 1), -1, btQuaternion::getIdentity(), btVector3(0, 0, 1),
                            btVector3(0, 0, 0), btVector3(btScalar(0.5), 0, 0));
        m_arm.finalizeMultiDof();
        m_world.addMultiBody(&m_arm);
        m_link = std::make_unique<btMultiBodyLinkCollider>(&m_arm, 0);
        m_link->setCollisionShape(&m_blade);
        m_link->setFriction(1);
        m_world.addCollisionObject(m_link.get());
        m_arm.getLink(0).m_collider = m_link.get();
        m_arm.setCanSleep(false);
        btAlignedObjectArray<btQuaternion> turns;
        btAlignedObjectArray<btVector3> places;
        m_arm.updateCollisionObjectWorldTransforms(turns, places);
        ClothSpec spec = clothAt(btScalar(0.2));
        spec.m_size = btScalar(0.8f);
        spec.m_centre.setX(btScalar(0.5));
        m_cloth = makeCloth(m_world.getWorldInfo(), spec);
        m_world.addSoftBody(m_cloth.get());
    }
    ~ArmWorld()
    {
        m_world.removeSoftBody(m_cloth.get());
        m_world.removeCollisionObject(m_link.get());
        m_world.removeMultiBody(&m_arm);
    }
    // speed: rad/s. The link keeps it whatever it carries.
    void step(btScalar speed)
    {
        m_arm.setJointVel(0, speed);
        m_world.stepSimulation(kDt, 0);
    }

    std::unique_ptr<btCollisionConfiguration> m_configuration;
    std::unique_ptr<btSoftBodySolver> m_softSolver;
    btCollisionDispatcher m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btMultiBodyConstraintSolver m_solver;
    btSoftMultiBodyDynamicsWorld m_world;
    btBoxShape m_blade;
    btMultiBody m_arm;
    std::unique_ptr<btMultiBodyLinkCollider> m_link;
    std::unique_ptr<btSoftBody> m_cloth;
};
}  // namespace

TEST(ConvexShapes, HoldClothAtRest)
{
    btBoxShape box(btVector3(btScalar(0.4), btScalar(0.1), btScalar(0.4)));
    btSphereShape ball(btScalar(0.3));
    btCapsuleShape capsule(btScalar(0.15), btScalar(0.6));
    btConeShape cone(btScalar(0.4), btScalar(0.3));
    btConvexHullShape hull;
    for (int i = 0; i < 8; ++i)
        hull.addPoint(btVector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1) * btScalar(0.2));
    const std::pair<btConvexShape*, TriangleMesh> cases[] = {{&box, makeBox(0.8f, 0.2f, 0.8f)},
                                                             {&ball, makeSphere(0.29f, 3)},
                                                             {&capsule, makeSphere(0.14f, 3)},
                                                             {&cone, makeBox(0.02f, 0.25f, 0.02f)},
                                                             {&hull, makeBox(0.4f, 0.4f, 0.4f)}};
    for (const auto& [shape, mesh] : cases)
    {
        SCOPED_TRACE(shape->getName());
        shape->setMargin(kMargin);
        Plugin plugin(hostSettings());
        DropWorld world(&plugin);
        btCollisionObject& object = world.addObstacle(*shape, at(btVector3(0, btScalar(0.5), 0)));
        btSoftBody& cloth = world.addCloth(clothAt(btScalar(1.2)));
        EXPECT_EQ(plugin.whyStock(&cloth, &object), "");
        expectHeld(world, cloth, placed(mesh, object.getWorldTransform()));
        EXPECT_EQ(contactsHeld(cloth), 0);
    }
}

// A board that moves by several times its thickness in a step.
TEST(ConvexShapes, PushClothWhenTheAppMovesThem)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btBoxShape board(btVector3(1, btScalar(0.02), 1));
    btRigidBody& body = world.addKinematic(board, at(btVector3(0, -1, 0)));
    btSoftBody& cloth = world.addCloth(clothAt(0));
    for (int i = 0; i < 60; ++i)
    {
        const btTransform pose = at(btVector3(0, btScalar(-1) + btScalar(0.25) * btScalar(i), 0));  // 15 m/s
        body.setWorldTransform(pose);
        world.step();
        ASSERT_EQ(pairsOf(cloth, placed(makeBox(2, 0.04f, 2), pose)), 0u) << "step " << i;
        ASSERT_GT(lowestOf(cloth), pose.getOrigin().y()) << "step " << i;
    }
}

TEST(ShapesAtRest, AreLeftToBulletOnRequest)
{
    btBoxShape box(btVector3(1, btScalar(0.2), 1));
    btStaticPlaneShape plane(btVector3(0, 1, 0), btScalar(0.2));
    for (const bool isPlane : {false, true})
    {
        Settings settings = hostSettings();
        (isPlane ? settings.m_surfaces : settings.m_staticConvex) = ShapeContacts::Bullet;
        Plugin plugin(settings);
        DropWorld world(&plugin);
        btCollisionShape& shape = isPlane ? static_cast<btCollisionShape&>(plane) : box;
        btCollisionObject& object = world.addObstacle(shape);
        btSoftBody& cloth = world.addCloth(clothAt(btScalar(0.3)));
        const std::string word = isPlane ? "m_surfaces" : "m_staticConvex";
        EXPECT_NE(plugin.whyStock(&cloth, &object).find(word), std::string::npos);
        int most = 0;
        for (int i = 0; i < 60; ++i)
        {
            world.step();
            most = std::max(most, contactsHeld(cloth));
            ASSERT_EQ(plugin.statistics().m_contacts, 0u);
        }
        EXPECT_GT(most, 0);
    }
}

// Bullet finds convex children where they are, also at another place than their compound's.
TEST(ConvexShapes, InACompoundAreLeftToBulletOnRequest)
{
    Settings settings = hostSettings();
    settings.m_staticConvex = ShapeContacts::Bullet;
    Plugin plugin(settings);
    DropWorld world(&plugin);
    btBoxShape box(btVector3(1, btScalar(0.2), 1));
    btCompoundShape compound;
    compound.addChildShape(at(btVector3(0, btScalar(0.5), 0)), &box);
    world.addObstacle(compound);
    btSoftBody& cloth = world.addCloth(clothAt(btScalar(0.75)));
    world.step(60);
    EXPECT_GT(contactsHeld(cloth), 0);
    EXPECT_GT(lowestOf(cloth), btScalar(0.69));
}

TEST_P(MovingChildren, OfNestedCompoundsPushCloth)
{
    for (const bool isKinematic : {false, true})
    {
        SCOPED_TRACE(isKinematic);
        Plugin plugin(GetParam().m_settings);
        DropWorld world(&plugin);
        Fan fan;
        btCollisionObject& object = isKinematic ? static_cast<btCollisionObject&>(world.addKinematic(fan.shape()))
                                                : world.addObstacle(fan.shape());
        btSoftBody& cloth = world.addCloth(clothAt(btScalar(0.25)));
        world.step(30);
        btScalar farthest = 0;
        for (int i = 0; i < 60; ++i)
        {
            fan.turn(btScalar(0.12) * btScalar(i));  // 7.2 rad/s: 0.1 m a step at the tips
            if (isKinematic) object.setWorldTransform(at(btVector3(0, btScalar(0.01) * btScalar(i), 0)));
            world.step();
            for (const TriangleMesh& blade : fan.blades(object.getWorldTransform()))
                ASSERT_EQ(pairsOf(cloth, blade), 0u) << "step " << i;
            ASSERT_EQ(plugin.statistics().m_status, kStepGood) << "step " << i;
            for (int node = 0; node < cloth.m_nodes.size(); ++node)
                farthest = std::max(farthest, cloth.m_nodes[node].m_x.length());
        }
        EXPECT_GT(farthest, btScalar(0.9)) << "nothing was pushed";
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, MovingChildren, testing::ValuesIn(allBackends()), backendName);

// A child arrives from below, at 15 m/s.
TEST(ChildrenOfCompounds, ThatAreTeleportedLeaveClothWhereItIs)
{
    for (const bool isAnnounced : {false, true})
    {
        Plugin plugin(hostSettings());
        DropWorld world(&plugin);
        btBoxShape box(btVector3(btScalar(0.3), btScalar(0.1), btScalar(0.3)));
        btCompoundShape compound;
        compound.addChildShape(at(btVector3(0, -1, 0)), &box);
        btCollisionObject& object = world.addObstacle(compound);
        const btSoftBody& cloth = world.addCloth(clothAt(0));
        world.world().getWorldInfo().m_gravity.setZero();
        for (int i = 0; i < 5; ++i)
        {
            compound.updateChildTransform(0, at(btVector3(0, btScalar(0.25) * btScalar(i) - 1, 0)));
            if (isAnnounced) plugin.teleported(&object);
            world.step();
        }
        EXPECT_EQ((plugin.statistics().m_status & kStepStartsIntersecting) != 0, isAnnounced);
        EXPECT_EQ(cloth.m_nodes[cloth.m_nodes.size() / 2].m_x.y() > btScalar(0.1), !isAnnounced);
    }
}

TEST(LinksOfMultibodies, PushClothAndCarryIt)
{
    Plugin plugin(hostSettings());
    ArmWorld scene(&plugin);
    EXPECT_EQ(plugin.whyStock(scene.m_cloth.get(), scene.m_link.get()), "");
    const TriangleMesh blade = makeBox(1, 0.06f, 1);
    for (int i = 0; i < 120; ++i)
    {
        const btScalar speed = i < 40 ? btScalar(0) : btScalar(3) * btCos(btScalar(i - 40) / 6);
        scene.step(speed);
        ASSERT_EQ(pairsOf(*scene.m_cloth, placed(blade, scene.m_link->getWorldTransform())), 0u) << "step " << i;
        ASSERT_EQ(plugin.statistics().m_status, kStepGood) << "step " << i;
        if (i == 39)
        {
            EXPECT_GT(plugin.statistics().m_contacts, 100u);
            EXPECT_EQ(plugin.whyBulletSolves(*scene.m_cloth), "");
        }
    }
    EXPECT_GT(lowestOf(*scene.m_cloth), -2);
}

// A floor as pybullet makes it: the base of a multibody that is fixed.
TEST(LinksOfMultibodies, ThatAreFixedHoldCloth)
{
    Plugin plugin(hostSettings());
    ArmWorld scene(&plugin);
    btStaticPlaneShape plane(btVector3(0, 1, 0), -1);
    btMultiBody floor(0, 0, btVector3(0, 0, 0), true, false);
    btMultiBodyLinkCollider base(&floor, -1);
    base.setCollisionShape(&plane);
    base.setCollisionFlags(base.getCollisionFlags() | btCollisionObject::CF_STATIC_OBJECT);
    floor.setBaseCollider(&base);
    floor.finalizeMultiDof();
    scene.m_world.addMultiBody(&floor);
    scene.m_world.addCollisionObject(&base, btBroadphaseProxy::StaticFilter,
                                     btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
    scene.m_world.removeCollisionObject(scene.m_link.get());
    EXPECT_EQ(plugin.whyStock(scene.m_cloth.get(), &base), "");
    for (int i = 0; i < 90; ++i)
        scene.step(0);
    EXPECT_NEAR(lowestOf(*scene.m_cloth), btScalar(-1) + kMargin, btScalar(0.2) * kMargin);
    scene.m_world.addCollisionObject(scene.m_link.get());
    scene.m_world.removeCollisionObject(&base);
    scene.m_world.removeMultiBody(&floor);
}

// The arm turns by a quarter of its thickness's width in a step: Bullet's nodes are pushed once they are inside.
TEST(LinksOfMultibodies, HitClothThatHangsInTheirWay)
{
    Plugin plugin(hostSettings());
    ArmWorld scene(&plugin);
    scene.m_world.getWorldInfo().m_gravity.setZero();
    const TriangleMesh blade = makeBox(1, 0.06f, 1);
    for (int i = 0; i < 40; ++i)
    {
        scene.step(12);  // 0.2 m a step at the tip
        ASSERT_EQ(pairsOf(*scene.m_cloth, placed(blade, scene.m_link->getWorldTransform())), 0u) << "step " << i;
    }
    EXPECT_GT(scene.m_cloth->m_nodes[0].m_v.length(), 2);
}
}  // namespace drape::test
