// Obstacles that do not collide for some steps, in which cloth falls into their place, while another obstacle stays.
#include <gtest/gtest.h>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"

namespace drape::test
{
namespace
{
enum class Absence
{
    Removed,
    NoResponse,
    Disabled,
    Masked,
    OtherShape
};

struct ReturnScene
{
    ReturnScene()
        : m_world(&m_plugin),
          m_obstacle(m_world.addObstacle(m_box.shape(), btTransform(btQuaternion::getIdentity(), btVector3(0, 0, 0)))),
          m_cloth(m_world.addCloth(specAt(btScalar(0.35))))
    {
    }
    static ClothSpec specAt(btScalar height)
    {
        ClothSpec spec;
        spec.m_centre = btVector3(0, height, 0);
        return spec;
    }
    void setCollides(Absence absence, bool collides)
    {
        btSoftRigidDynamicsWorld& world = m_world.world();
        const int group = btBroadphaseProxy::StaticFilter, others = btBroadphaseProxy::AllFilter ^ group;
        const int flags = btCollisionObject::CF_STATIC_OBJECT;
        const btCollisionObject* const obstacle = &m_obstacle;
        switch (absence)
        {
            case Absence::Removed:
                if (collides)
                    world.addCollisionObject(&m_obstacle, group, others);
                else
                    world.removeCollisionObject(&m_obstacle);
                break;
            case Absence::NoResponse:
                m_obstacle.setCollisionFlags(collides ? flags : flags | btCollisionObject::CF_NO_CONTACT_RESPONSE);
                break;
            case Absence::Disabled:
                if (collides)
                    m_cloth.m_collisionDisabledObjects.remove(obstacle);
                else
                    m_cloth.m_collisionDisabledObjects.push_back(obstacle);
                break;
            case Absence::Masked:
                m_obstacle.getBroadphaseHandle()->m_collisionFilterMask = collides ? others : 0;
                world.refreshBroadphaseProxy(&m_obstacle);
                break;
            case Absence::OtherShape:
                m_obstacle.setCollisionShape(collides ? &m_box.shape() : &m_speck.shape());
                break;
        }
    }

    MeshShape m_floor{makeBox(6, 0.2f, 6)}, m_box{makeBox(0.6f, 0.6f, 0.6f)}, m_speck{makeBox(0.02f, 0.02f, 0.02f)};
    Plugin m_plugin{hostSettings()};
    DropWorld m_world;
    btCollisionObject& m_obstacle;
    btSoftBody& m_cloth;
};
}  // namespace

TEST(ReturningPairs, AreCheckedHoweverTheyWereAbsent)
{
    const btTransform below(btQuaternion::getIdentity(), btVector3(0, btScalar(-3), 0));
    const btTransform inside(btQuaternion::getIdentity(), btVector3(0, btScalar(-0.12), 0));
    for (const Absence absence :
         {Absence::Removed, Absence::NoResponse, Absence::Disabled, Absence::Masked, Absence::OtherShape})
    {
        SCOPED_TRACE(int(absence));
        ReturnScene scene;
        // Keeps the cloth's mirror alive: the cloth rests on it in the place of the box.
        btCollisionObject& floor = scene.m_world.addObstacle(scene.m_floor.shape(), inside);
        scene.m_world.step(10);
        ASSERT_EQ(scene.m_plugin.statistics().m_status, std::uint32_t(kStepGood));
        scene.setCollides(absence, false);
        scene.m_world.step(40);
        scene.setCollides(absence, true);
        scene.m_world.step();
        EXPECT_NE(scene.m_plugin.statistics().m_status & kStepStartsIntersecting, 0u);
        floor.setWorldTransform(below);  // else the cloth is caught between the two
        scene.m_world.step(300);
        EXPECT_EQ(scene.m_plugin.statistics().m_status & kStepStartsIntersecting, 0u);
    }
}
}  // namespace drape::test
