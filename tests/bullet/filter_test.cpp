// Filters, sleeping and masses of Bullet apps have their usual effect with Drape.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"

namespace drape::test
{
namespace
{
constexpr btScalar kTop = btScalar(0.2);  // m, of the box

class Filters : public testing::Test
{
protected:
    Filters() : m_plugin(hostSettings()), m_box(makeBox(3.0f, 0.4f, 3.0f)), m_shape(m_box), m_world(&m_plugin) {}

    static ClothSpec spec()
    {
        ClothSpec spec;
        spec.m_nodes = 9;
        spec.m_size = 0.6f;
        spec.m_centre = btVector3(0, kTop + btScalar(0.05), 0);
        return spec;
    }

    void expectFallsThrough(const btSoftBody& cloth)
    {
        m_world.step(60);
        EXPECT_LT(lowestOf(cloth), -kTop);
        EXPECT_EQ(m_plugin.statistics().m_contacts, 0u);
        EXPECT_EQ(contactsHeld(cloth), 0);
    }

    Plugin m_plugin;
    TriangleMesh m_box;
    MeshShape m_shape;
    DropWorld m_world;
};
}  // namespace

TEST_F(Filters, DisabledObjectsAreIgnoredUntilTheyAreEnabled)
{
    btCollisionObject& box = m_world.addObstacle(m_shape.shape());
    btSoftBody& ghost = m_world.addCloth(spec());
    ghost.m_collisionDisabledObjects.push_back(&box);
    expectFallsThrough(ghost);
    btSoftBody& solid = m_world.addCloth(spec());
    expectClean(runMeasured(m_world, solid, m_box, 60));
}

TEST_F(Filters, CollisionGroupsAreHonoured)
{
    m_world.addObstacle(m_shape.shape());
    expectFallsThrough(m_world.addCloth(spec(), btBroadphaseProxy::SensorTrigger,
                                        btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter));
}

TEST_F(Filters, AnObstacleWithoutContactResponseHoldsNothing)
{
    btCollisionObject& box = m_world.addObstacle(m_shape.shape());
    box.setCollisionFlags(box.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    expectFallsThrough(m_world.addCloth(spec()));
}

TEST_F(Filters, ClothWithoutContactResponseIsNotHeld)
{
    m_world.addObstacle(m_shape.shape());
    btSoftBody& cloth = m_world.addCloth(spec());
    cloth.setCollisionFlags(cloth.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    expectFallsThrough(cloth);
}

TEST_F(Filters, SleepingClothKeepsItsPositionAndCollectsNoContacts)
{
    m_world.addObstacle(m_shape.shape());
    btSoftBody& cloth = m_world.addCloth(spec());
    m_world.step(90);
    ASSERT_GT(m_plugin.statistics().m_contacts, 0u);
    cloth.forceActivationState(ISLAND_SLEEPING);
    const std::uint64_t hash = hashOf(cloth);
    m_world.step();
    const int held = contactsHeld(cloth);
    m_world.step(100);
    EXPECT_EQ(contactsHeld(cloth), held);
    EXPECT_EQ(m_plugin.statistics().m_contacts, 0u);
    EXPECT_TRUE(m_plugin.statistics().m_skipped);
    EXPECT_EQ(hashOf(cloth), hash);

    cloth.forceActivationState(ACTIVE_TAG);
    expectClean(runMeasured(m_world, cloth, m_box, 30));
    EXPECT_GT(m_plugin.statistics().m_contacts, 0u);
}

TEST_F(Filters, PinnedNodesDoNotMove)
{
    m_world.addObstacle(m_shape.shape());
    ClothSpec hanging = spec();
    hanging.m_centre = btVector3(btScalar(1.5), kTop + btScalar(0.05), 0);  // half of it over the box's edge
    btSoftBody& cloth = m_world.addCloth(hanging);
    const int pins[3] = {0, 8, 40};
    btVector3 places[3];
    for (int i = 0; i < 3; ++i)
    {
        cloth.setMass(pins[i], 0);
        places[i] = cloth.m_nodes[pins[i]].m_x;
    }
    expectClean(runMeasured(m_world, cloth, m_box, 120));
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(cloth.m_nodes[pins[i]].m_x, places[i]) << "node " << pins[i];
}

// A pin inside the thickness, or even in the obstacle, is the app's choice. It stays, and the rest remains finite.
TEST_F(Filters, PinnedNodesBelowTheThicknessStay)
{
    m_world.addObstacle(m_shape.shape());
    ClothSpec low = spec();
    low.m_centre.setY(kTop + btScalar(0.005));
    btSoftBody& cloth = m_world.addCloth(low);
    cloth.setTotalMass(1);
    cloth.setMass(0, 0);
    const btVector3 place = cloth.m_nodes[0].m_x;
    m_world.step(60);
    EXPECT_EQ(cloth.m_nodes[0].m_x, place);
    for (float value : positionsOf(cloth))
        ASSERT_TRUE(std::isfinite(value));
    for (int i = 10; i < cloth.m_nodes.size(); ++i)
        EXPECT_GT(cloth.m_nodes[i].m_x.y(), kTop) << "node " << i;
}
}  // namespace drape::test
