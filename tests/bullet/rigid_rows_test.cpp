// Cloth that Drape solves beside rigid bodies: contacts that Bullet's own algorithms found, and anchors.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
Settings drapeSolves()
{
    Settings settings = hostSettings();
    settings.m_solver = Solver::Drape;
    settings.m_dynamicConvex = settings.m_staticConvex = ShapeContacts::Bullet;
    return settings;
}

// A rigid body of Bullet's in a world; removed with it.
class RigidBox
{
public:
    RigidBox(DropWorld& world, const btVector3& half, btScalar mass, const btTransform& pose)
        : m_world(world), m_shape(half)
    {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) m_shape.calculateLocalInertia(mass, inertia);
        m_body =
            std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(mass, nullptr, &m_shape, inertia));
        m_body->setWorldTransform(pose);
        m_body->setInterpolationWorldTransform(pose);
        m_body->setFriction(1);
        m_body->setActivationState(DISABLE_DEACTIVATION);
        m_world.world().addRigidBody(m_body.get());
    }
    ~RigidBox() { m_world.world().removeRigidBody(m_body.get()); }

    btRigidBody& body() { return *m_body; }

private:
    DropWorld& m_world;
    btBoxShape m_shape;
    std::unique_ptr<btRigidBody> m_body;
};

btTransform at(btScalar x, btScalar y, btScalar z)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(x, y, z));
}

btScalar fastestOf(const btSoftBody& cloth)
{
    btScalar fastest = 0;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        fastest = std::max(fastest, cloth.m_nodes[i].m_v.length());
    return fastest;
}
}  // namespace

TEST(RigidRows, ClothOnABoxRests)
{
    Plugin plugin(drapeSolves());
    DropWorld world(&plugin);
    RigidBox floor(world, btVector3(2, btScalar(0.5), 2), 0, at(0, btScalar(-0.5), 0));
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(0.1), 0);
    spec.m_damping = 0;
    btSoftBody& cloth = world.addCloth(spec);
    EXPECT_EQ(plugin.whyBulletSolves(cloth), "");
    world.step(60);
    EXPECT_GT(cloth.m_rcontacts.size(), 100);
    world.step(240);
    EXPECT_GT(lowestOf(cloth), 0);
    EXPECT_LT(lowestOf(cloth), 2 * kMargin);
    EXPECT_LT(fastestOf(cloth), 1e-3);
}

// Two slopes, on either side of the friction angle.
TEST(RigidRows, ClothHoldsOnASlopeBelowTheFrictionAngle)
{
    const auto slidOn = [](btScalar degrees)
    {
        Plugin plugin(drapeSolves());
        DropWorld world(&plugin);
        const btTransform turned(btQuaternion(btVector3(0, 0, 1), degrees * SIMD_RADS_PER_DEG), btVector3(0, 0, 0));
        RigidBox slope(world, btVector3(4, btScalar(0.5), 4), 0, turned * at(0, btScalar(-0.5), 0));
        ClothSpec spec;
        spec.m_nodes = 9;
        spec.m_damping = 0;
        btSoftBody& cloth = world.addCloth(spec);
        cloth.transform(turned * at(0, btScalar(1.5) * kMargin, 0));
        cloth.m_cfg.kDF = btScalar(0.5);
        world.step(60);
        const btVector3 before = cloth.m_nodes[40].m_x;
        world.step(120);
        return double((cloth.m_nodes[40].m_x - before).length());
    };
    EXPECT_LT(slidOn(20), 1e-3);  // friction angle: 26.6 degrees
    EXPECT_GT(slidOn(35), 0.5);
}

// A box in free space flies into a cloth.
TEST(RigidRows, ContactsKeepTheMomentumOfClothAndBox)
{
    Plugin plugin(drapeSolves());
    DropWorld world(&plugin);
    world.world().setGravity(btVector3(0, 0, 0));
    world.world().getWorldInfo().m_gravity.setZero();
    RigidBox box(world, btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2)), 2,
                 at(btScalar(0.1), -btScalar(0.4), 0));
    box.body().setLinearVelocity(btVector3(0, btScalar(1.5), 0));
    ClothSpec spec;
    spec.m_damping = 0;
    btSoftBody& cloth = world.addCloth(spec);
    cloth.m_cfg.kDF = btScalar(0.5);
    const btVector3 before = box.body().getLinearVelocity() * 2 + linearMomentumOf(cloth);
    const btVector3 turning = angularMomentumOf(cloth) + angularMomentumOf(box.body());
    int contacts = 0;
    for (int i = 0; i < 60; ++i)
    {
        world.step();
        contacts += cloth.m_rcontacts.size();
    }
    EXPECT_GT(contacts, 100);
    EXPECT_GT(linearMomentumOf(cloth).y(), btScalar(0.2));
    const btVector3 after = box.body().getLinearVelocity() * 2 + linearMomentumOf(cloth);
    EXPECT_LT((after - before).length(), 1e-4 * before.length());
    EXPECT_GT(angularMomentumOf(cloth).length(), btScalar(0.1));
    EXPECT_LT((angularMomentumOf(cloth) + angularMomentumOf(box.body()) - turning).length(), 1e-4 * turning.length());
}

TEST(RigidRows, AnchorsKeepTheMomentumOfClothAndBox)
{
    Plugin plugin(drapeSolves());
    DropWorld world(&plugin);
    world.world().setGravity(btVector3(0, 0, 0));
    world.world().getWorldInfo().m_gravity.setZero();
    RigidBox box(world, btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2)), 1, at(btScalar(-0.9), 0, 0));
    ClothSpec spec;
    spec.m_damping = 0;
    btSoftBody& cloth = world.addCloth(spec);
    cloth.appendAnchor(0, &box.body(), true);
    cloth.appendAnchor(16, &box.body(), true);
    EXPECT_EQ(plugin.whyBulletSolves(cloth), "");
    box.body().setLinearVelocity(btVector3(-1, 0, btScalar(0.3)));
    const btVector3 before = box.body().getLinearVelocity();
    world.step(60);
    EXPECT_GT(linearMomentumOf(cloth).length(), btScalar(0.1));
    EXPECT_LT((box.body().getLinearVelocity() + linearMomentumOf(cloth) - before).length(), 1e-4);
}

// A cape on a body that the app moves.
TEST(RigidRows, AnchoredNodesFollowAKinematicBody)
{
    Plugin plugin(drapeSolves());
    DropWorld world(&plugin);
    btBoxShape shape(btVector3(1, btScalar(0.1), btScalar(0.1)));
    btRigidBody& carrier = world.addKinematic(shape, at(0, 1, 0));
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(0.8), 0);
    btSoftBody& cloth = world.addCloth(spec);
    for (int i = 0; i < 17; ++i)
        cloth.appendAnchor(i, &carrier, true);
    EXPECT_EQ(plugin.whyBulletSolves(cloth), "");
    const btVector3 arm = cloth.m_nodes[8].m_x - carrier.getWorldTransform().getOrigin();
    for (int i = 1; i <= 120; ++i)
    {
        const btTransform pose = at(btScalar(0.02) * btScalar(i), 1, 0);
        carrier.setWorldTransform(pose);
        world.step();
        const btScalar off = (cloth.m_nodes[8].m_x - pose.getOrigin() - arm).length();
        ASSERT_LT(off, 0.01) << "step " << i;
    }
}

// On box and mesh at once, on any number of threads and on every back end.
class RigidRowsOn : public BackendTest
{
};

TEST_P(RigidRowsOn, GiveTheSameBits)
{
    const TriangleMesh sphere = makeSphere(0.3f, 3);
    const auto run = [&](Settings settings)
    {
        settings.m_solver = Solver::Drape;
        settings.m_dynamicConvex = settings.m_staticConvex = ShapeContacts::Bullet;
        Plugin plugin(settings);
        MeshShape shape(sphere);
        DropWorld world(&plugin);
        world.addObstacle(shape.shape());
        RigidBox box(world, btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2)), 1,
                     at(btScalar(0.5), btScalar(0.1), 0));
        RigidBox floor(world, btVector3(2, btScalar(0.5), 2), 0, at(0, btScalar(-0.8), 0));
        ClothSpec spec;
        spec.m_nodes = 33;
        spec.m_centre = btVector3(btScalar(0.2), btScalar(0.45), 0);
        btSoftBody& cloth = world.addCloth(spec);
        const Course course = runMeasured(world, cloth, sphere, 60);
        EXPECT_GT(cloth.m_rcontacts.size(), 0);
        return course;
    };
    Settings host = hostSettings();
    host.m_threads = 1;
    const Course course = run(GetParam().m_settings), alone = run(host);
    expectClean(course);
    EXPECT_EQ(course.m_hash, alone.m_hash);
}

INSTANTIATE_TEST_SUITE_P(Backends, RigidRowsOn, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
