// Kinematic obstacles: cloth is carried along, pushed and kept outside, whatever their speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/shapes.h"
#include "tests/bullet/kinematic_scene.h"

namespace drape::test
{
namespace
{
// Lets the cloth come to rest on a platform, which then speeds up sideways and goes on.
btScalar lagAfterRide(KinematicScene& scene, btScalar friction, btScalar& ridden)
{
    scene.m_body.setFriction(friction);
    scene.m_cloth.m_cfg.kDP = btScalar(0.01);  // Bullet's damping is towards rest in the world
    for (int i = 0; i < 60; ++i)
        scene.checkedStep(btTransform::getIdentity());
    const btScalar start = meanOf(scene.m_cloth).x();
    btScalar speed = 0;
    ridden = 0;
    for (int i = 0; i < 90; ++i)
    {
        speed = std::min(btScalar(1), speed + btScalar(2) * kDt);
        ridden += speed * kDt;
        scene.checkedStep(shiftedBy(btVector3(ridden, 0, 0)));
    }
    return ridden - (meanOf(scene.m_cloth).x() - start);
}
}  // namespace

TEST_P(Kinematic, APlatformCarriesClothAlongByFriction)
{
    KinematicScene scene(makeBox(5, 0.2f, 5), btTransform::getIdentity(), 0.8f, btVector3(0, btScalar(0.15), 0),
                         GetParam().m_settings);
    btScalar ridden = 0;
    const btScalar lag = lagAfterRide(scene, 1, ridden);
    EXPECT_GT(ridden, btScalar(1.2));
    EXPECT_NEAR(lag, 0, btScalar(0.03));
    EXPECT_NEAR(lowestOf(scene.m_cloth), btScalar(0.1) + kThickness, btScalar(0.003));
}

TEST_P(Kinematic, APlatformWithoutFrictionSlipsAway)
{
    KinematicScene scene(makeBox(5, 0.2f, 5), btTransform::getIdentity(), 0.8f, btVector3(0, btScalar(0.15), 0),
                         GetParam().m_settings);
    btScalar ridden = 0;
    const btScalar lag = lagAfterRide(scene, 0, ridden);
    EXPECT_GT(ridden, btScalar(1.2));
    EXPECT_NEAR(lag, ridden, btScalar(0.05));
}

// Turns under the cloth, about two axes.
TEST_P(Kinematic, ARotatingObstacleKeepsClothOutside)
{
    for (const char* name : {"sphere", "torus", "box"})
    {
        SCOPED_TRACE(name);
        TriangleMesh mesh;
        ASSERT_TRUE(makeShape(name, mesh));
        KinematicScene scene(mesh, btTransform::getIdentity(), 2.0f, btVector3(0, btScalar(1.2), 0),
                             GetParam().m_settings);
        for (int i = 0; i < 150; ++i)
        {
            SCOPED_TRACE("step " + std::to_string(i));
            const btScalar time = btScalar(i) * kDt;
            const btQuaternion turn = btQuaternion(btVector3(0, 1, 0), 3 * time) *
                                      btQuaternion(btVector3(0, 0, 1), std::max(btScalar(0), time - 1));
            scene.checkedStep(btTransform(turn));
            if (HasFatalFailure()) return;
        }
        EXPECT_GT(scene.m_most, 100u);
    }
}

TEST(Kinematic, EveryBackEndGivesTheSameTrajectory)
{
    std::vector<std::uint64_t> hashes;
    for (const BackendCase& backend : allBackends())
    {
        if (backend.m_missing) continue;
        KinematicScene scene(makeTorus(0.6f, 0.2f, 40, 20), btTransform::getIdentity(), 1.6f,
                             btVector3(0, btScalar(0.25), 0), backend.m_settings);
        std::uint64_t hash = kHashStart;
        for (int i = 0; i < 60; ++i)
        {
            const btScalar time = btScalar(i) * kDt;
            scene.step(btTransform(btQuaternion(btVector3(1, 2, 0).normalized(), 4 * time), btVector3(time, 0, 0)));
            hash = hashOf(scene.m_cloth, hash);
        }
        EXPECT_GT(scene.m_most, 100u);
        hashes.push_back(hash);
    }
    EXPECT_EQ(std::count(hashes.begin(), hashes.end(), hashes[0]), std::ptrdiff_t(hashes.size()));
}

// The beam rotates fast, about the vertical and about a level axis.
TEST_P(Kinematic, AFastBeamKeepsClothOutside)
{
    for (const btVector3& axis : {btVector3(0, 1, 0), btVector3(0, 0, 1)})
    {
        SCOPED_TRACE(axis.y() > 0 ? "vertical" : "level");
        KinematicScene scene(makeBox(1.6f, 0.3f, 0.3f), btTransform::getIdentity(), 1.6f,
                             btVector3(0, btScalar(1.1), 0), GetParam().m_settings);
        for (int i = 0; i < 120; ++i)
        {
            SCOPED_TRACE("step " + std::to_string(i));
            scene.checkedStep(btTransform(btQuaternion(axis, 20 * btScalar(i) * kDt)));
            if (HasFatalFailure()) return;
        }
        EXPECT_GT(scene.m_most, 50u);
    }
}

// Tests of plates and of poses, in files of their own, use this instantiation, too.
INSTANTIATE_TEST_SUITE_P(Backend, Kinematic, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
