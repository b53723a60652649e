// Kinematic obstacles with the poses of an app. Covers motion and teleports in frames of several substeps, from
// callbacks and in compounds, and the waking of cloth.
#include <gtest/gtest.h>

#include <string>

#include "scenes/shapes.h"
#include "tests/bullet/kinematic_scene.h"

namespace drape::test
{
// Setting both of Bullet's transforms gives no velocity, and nothing along the path is touched.
TEST_P(Kinematic, EqualTransformsAreATeleport)
{
    KinematicScene scene(makeBox(4, 0.2f, 4), shiftedBy(btVector3(0, -3, 0)), 1.0f, btVector3(0, 0, 0),
                         GetParam().m_settings);
    scene.step(shiftedBy(btVector3(0, -3, 0)));
    const btTransform above = shiftedBy(btVector3(0, 3, 0));
    scene.m_body.setInterpolationWorldTransform(above);
    scene.step(above);
    EXPECT_EQ(scene.m_most, 0u);
    EXPECT_LT(meanOf(scene.m_cloth).y(), 0);
    scene.step(shiftedBy(btVector3(0, -3, 0)));  // and this is motion
    EXPECT_GT(scene.m_most, 0u);
    EXPECT_LT(meanOf(scene.m_cloth).y(), btScalar(-3));
}

namespace
{
// The ways in which an app moves a kinematic body and the cloth around it to another position.
enum class Put
{
    BothTransforms,
    WorldTransformAlone,
    AndSaysSo  // the world transform alone, and Plugin::teleported() of the body
};

// Returns a hash of the cloth over 30 steps after the jump, over every bit of every step.
std::uint64_t hashAfterJump(const Settings& settings, Put put, bool wholeCloth, const btTransform& to, int substeps)
{
    KinematicScene scene(makeSphere(0.3f, 3), btTransform::getIdentity(), 1.0f, btVector3(0, btScalar(0.35), 0),
                         settings);
    scene.m_cloth.setMass(0, 0);
    scene.m_cloth.setMass(16, 0);
    for (int step = 0; step < 30; ++step)
        scene.step(btTransform::getIdentity());
    EXPECT_GT(scene.m_most, 0u);
    scene.m_body.setWorldTransform(to);
    if (put == Put::BothTransforms) scene.m_body.setInterpolationWorldTransform(to);
    if (put == Put::AndSaysSo) scene.m_plugin.teleported(&scene.m_body);
    if (wholeCloth)
        scene.m_cloth.transform(to);
    else
        for (const int pin : {0, 16})
            scene.m_cloth.m_nodes[pin].m_x = to * scene.m_cloth.m_nodes[pin].m_x;
    std::uint64_t hash = kHashStart;
    for (int frame = 0; frame < 30; ++frame)
    {
        scene.m_world.world().stepSimulation(btScalar(substeps) * kDt, substeps, kDt);
        hash = hashOf(scene.m_cloth, hash);
    }
    return hash;
}
}  // namespace

// Teleports a character with its cloth by the world transform alone. Nothing is swept. The whole cloth moves along or
// only its pins, rotated or not, in one step or in several substeps.
TEST_P(Kinematic, BodiesThatAreMovedWithTheirClothAreTeleported)
{
    const btTransform turned(btQuaternion(btVector3(0, 1, 0), btScalar(2.5)), btVector3(-4, 1, 2));
    for (const btTransform& to : {shiftedBy(btVector3(2, 0, 0)), shiftedBy(btVector3(10, 0, 5)), turned})
    {
        for (const bool whole : {true, false})
        {
            for (const int substeps : {1, 3})
            {
                SCOPED_TRACE("to x " + std::to_string(to.getOrigin().x()) + (whole ? ", whole" : ", pins") + ", " +
                             std::to_string(substeps) + " substeps");
                const auto hash = [&](Put put)
                { return hashAfterJump(GetParam().m_settings, put, whole, to, substeps); };
                EXPECT_EQ(hash(Put::WorldTransformAlone), hash(Put::BothTransforms));
            }
        }
    }
}

// Bodies that are thrown at cloth are swept if an app moved the cloth differently or not at all.
TEST_P(Kinematic, BodiesThatAreThrownPastMovedClothAreSwept)
{
    for (const btVector3& shift : {btVector3(0, 0, 0), btVector3(0, 0, btScalar(0.01)), btVector3(0, 0, btScalar(0.3))})
    {
        KinematicScene scene(makeBox(0.6f, 0.02f, 0.6f), shiftedBy(btVector3(0, -3, 0)), 1.0f, btVector3(0, 0, 0),
                             GetParam().m_settings);
        scene.step(shiftedBy(btVector3(0, -3, 0)));
        scene.m_cloth.translate(shift);
        scene.step(shiftedBy(btVector3(0, 3, 0)));
        EXPECT_GT(scene.m_most, 0u) << shift.z();
    }
}

TEST_P(Kinematic, BodiesDeclaredAsTeleportedSweepNothing)
{
    KinematicScene scene(makeBox(4, 0.2f, 4), shiftedBy(btVector3(0, -3, 0)), 1.0f, btVector3(0, 0, 0),
                         GetParam().m_settings);
    scene.step(shiftedBy(btVector3(0, -3, 0)));
    scene.m_plugin.teleported(nullptr);
    scene.m_plugin.teleported(&scene.m_body);  // before the pose is set, as well as after
    scene.step(shiftedBy(btVector3(0, 3, 0)));
    EXPECT_EQ(scene.m_most, 0u);
    scene.step(shiftedBy(btVector3(0, -3, 0)));  // and this is motion
    EXPECT_GT(scene.m_most, 0u);
    EXPECT_EQ(hashAfterJump(GetParam().m_settings, Put::AndSaysSo, true, shiftedBy(btVector3(1, 0, 0)), 1),
              hashAfterJump(GetParam().m_settings, Put::BothTransforms, true, shiftedBy(btVector3(1, 0, 0)), 1));
}

// Parks a body out of sight. It may be so far away that Bullet would remove cloth beside its path from the simulation.
// The body drags nothing along, and cloth collides with it again after its return.
TEST_P(Kinematic, BodiesThatAreParkedFarAwayDragNothingAlong)
{
    for (const btVector3& place : {btVector3(1000, 0, 0), btVector3(0, 1000, 0), btVector3(0, -1e5f, 0),
                                   btVector3(0, -1e6f, 0), btVector3(0, btScalar(1e30), 0)})
    {
        SCOPED_TRACE("x " + std::to_string(place.x()) + ", y " + std::to_string(place.y()));
        KinematicScene scene(makeBox(4, 0.2f, 4), shiftedBy(btVector3(0, 0, 0)), 1.0f, btVector3(0, btScalar(0.12), 0),
                             GetParam().m_settings);
        MeshShape ground(makeBox(8.0f, 0.2f, 8.0f));
        scene.m_world.addObstacle(ground.shape(), shiftedBy(btVector3(0, btScalar(-0.5), 0)));
        for (int step = 0; step < 10; ++step)
            scene.step(shiftedBy(btVector3(0, 0, 0)));
        EXPECT_GT(scene.m_most, 0u);
        for (int step = 0; step < 60; ++step)
            scene.step(shiftedBy(place));
        EXPECT_EQ(scene.m_cloth.getActivationState(), ACTIVE_TAG);
        EXPECT_NEAR(double(meanOf(scene.m_cloth).x()), 0.0, 0.1);
        EXPECT_NEAR(double(lowestOf(scene.m_cloth)), -0.4 + double(kThickness), 0.1 * double(kThickness));
    }
}

// A frame of several substeps is the motion of its parts.
TEST_P(Kinematic, SubstepsShareTheMotion)
{
    KinematicScene whole(makeBox(4, 0.2f, 4), btTransform::getIdentity(), 1.0f, btVector3(0, btScalar(0.15), 0),
                         GetParam().m_settings);
    KinematicScene parts(makeBox(4, 0.2f, 4), btTransform::getIdentity(), 1.0f, btVector3(0, btScalar(0.15), 0),
                         GetParam().m_settings);
    // A new body rests in its first step.
    whole.step(btTransform::getIdentity());
    parts.step(btTransform::getIdentity());
    for (int frame = 1; frame <= 20; ++frame)
    {
        const btVector3 shift(btScalar(0.05), btScalar(0.02), 0);
        whole.m_body.setWorldTransform(shiftedBy(shift * btScalar(frame)));
        whole.m_world.world().stepSimulation(4 * kDt, 4, kDt);
        for (int part = 1; part <= 4; ++part)
            parts.step(shiftedBy(shift * (btScalar(frame - 1) + btScalar(part) / 4)));
        ASSERT_LT((meanOf(whole.m_cloth) - meanOf(parts.m_cloth)).length(), btScalar(0.005)) << frame;
    }
    EXPECT_GT(meanOf(parts.m_cloth).y(), btScalar(0.4));
    EXPECT_GT(parts.m_most, 0u);
}

// Bullet takes velocities before it calls the callback: this motion begins without one.
TEST_P(Kinematic, ABodyMovedByATicksCallbackDragsClothAlong)
{
    KinematicScene scene(makeBox(4, 0.2f, 4), shiftedBy(btVector3(0, -1, 0)), 1.0f, btVector3(0, 0, 0),
                         GetParam().m_settings);
    scene.step(shiftedBy(btVector3(0, -1, 0)));
    const auto lift = [](btDynamicsWorld* world, btScalar)
    {
        btRigidBody& body = *static_cast<btRigidBody*>(world->getWorldUserInfo());
        body.setWorldTransform(shiftedBy(body.getWorldTransform().getOrigin() + btVector3(0, 2, 0)));
    };
    scene.m_world.world().setInternalTickCallback(lift, &scene.m_body, true);
    scene.m_world.world().stepSimulation(2 * kDt, 2, kDt);
    EXPECT_GT(scene.m_plugin.statistics().m_contacts, 0u);
    EXPECT_GT(lowestOf(scene.m_cloth), btScalar(3));
}

TEST_P(Kinematic, AChildOfACompoundMovesWithIt)
{
    Plugin plugin(GetParam().m_settings);
    MeshShape mesh(makeBox(3, 0.2f, 3));
    btCompoundShape compound;
    const btTransform child(btQuaternion(btVector3(0, 1, 0), btScalar(0.5)), btVector3(0, 1, 0));
    compound.addChildShape(child, &mesh.shape());
    DropWorld world(&plugin);
    btRigidBody& body = world.addKinematic(compound);
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(1.15), 0);
    btSoftBody& cloth = world.addCloth(spec);
    EXPECT_EQ(plugin.whyStock(&cloth, &body), "");
    world.step(60);
    for (int i = 1; i <= 60; ++i)
    {
        body.setWorldTransform(shiftedBy(btVector3(0, btScalar(0.1) * btScalar(i), 0)));
        world.step();
        ASSERT_GT(lowestOf(cloth), btScalar(1.1) + btScalar(0.1) * btScalar(i)) << i;
    }
}

TEST_P(Kinematic, ABodyThatBeginsToMoveWakesCloth)
{
    KinematicScene scene(makeBox(4, 0.2f, 4), btTransform::getIdentity(), 1.0f, btVector3(0, btScalar(0.15), 0),
                         GetParam().m_settings);
    for (int i = 0; i < 60; ++i)
        scene.step(btTransform::getIdentity());
    scene.m_cloth.forceActivationState(ISLAND_SLEEPING);
    scene.step(btTransform::getIdentity());
    EXPECT_FALSE(scene.m_cloth.isActive());
    for (int i = 1; i <= 3; ++i)
        scene.step(shiftedBy(btVector3(0, btScalar(0.002) * btScalar(i), 0)));
    EXPECT_TRUE(scene.m_cloth.isActive());
}

// A plate that passes sleeping cloth within one step wakes it. A plate that does not collide with the cloth leaves it
// asleep.
TEST_P(Kinematic, AFastBodyWakesClothInTime)
{
    for (const bool collide : {true, false})
    {
        KinematicScene scene(makeBox(4, 0.2f, 4), shiftedBy(btVector3(0, -5, 0)), 1.0f, btVector3(0, 0, 0),
                             GetParam().m_settings);
        if (!collide) scene.m_body.setIgnoreCollisionCheck(&scene.m_cloth, true);
        scene.step(shiftedBy(btVector3(0, -5, 0)));
        scene.m_cloth.forceActivationState(ISLAND_SLEEPING);
        scene.step(shiftedBy(btVector3(0, -4, 0)));
        EXPECT_FALSE(scene.m_cloth.isActive()) << "far away";
        scene.step(shiftedBy(btVector3(0, 4, 0)));
        EXPECT_EQ(scene.m_cloth.isActive(), collide);
        EXPECT_EQ(scene.m_most > 0, collide);
        EXPECT_EQ(lowestOf(scene.m_cloth) > 4, collide);
    }
}

// A body whose pairs with the cloth Drape leaves to Bullet does not wake the cloth.
TEST_P(Kinematic, ABodyOfBulletLetsClothSleep)
{
    Settings settings = GetParam().m_settings;
    settings.m_staticConvex = ShapeContacts::Bullet;
    Plugin plugin(settings);
    DropWorld world(&plugin);
    btBoxShape box(btVector3(1, btScalar(0.1), 1));
    btCompoundShape compound;
    compound.addChildShape(btTransform::getIdentity(), &box);
    btRigidBody& body = world.addKinematic(compound, shiftedBy(btVector3(0, -5, 0)));
    ClothSpec spec;
    btSoftBody& cloth = world.addCloth(spec);
    EXPECT_NE(plugin.whyStock(&cloth, &body), "");
    world.step();
    cloth.forceActivationState(ISLAND_SLEEPING);
    for (int i = 1; i <= 3; ++i)
    {
        body.setWorldTransform(shiftedBy(btVector3(0, btScalar(-5 + i), 0)));
        world.step();
    }
    body.setWorldTransform(shiftedBy(btVector3(0, 5, 0)));
    world.step();
    EXPECT_FALSE(cloth.isActive());
}
}  // namespace drape::test
