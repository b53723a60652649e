// Cloths and obstacles that come and go, many of them at once, and steps that are not like the others.
#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <limits>
#include <utility>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
ClothSpec small(const btVector3& centre)
{
    ClothSpec spec;
    spec.m_nodes = 9;
    spec.m_size = 0.5f;
    spec.m_centre = centre;
    return spec;
}

btVector3 at(double x, double y, double z)
{
    return btVector3(btScalar(x), btScalar(y), btScalar(z));
}
}  // namespace

class Lifetime : public BackendTest
{
};

TEST_P(Lifetime, ClothsAreAddedAndRemovedWhileRunning)
{
    Plugin plugin(GetParam().m_settings);
    const TriangleMesh mesh = makeSphere(0.3f, 2);
    MeshShape shape(mesh);
    DropWorld world(&plugin);
    world.addObstacle(shape.shape());
    for (int round = 0; round < 4; ++round)
    {
        btSoftBody& first = world.addCloth(small(at(0, 0.35, 0)));
        world.step(10);
        btSoftBody& second = world.addCloth(small(at(0.05, 0.42, 0)));
        const Course course = runMeasured(world, second, mesh, 40);
        expectClean(course);
        EXPECT_GT(plugin.statistics().m_contacts, 0u);
        world.remove(first);
        world.step(5);
        EXPECT_GT(plugin.statistics().m_contacts, 0u);
        for (const ContactInfo& contact : plugin.contacts())
            ASSERT_EQ(contact.m_cloth, &second);
        world.remove(second);
        world.step(2);
        EXPECT_EQ(plugin.statistics().m_contacts, 0u);
        EXPECT_TRUE(plugin.contacts().empty());
    }
}

TEST_P(Lifetime, ObstaclesAreAddedAndRemovedWhileRunning)
{
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(small(at(0, 0.26, 0)));
    for (int round = 0; round < 3; ++round)
    {
        const float shift = -0.3f * static_cast<float>(round);
        auto shape = std::make_unique<MeshShape>(makeBox(2.0f, 0.4f + 0.1f * static_cast<float>(round), 2.0f));
        btCollisionObject& box =
            world.addObstacle(shape->shape(), btTransform(btQuaternion::getIdentity(), at(0, double(shift), 0)));
        world.step(60);
        const double top = 0.2 + 0.05 * round + double(shift);
        EXPECT_NEAR(static_cast<double>(lowestOf(cloth)) - top, kThickness, 0.05 * kThickness) << "round " << round;
        world.remove(box);  // and then its shape and arrays
    }
    world.step(20);
    EXPECT_EQ(plugin.statistics().m_contacts, 0u);
}

TEST_P(Lifetime, SeveralClothsAndObstaclesWorkAtOnce)
{
    Plugin plugin(GetParam().m_settings);
    const TriangleMesh floor = makeBox(4.0f, 0.2f, 4.0f), sphere = makeSphere(0.3f, 2);
    MeshShape floorShape(floor), sphereShape(sphere);
    DropWorld world(&plugin);
    world.addObstacle(floorShape.shape());
    const btTransform left(btQuaternion::getIdentity(), at(-0.8, 0.4, 0)),
        right(btQuaternion::getIdentity(), at(0.8, 0.4, 0));
    world.addObstacle(sphereShape.shape(), left);
    world.addObstacle(sphereShape.shape(), right);
    btSoftBody* cloths[3] = {&world.addCloth(small(at(-0.8, 0.75, 0))), &world.addCloth(small(at(0.7, 0.75, 0.1))),
                             &world.addCloth(small(at(0, 0.3, 0)))};
    const TriangleMesh obstacles[3] = {floor, placed(sphere, left), placed(sphere, right)};
    std::vector<PenetrationMeter> meters;
    for (const btSoftBody* cloth : cloths)
        for (const TriangleMesh& obstacle : obstacles)
            meters.emplace_back(obstacle, meshOf(*cloth));
    for (int step = 0; step < 90; ++step)
    {
        world.step();
        for (std::size_t i = 0; i < meters.size(); ++i)
        {
            const StepMeasure measure = meters[i].measure(positionsOf(*cloths[i / 3]).data());
            ASSERT_EQ(measure.m_penetrationMax, 0) << "step " << step << ", pair " << i;
            ASSERT_EQ(measure.m_intersectingPairs, 0u) << "step " << step << ", pair " << i;
        }
    }
    const std::vector<ContactInfo> contacts = plugin.contacts();
    for (const btSoftBody* cloth : cloths)
        EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(),
                                [cloth](const ContactInfo& contact) { return contact.m_cloth == cloth; }));
}

// The nodes have no springs, so that only Drape could spread the bad node's position. Bullet's bounds begin with the
// first node, and are infinite if it is.
TEST_P(Lifetime, ANodeThatIsNoNumberIsCountedAndKeptToItself)
{
    const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN(),
                   infinite = std::numeric_limits<btScalar>::infinity();
    MeshShape shape(makeBox(2.0f, 0.4f, 2.0f));
    for (const auto& [bad, place] :
         {std::pair(40, nan), std::pair(0, nan), std::pair(40, infinite), std::pair(0, -infinite)})
    {
        SCOPED_TRACE(testing::Message() << "node " << bad << " at " << place);
        Plugin plugin(GetParam().m_settings);
        DropWorld world(&plugin);
        world.addObstacle(shape.shape());
        ClothSpec loose = small(at(0, 0.23, 0));
        loose.m_springs = false;
        btSoftBody& cloth = world.addCloth(loose);
        world.step(30);
        cloth.m_nodes[bad].m_x = cloth.m_nodes[bad].m_q = btVector3(place, place, place);
        for (int step = 0; step < 30; ++step)
        {
            world.step();
            ASSERT_EQ(plugin.statistics().m_invalidNodes, 1u) << "step " << step;
            ASSERT_TRUE(plugin.statistics().m_status & kStepInvalidNodes);
            ASSERT_GT(plugin.statistics().m_contacts, 0u);
        }
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
        {
            const btScalar y = cloth.m_nodes[i].m_x.y();
            EXPECT_EQ(std::isfinite(y), i != bad) << "node " << i;
            if (i == bad) continue;
            EXPECT_NEAR(static_cast<double>(y) - 0.2, kThickness, 0.05 * kThickness) << "node " << i;
        }
    }
}

// The report goes on while the node stays as it is, and ends when it is finite again.
TEST_P(Lifetime, ANodeThatIsNoNumberIsCountedWithoutAPairToo)
{
    const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
    MeshShape shape(makeBox(2.0f, 0.4f, 2.0f));
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    btCollisionObject& box = world.addObstacle(shape.shape());
    ClothSpec loose = small(at(0, 0.23, 0));
    loose.m_springs = false;
    btSoftBody& cloth = world.addCloth(loose);
    const auto put = [&](const btVector3& place)
    {
        for (const int node : {40, 41})
        {
            cloth.m_nodes[node].m_x = cloth.m_nodes[node].m_q = place;
            cloth.m_nodes[node].m_v.setZero();
        }
    };
    const auto expectReport = [&](std::size_t nodes)
    {
        world.step();
        EXPECT_EQ(plugin.statistics().m_invalidNodes, nodes);
        EXPECT_EQ(plugin.statistics().m_status, std::uint32_t(nodes > 0 ? kStepInvalidNodes : kStepGood));
    };
    world.step(10);
    put(btVector3(nan, nan, nan));
    expectReport(2);
    ASSERT_FALSE(plugin.statistics().m_skipped);
    world.remove(box);
    expectReport(2);
    ASSERT_TRUE(plugin.statistics().m_skipped) << "no pair is left";
    expectReport(2);
    put(at(0, 0.5, 0));
    expectReport(0);
    // Nodes that the solver steps are examined without a pair, too.
    put(btVector3(nan, nan, nan));
    expectReport(2);
}

namespace
{
double fastestOf(const btSoftBody& cloth)
{
    double speed = 0;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        speed = std::max(speed, static_cast<double>(cloth.m_nodes[i].m_v.length()));
    return speed;
}

double farthestBetween(const std::vector<float>& before, const std::vector<float>& after)
{
    double farthest = 0;
    for (std::size_t i = 0; i < before.size(); i += 3)
    {
        double length2 = 0;
        for (std::size_t axis = i; axis < i + 3; ++axis)
            length2 += std::pow(static_cast<double>(after[axis]) - before[axis], 2);
        farthest = std::isfinite(length2) ? std::max(farthest, std::sqrt(length2)) : INFINITY;
    }
    return farthest;
}

void expectFiniteContacts(const Plugin& plugin)
{
    for (const ContactInfo& contact : plugin.contacts())
    {
        double length2 = 0;
        for (int axis = 0; axis < 3; ++axis)
        {
            length2 += std::pow(static_cast<double>(contact.m_normal[axis]), 2);
            EXPECT_TRUE(std::isfinite(contact.m_point[axis]));
        }
        EXPECT_NEAR(length2, 1, 1e-5);
        EXPECT_TRUE(std::isfinite(contact.m_gap));
        EXPECT_NEAR(contact.m_weights[0] + contact.m_weights[1] + contact.m_weights[2], 1, 1e-5);
    }
}
}  // namespace

// Bullet skips steps of zero duration. In a step of a microsecond nodes move by their speed and by gravity, whether
// they reach the surface or not. Divisions by the time step create no speed.
TEST_P(Lifetime, AStepOfHardlyAnyTimeMovesNothing)
{
    constexpr btScalar kHardly = btScalar(1e-6);       // s
    constexpr double kGravity = 10, kRounding = 6e-8;  // m/s²; m, two ulps of a coordinate below 0.5 m
    const TriangleMesh box = makeBox(2.0f, 0.4f, 2.0f);
    MeshShape shape(box);
    for (const double speed : {0.0, 10.0, 1000.0})
    {
        SCOPED_TRACE(speed);
        Plugin plugin(GetParam().m_settings);
        DropWorld world(&plugin);
        world.addObstacle(shape.shape());
        btSoftBody& cloth = world.addCloth(small(at(0, 0.2 + 1.2 * kThickness, 0)));
        cloth.setVelocity(at(0, -speed, 0));
        for (int step = 0; step < 100; ++step)
        {
            SCOPED_TRACE(step);
            const std::vector<float> before = positionsOf(cloth);
            const double fastest = fastestOf(cloth), change = kGravity * kHardly + kRounding / kHardly;
            ASSERT_EQ(world.world().stepSimulation(kHardly, 1, kHardly), 1);
            ASSERT_GT(plugin.statistics().m_contacts, 0u);
            ASSERT_EQ(plugin.statistics().m_status, std::uint32_t(kStepGood));
            ASSERT_LE(farthestBetween(before, positionsOf(cloth)), (fastest + change) * kHardly);
            ASSERT_LE(fastestOf(cloth), fastest + change);
            expectFiniteContacts(plugin);
        }
        EXPECT_GT(static_cast<double>(lowestOf(cloth)) - 0.2, 0.98 * kThickness);
        cloth.setVelocity(at(0, 0, 0));
        expectClean(runMeasured(world, cloth, box, 30));
    }
}

INSTANTIATE_TEST_SUITE_P(Backend, Lifetime, testing::ValuesIn(allBackends()), backendName);

TEST(Lifetime, TheWorldMayBeDeletedBeforeThePlugin)
{
    Plugin plugin(hostSettings());
    for (int round = 0; round < 3; ++round)
    {
        MeshShape shape(makeSphere(0.3f, 1));
        DropWorld world(&plugin);
        world.addObstacle(shape.shape());
        world.addCloth(small(at(0, 0.35, 0)));
        world.step(20);
        EXPECT_GT(plugin.statistics().m_contacts, 0u) << "round " << round;
    }
}

TEST(Lifetime, ThePluginMayBeDeletedBeforeTheWorld)
{
    auto plugin = std::make_unique<Plugin>(hostSettings());
    MeshShape shape(makeBox(2.0f, 0.4f, 2.0f));
    DropWorld world(plugin.get());
    world.addObstacle(shape.shape());
    btSoftBody& cloth = world.addCloth(small(at(0, 0.23, 0)));
    world.step(20);
    plugin.reset();
    world.step(40);
    EXPECT_NEAR(static_cast<double>(lowestOf(cloth)) - 0.2, kThickness, 0.05 * kThickness);
}
}  // namespace drape::test
