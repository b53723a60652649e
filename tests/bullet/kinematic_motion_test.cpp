// The motion of a kinematic body within a step, derived from Bullet's poses and velocities.
#include <gtest/gtest.h>

#include "bullet_plugin/adapter/motion/kinematic_motion.h"
#include "tests/bullet/kinematic_scene.h"

namespace drape::test
{
TEST(KinematicMotion, FollowsFromVelocityAndPoses)
{
    const btTransform from = btTransform::getIdentity(), to = shiftedBy(btVector3(3, 0, 0));
    const btVector3 none(0, 0, 0);
    EXPECT_FALSE(motionInStep(from, to, none, none, kDt).moves()) << "no velocity: a jump";
    EXPECT_FALSE(motionInStep(to, to, btVector3(1, 0, 0), none, kDt).moves()) << "there already";
    const BodyMotion one = motionInStep(from, to, btVector3(3 / kDt, 0, 0), none, kDt);
    EXPECT_TRUE(one.m_start == from && one.m_end == to);
    const BodyMotion third = motionInStep(from, to, btVector3(1 / kDt, 0, 0), none, kDt);
    EXPECT_TRUE(third.m_start == from);
    EXPECT_NEAR(third.m_end.getOrigin().x(), 1, 1e-5);
    // The body jumped far and moved a little.
    const BodyMotion mixed = motionInStep(from, to, btVector3(0, 1, 0), none, kDt);
    EXPECT_TRUE(mixed.m_end == to);
    EXPECT_NEAR((mixed.m_end.getOrigin() - mixed.m_start.getOrigin()).y(), kDt, 1e-6);
    EXPECT_NEAR(mixed.m_start.getOrigin().x(), 3, 1e-6);
}

namespace
{
// A kinematic body that no world moves: Bullet's part of a step is called by hand.
class ObservedBody
{
public:
    ObservedBody() : m_shape(btVector3(1, 1, 1)), m_body(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &m_shape))
    {
        m_body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
        step();
    }
    btRigidBody& body() { return m_body; }
    void place(btScalar x) { m_body.setWorldTransform(shiftedBy(btVector3(x, 0, 0))); }
    // Begins stepSimulation() with this number of substeps.
    void beginFrame(int substeps = 1) { m_body.saveKinematicState(btScalar(substeps) * kDt); }
    void step()
    {
        m_motions.beginStep(kDt);
        m_motion = m_motions.observe(m_body);
    }
    void expectMotion(btScalar from, btScalar to, double slack = 1e-5)
    {
        EXPECT_NEAR(m_motion.m_start.getOrigin().x(), from, slack);
        EXPECT_NEAR(m_motion.m_end.getOrigin().x(), to, slack);
    }

private:
    btBoxShape m_shape;
    btRigidBody m_body;
    KinematicMotions m_motions;
    BodyMotion m_motion;
};
}  // namespace

// Frames faster than steps, moved by what keeps the pose before as interpolation transform: the velocity is the last
// frame's. The first step takes it for one of three substeps, no later one does.
TEST(KinematicMotion, SeveralPosesInAStepAreSweptAsOneMotion)
{
    ObservedBody observed;
    btScalar x = 0, last = 0;
    for (int step = 0; step < 6; ++step)
    {
        const btScalar frame = btScalar(0.1) * btScalar(1 + step / 3);  // it speeds up
        for (int i = 0; i < 3; ++i)
            observed.body().setCenterOfMassTransform(shiftedBy(btVector3(x += frame, 0, 0)));
        observed.beginFrame();
        observed.step();
        SCOPED_TRACE(step);
        observed.expectMotion(last, step == 0 ? btScalar(0.1) : x);
        last = step == 0 ? btScalar(0.1) : x;
    }
    // Bullet's substeps move the body from here on; the second of them shows it.
    observed.place(x + btScalar(0.4));
    observed.beginFrame(4);
    observed.step();
    observed.expectMotion(x, x + btScalar(0.4));
    x += btScalar(0.4);
    for (int part = 2; part <= 4; ++part)
    {
        observed.step();
        observed.expectMotion(x, x);
    }
    observed.place(x + btScalar(0.4));
    observed.beginFrame(4);
    for (int part = 1; part <= 4; ++part, x += btScalar(0.1))
    {
        observed.step();
        observed.expectMotion(x, x + btScalar(0.1));
    }
}

TEST(KinematicMotion, AMotionWhoseVelocityBulletTookIsSweptWhole)
{
    ObservedBody observed;
    observed.beginFrame(3);
    btScalar x = 0;
    for (int substep = 0; substep < 3; ++substep)
    {
        const btScalar next = x + btScalar(0.1) * btScalar(1 + substep);
        observed.place(next);  // like a tick's callback
        observed.step();
        observed.expectMotion(x, next);
        x = next;
    }
    // Setting both transforms is a teleport even at a velocity of zero in Bullet.
    observed.beginFrame();
    observed.beginFrame();
    observed.place(7);
    observed.body().setInterpolationWorldTransform(observed.body().getWorldTransform());
    observed.step();
    observed.expectMotion(7, 7);
}

// Teleports by both transforms stay teleports where motion had been swept whole, or was being shared.
TEST(KinematicMotion, DistantTeleportsAreNotSwept)
{
    const btTransform far = shiftedBy(btVector3(500, 0, 0));
    const auto teleport = [&](ObservedBody& observed)
    {
        observed.body().setWorldTransform(far);
        observed.body().setInterpolationWorldTransform(far);
    };
    ObservedBody shared;
    shared.place(btScalar(0.4));
    shared.beginFrame(4);
    shared.step();
    teleport(shared);  // like a tick's callback in the second substep
    shared.step();
    shared.expectMotion(btScalar(499.9), 500, 1e-3);

    ObservedBody faster;
    btScalar x = 0;
    for (int step = 0; step < 2; ++step)
    {
        for (int i = 0; i < 4; ++i)
            faster.body().setCenterOfMassTransform(shiftedBy(btVector3(x += btScalar(0.1), 0, 0)));
        faster.beginFrame();
        faster.step();
    }
    faster.expectMotion(btScalar(0.1), btScalar(0.8));
    teleport(faster);
    faster.body().setCenterOfMassTransform(shiftedBy(btVector3(btScalar(500.1), 0, 0)));
    faster.beginFrame();
    faster.step();
    faster.expectMotion(500, btScalar(500.1), 1e-3);
    // The motion ended there: the next frame of substeps is shared.
    faster.place(btScalar(500.5));
    faster.beginFrame(4);
    faster.step();
    faster.expectMotion(btScalar(500.1), btScalar(500.2), 1e-3);
}

// Bullet's first velocity after poses that it did not see refers to the last pose that it saw.
TEST(KinematicMotion, ContinuesWhenBulletCatchesUp)
{
    ObservedBody asleep;
    asleep.beginFrame();
    for (int step = 1; step <= 10; ++step)
    {
        asleep.place(btScalar(0.1) * btScalar(step));
        asleep.step();
        asleep.expectMotion(btScalar(0.1) * btScalar(step - 1), btScalar(0.1) * btScalar(step));
    }
    asleep.place(btScalar(1.1));
    asleep.beginFrame();  // awake
    asleep.step();
    asleep.expectMotion(1, btScalar(1.1));

    ObservedBody after;  // moved by a callback after each of two substeps, faster and faster
    btScalar last = 0, x = 0, pace = 0;
    for (int frame = 0; frame < 4; ++frame)
    {
        after.beginFrame(2);
        for (int substep = 0; substep < 2; ++substep)
        {
            SCOPED_TRACE(testing::Message() << "frame " << frame << " substep " << substep);
            after.step();
            after.expectMotion(last, x);
            last = x;
            x += pace += btScalar(0.05);
            after.place(x);
        }
    }
}

TEST(KinematicMotion, DividesRotationsAmongSubsteps)
{
    const btQuaternion turn(btVector3(0, 1, 0), btScalar(0.8));
    const btTransform from = btTransform::getIdentity(), to(turn);
    const btVector3 none(0, 0, 0), spin(0, btScalar(0.8) / (4 * kDt), 0);
    btTransform at = from;
    for (int left = 4; left > 0; --left)
    {
        const BodyMotion motion = motionInStep(at, to, none, spin, kDt);
        EXPECT_TRUE(motion.m_start == at);
        EXPECT_NEAR(motion.m_end.getRotation().angleShortestPath(at.getRotation()), 0.2, 2e-3);
        at = motion.m_end;
    }
    EXPECT_TRUE(at == to);
}
}  // namespace drape::test
