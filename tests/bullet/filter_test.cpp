// Filters, sleeping and masses of Bullet apps have their usual effect with Drape.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "BulletCollision/CollisionDispatch/btGhostObject.h"
#include "BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
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

namespace
{
struct Pair
{
    DropWorld& m_world;
    btSoftBody& m_cloth;
    btCollisionObject& m_obstacle;
};

struct Filter
{
    std::string m_name;
    std::function<void(Pair&)> m_set;  // before the first step
    int m_group = 1, m_mask = -1;      // the cloth's
};

void setFlag(btCollisionObject& object, int flag)
{
    object.setCollisionFlags(object.getCollisionFlags() | flag);
}

struct NoPairs : btOverlapFilterCallback
{
    bool needBroadphaseCollision(btBroadphaseProxy*, btBroadphaseProxy*) const override { return false; }
};

const std::vector<Filter>& filters()
{
    static const std::vector<Filter> all = {
        {"None", [](Pair&) {}},
        {"MaskOfTheCloth", [](Pair&) {}, 1, -1 ^ int(btBroadphaseProxy::StaticFilter)},
        {"GroupOfTheCloth", [](Pair&) {}, btBroadphaseProxy::StaticFilter, -1},
        {"DisabledObjects", [](Pair& pair) { pair.m_cloth.m_collisionDisabledObjects.push_back(&pair.m_obstacle); }},
        {"IgnoredByTheCloth", [](Pair& pair) { pair.m_cloth.setIgnoreCollisionCheck(&pair.m_obstacle, true); }},
        {"IgnoredByTheObstacle", [](Pair& pair) { pair.m_obstacle.setIgnoreCollisionCheck(&pair.m_cloth, true); }},
        {"IgnoredNoMore",
         [](Pair& pair)
         {
             pair.m_cloth.setIgnoreCollisionCheck(&pair.m_obstacle, true);
             pair.m_cloth.setIgnoreCollisionCheck(&pair.m_obstacle, false);
         }},
        {"ObstacleWithoutResponse",
         [](Pair& pair) { setFlag(pair.m_obstacle, btCollisionObject::CF_NO_CONTACT_RESPONSE); }},
        {"ClothWithoutResponse", [](Pair& pair) { setFlag(pair.m_cloth, btCollisionObject::CF_NO_CONTACT_RESPONSE); }},
        {"SleepingCloth", [](Pair& pair) { pair.m_cloth.forceActivationState(ISLAND_SLEEPING); }},
        {"SleepingObstacle", [](Pair& pair) { pair.m_obstacle.forceActivationState(ISLAND_SLEEPING); }},
        {"DisabledSimulation", [](Pair& pair) { pair.m_cloth.forceActivationState(DISABLE_SIMULATION); }},
        {"NearCallback",
         [](Pair& pair)
         {
             pair.m_world.dispatcher().setNearCallback(
                 [](btBroadphasePair&, btCollisionDispatcher&, const btDispatcherInfo&) {});
         }},
        {"OverlapFilter",
         [](Pair& pair)
         {
             static NoPairs noPairs;
             pair.m_world.world().getPairCache()->setOverlapFilterCallback(&noPairs);
             pair.m_world.world().getBroadphase()->getOverlappingPairCache()->cleanProxyFromPairs(
                 pair.m_cloth.getBroadphaseHandle(), &pair.m_world.dispatcher());
             pair.m_world.world().refreshBroadphaseProxy(&pair.m_cloth);
         }},
        {"ChildrenThatAreBoxes",
         [](Pair&)
         {
             gCompoundChildShapePairCallback = [](const btCollisionShape*, const btCollisionShape* child)
             { return child->getShapeType() != BOX_SHAPE_PROXYTYPE; };
         }},
        {"ChildrenThatAreMeshes",
         [](Pair&)
         {
             gCompoundChildShapePairCallback = [](const btCollisionShape*, const btCollisionShape* child)
             { return child->getShapeType() != TRIANGLE_MESH_SHAPE_PROXYTYPE; };
         }},
    };
    return all;
}

enum class Body
{
    Mesh,
    Box,
    Compound,
    Ghost
};

// Returns whether the cloth has contacts that act on it, Bullet's or Drape's.
bool hasContacts(const btSoftBody& cloth, const Plugin* plugin)
{
    if (!cloth.isActive()) return false;
    for (int i = 0; i < cloth.m_rcontacts.size(); ++i)
        if (cloth.m_rcontacts[i].m_cti.m_colObj->hasContactResponse()) return true;
    return plugin && plugin->statistics().m_contacts > 0;
}

// Returns whether the pair makes contacts in any of the steps.
bool collides(Plugin* plugin, const Filter& filter, Body kind)
{
    MeshShape mesh(makeBox(3, 0.4f, 3));
    btBoxShape box(btVector3(btScalar(1.5), kTop, btScalar(1.5)));
    btCompoundShape compound;
    compound.addChildShape(btTransform::getIdentity(), &mesh.shape());
    btCollisionShape& shape = kind == Body::Mesh       ? static_cast<btCollisionShape&>(mesh.shape())
                              : kind == Body::Compound ? static_cast<btCollisionShape&>(compound)
                                                       : box;
    DropWorld world(plugin);
    btGhostObject ghost;
    ghost.setCollisionShape(&shape);
    if (kind == Body::Ghost)
        world.world().addCollisionObject(&ghost, btBroadphaseProxy::StaticFilter,
                                         btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
    ClothSpec spec;
    spec.m_nodes = 9;
    spec.m_size = 0.6f;
    spec.m_centre = btVector3(0, kTop + btScalar(0.05), 0);
    btSoftBody& cloth = world.addCloth(spec, filter.m_group, filter.m_mask);
    Pair pair = {world, cloth, kind == Body::Ghost ? ghost : world.addObstacle(shape)};
    filter.m_set(pair);
    bool collides = false;
    for (int i = 0; i < 30; ++i)
    {
        world.step();
        collides = collides || hasContacts(cloth, plugin);
    }
    gCompoundChildShapePairCallback = nullptr;
    if (kind == Body::Ghost) world.world().removeCollisionObject(&ghost);
    return collides;
}

class FiltersOfBullet : public testing::TestWithParam<Body>
{
};
}  // namespace

TEST_P(FiltersOfBullet, HaveTheEffectThatTheyHaveWithoutDrape)
{
    Plugin plugin(hostSettings());
    int colliding = 0;
    for (const Filter& filter : filters())
    {
        const bool isStock = collides(nullptr, filter, GetParam());
        EXPECT_EQ(collides(&plugin, filter, GetParam()), isStock)
            << filter.m_name << ", Bullet's contacts: " << isStock;
        colliding += isStock;
    }
    EXPECT_GT(colliding, 3);
    EXPECT_LT(colliding, int(filters().size()) - 5);
}

INSTANTIATE_TEST_SUITE_P(Bodies, FiltersOfBullet, testing::Values(Body::Mesh, Body::Box, Body::Compound, Body::Ghost));
}  // namespace drape::test
