// Cloth beside dynamic bodies: each pushes the other, and neither passes through.
#include <gtest/gtest.h>

#include <algorithm>

#include "BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h"
#include "BulletCollision/Gimpact/btGImpactShape.h"
#include "oracle/measure.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
// A mesh as a shape that Bullet moves.
class GImpact
{
public:
    explicit GImpact(TriangleMesh mesh)
        : m_mesh(std::move(mesh)),
          m_arrays(int(m_mesh.m_triangles.size() / 3), m_mesh.m_triangles.data(), 3 * sizeof(int),
                   int(m_mesh.m_positions.size() / 3), m_mesh.m_positions.data(), 3 * sizeof(float)),
          m_shape(&m_arrays)
    {
        m_shape.setMargin(kMargin);
        m_shape.updateBound();
    }
    btGImpactMeshShape& shape() { return m_shape; }
    const TriangleMesh& mesh() const { return m_mesh; }

private:
    TriangleMesh m_mesh;
    btTriangleIndexVertexArray m_arrays;
    btGImpactMeshShape m_shape;
};

btTransform at(btScalar x, btScalar y, btScalar z)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(x, y, z));
}

// Returns the number of triangles of cloth and obstacle that intersect, each with each.
std::size_t pairsOf(const btSoftBody& cloth, const TriangleMesh& mesh, const btRigidBody& body)
{
    return PenetrationMeter(placed(mesh, body.getWorldTransform()), meshOf(cloth))
        .measure(positionsOf(cloth).data())
        .m_intersectingPairs;
}
}  // namespace

// One edge of the cloth is anchored to a box beside it, nearer than the thickness. Contacts would push the box away
// from nodes that go with it.
TEST(DynamicBodies, CarryClothThatIsAnchoredNearTheirSurface)
{
    for (const btScalar gap : {btScalar(0.003), btScalar(0.008), btScalar(0.0101)})
    {
        btBoxShape shape(btVector3(0.1f, 0.1f, 0.5f));
        Plugin plugin(hostSettings());
        DropWorld world(&plugin);
        ClothSpec spec;
        spec.m_nodes = 21;
        btSoftBody& cloth = world.addCloth(spec);
        btRigidBody& box = world.addDynamic(shape, 2, at(0.6f + gap, 0, 0));
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
            if (cloth.m_nodes[i].m_x.x() > 0.49f) cloth.appendAnchor(i, &box);
        for (int step = 0; step < 60; ++step)
        {
            world.step();
            ASSERT_LT(box.getLinearVelocity().length(), 12) << gap << " " << step;
            ASSERT_LT(rmsSpeed(cloth), 12) << gap << " " << step;
        }
        EXPECT_EQ(plugin.statistics().m_status, std::uint32_t(kStepGood)) << gap;
        EXPECT_LT(box.getWorldTransform().getOrigin().y(), -1) << gap;
    }
}

// A ball in free space flies into a cloth, away from its middle.
class MomentumOfCloth : public testing::TestWithParam<float>  // the ball's mass, kg; the cloth has 1
{
};

TEST_P(MomentumOfCloth, GoesToTheBallThatItMeets)
{
    const btScalar mass = GetParam();
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    world.world().setGravity(btVector3(0, 0, 0));
    world.world().getWorldInfo().m_gravity.setZero();
    GImpact ball(makeSphere(0.2f, 3));
    btRigidBody& body = world.addDynamic(ball.shape(), mass, at(btScalar(0.1), btScalar(-0.4), 0));
    body.setLinearVelocity(btVector3(0, btScalar(1.5), 0));
    ClothSpec spec;
    spec.m_damping = 0;
    btSoftBody& cloth = world.addCloth(spec);
    cloth.m_cfg.kDF = btScalar(0.5);
    EXPECT_EQ(plugin.whyStock(&cloth, &body), "");
    const auto momentum = [&] { return body.getLinearVelocity() * mass + linearMomentumOf(cloth); };
    const auto turning = [&] { return angularMomentumOf(cloth) + angularMomentumOf(body); };
    const btVector3 before = momentum(), turningBefore = turning();
    for (int i = 0; i < 100; ++i)
    {
        world.step();
        ASSERT_EQ(pairsOf(cloth, ball.mesh(), body), 0u) << "step " << i;
        ASSERT_LT((momentum() - before).length(), 1e-5 * before.length()) << "step " << i;
        ASSERT_LT((turning() - turningBefore).length(), 1e-4 * turningBefore.length()) << "step " << i;
    }
    EXPECT_GT(linearMomentumOf(cloth).y(), btScalar(0.1) * before.y());
    EXPECT_GT(angularMomentumOf(cloth).length(), btScalar(0.1) * turningBefore.length());
}

INSTANTIATE_TEST_SUITE_P(Balls, MomentumOfCloth, testing::Values(0.1f, 1.0f, 10.0f));

enum class Load
{
    Mesh,
    Box,
    Ball,
    Hull,
    Compound
};

Settings sleepingSettings()
{
    Settings settings = hostSettings();
    settings.m_clothSleeps = true;
    return settings;
}

// A cloth of 2 x 2 m and 2 kg, held at its border, and a body of 5 kg.
class Hammock : public testing::TestWithParam<std::pair<Load, int>>
{
protected:
    const int m_nodes = GetParam().second;  // along a side

    Hammock() : m_plugin(sleepingSettings()), m_world(&m_plugin)
    {
        ClothSpec spec;
        spec.m_nodes = m_nodes;
        spec.m_size = 2;
        spec.m_damping = btScalar(0.2);
        m_cloth = &m_world.addCloth(spec);
        m_cloth->setTotalMass(2, true);
        setMassOfBorder(0);
        m_body = &m_world.addDynamic(makeShape(), 5, at(0, btScalar(0.22), 0));
        m_body->forceActivationState(ACTIVE_TAG);
    }

    void setMassOfBorder(btScalar mass)
    {
        for (int i = 0; i < m_nodes; ++i)
            for (const int node : {i, m_nodes * (m_nodes - 1) + i, m_nodes * i, m_nodes * i + m_nodes - 1})
                m_cloth->setMass(node, mass);
    }

    btCollisionShape& makeShape()
    {
        const Load load = GetParam().first;
        const bool isBall = load == Load::Mesh || load == Load::Ball;
        m_mesh = isBall ? makeSphere(0.2f, 2) : makeBox(0.3f, 0.3f, 0.3f);
        switch (load)
        {
            case Load::Mesh:
                m_gimpact = std::make_unique<GImpact>(m_mesh);
                return m_gimpact->shape();
            case Load::Box:
                m_shape = std::make_unique<btBoxShape>(btVector3(btScalar(0.15), btScalar(0.15), btScalar(0.15)));
                break;
            case Load::Ball:
                m_shape = std::make_unique<btSphereShape>(btScalar(0.2));
                break;
            case Load::Hull:
                m_shape = makeHull();
                break;
            case Load::Compound:
                m_child = makeHull();
                auto compound = std::make_unique<btCompoundShape>();
                compound->addChildShape(at(btScalar(-0.15), 0, 0), m_child.get());
                compound->addChildShape(at(btScalar(0.15), 0, 0), m_child.get());
                m_shape = std::move(compound);
                break;
        }
        return *m_shape;
    }

    std::unique_ptr<btCollisionShape> makeHull() const
    {
        auto hull = std::make_unique<btConvexHullShape>();
        for (std::size_t i = 0; i < m_mesh.m_positions.size(); i += 3)
            hull->addPoint(btVector3(m_mesh.m_positions[i], m_mesh.m_positions[i + 1], m_mesh.m_positions[i + 2]));
        hull->setMargin(kMargin);
        return hull;
    }

    TriangleMesh m_mesh;  // the body's, or that of its first child
    std::unique_ptr<GImpact> m_gimpact;
    std::unique_ptr<btCollisionShape> m_child, m_shape;
    Plugin m_plugin;
    DropWorld m_world;
    btSoftBody* m_cloth;
    btRigidBody* m_body;
};

class FineHammock : public Hammock
{
};

TEST_P(FineHammock, HoldsABody)
{
    EXPECT_EQ(m_plugin.whyStock(m_cloth, m_body), "");
    btScalar height = 0;
    for (int i = 0; i < 300; ++i)
    {
        m_world.step();
        ASSERT_EQ(pairsOf(*m_cloth, m_mesh, *m_body), 0u) << "step " << i;
        if (i == 240) height = m_body->getWorldTransform().getOrigin().y();
    }
    // A second later it has not sunk farther.
    EXPECT_NEAR(m_body->getWorldTransform().getOrigin().y(), height, 0.05);
}

TEST_P(Hammock, HoldsABodyUntilItIsReleased)
{
    EXPECT_EQ(m_plugin.whyStock(m_cloth, m_body), "");
    for (int i = 0; i < 1200 && m_body->isActive(); ++i)
    {
        m_world.step();
        ASSERT_EQ(pairsOf(*m_cloth, m_mesh, *m_body), 0u) << "step " << i;
    }
    EXPECT_FALSE(m_body->isActive());
    const btScalar height = m_body->getWorldTransform().getOrigin().y();
    m_world.step(10);
    EXPECT_FALSE(m_body->isActive());
    EXPECT_FALSE(m_cloth->isActive());
    EXPECT_EQ(m_plugin.statistics().m_clothsSkipped, 1u);
    EXPECT_EQ(m_body->getWorldTransform().getOrigin().y(), height);
    setMassOfBorder(btScalar(0.001));
    m_cloth->activate();
    m_world.step(30);
    EXPECT_LT(m_body->getWorldTransform().getOrigin().y(), height - btScalar(0.5));
}

// Bullet's algorithm for GImpact shapes registers itself for soft bodies, too, which it cannot handle.
TEST(GImpactMeshes, StayDrapesAfterBulletsAlgorithmIsRegistered)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btGImpactCollisionAlgorithm::registerAlgorithm(&world.dispatcher());
    GImpact ball(makeSphere(0.3f, 2));
    world.addObstacle(ball.shape());
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(0.4), 0);
    btSoftBody& cloth = world.addCloth(spec);
    world.step(60);
    EXPECT_GT(plugin.statistics().m_contacts, 0u);
    EXPECT_GT(lowestOf(cloth), btScalar(-0.3));
}

// A box, a GImpact mesh and two cloths, on every back end and with any number of threads.
class DynamicBodies : public BackendTest
{
};

TEST_P(DynamicBodies, MoveWithTheSameBits)
{
    const auto hashOfRun = [](const Settings& settings)
    {
        Plugin plugin(settings);
        DropWorld world(&plugin);
        GImpact ball(makeSphere(0.2f, 2));
        btBoxShape shape(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1)));
        btRigidBody& body = world.addDynamic(ball.shape(), 1, at(0, btScalar(0.25), 0));
        btRigidBody& box = world.addDynamic(shape, btScalar(0.5), at(btScalar(0.1), btScalar(0.7), 0));
        btSoftBody* cloths[2];
        for (int i = 0; i < 2; ++i)
        {
            ClothSpec spec;
            spec.m_centre = btVector3(0, btScalar(-0.1) * btScalar(i), btScalar(0.5) * btScalar(i));
            cloths[i] = &world.addCloth(spec);
            for (const int corner : {0, 16, 16 * 17, 17 * 17 - 1})
                cloths[i]->setMass(corner, 0);
        }
        std::uint64_t hash = kHashStart;
        for (int i = 0; i < 60; ++i)
        {
            world.step();
            hash = hashOf(*cloths[1], hashOf(*cloths[0], hash));
            for (const btSoftBody* cloth : cloths)
            {
                EXPECT_EQ(pairsOf(*cloth, ball.mesh(), body), 0u) << "step " << i;
                EXPECT_EQ(pairsOf(*cloth, makeBox(0.2f, 0.2f, 0.2f), box), 0u) << "step " << i;
            }
        }
        EXPECT_GT(plugin.statistics().m_contacts, 0u);
        EXPECT_GT(body.getWorldTransform().getOrigin().y(), -1);
        EXPECT_GT(box.getWorldTransform().getOrigin().y(), -1);
        return hash;
    };
    Settings alone = hostSettings();
    alone.m_threads = 1;
    EXPECT_EQ(hashOfRun(GetParam().m_settings), hashOfRun(alone));
}

// Nobody solves its links: all of its nodes are pinned.
TEST(DynamicBox, RestsOnClothThatIsPinnedEverywhere)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(ClothSpec());
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        cloth.setMass(i, 0);
    btBoxShape shape(btVector3(btScalar(0.2), btScalar(0.1), btScalar(0.2)));
    btRigidBody& box = world.addDynamic(shape, 2, at(0, btScalar(0.3), 0));
    for (int i = 0; i < 120; ++i)
    {
        world.step();
        ASSERT_EQ(pairsOf(cloth, makeBox(0.4f, 0.2f, 0.4f), box), 0u) << "step " << i;
    }
    EXPECT_GT(box.getWorldTransform().getOrigin().y(), btScalar(0.1));
    EXPECT_LT(box.getLinearVelocity().length(), btScalar(0.01));
}

// A body that Bullet holds where it is pushes nothing, whatever velocity it has.
TEST(DynamicBox, ThatIsFrozenInFlightIsAnObstacleAtRest)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btBoxShape shape(btVector3(btScalar(0.6), btScalar(0.1), btScalar(0.6)));
    btRigidBody& box = world.addDynamic(shape, 1, at(0, btScalar(-0.2), 0));
    box.setLinearVelocity(btVector3(0, 5, 0));
    box.forceActivationState(DISABLE_SIMULATION);
    btSoftBody& cloth = world.addCloth(ClothSpec());
    world.step(90);
    EXPECT_GT(lowestOf(cloth), btScalar(-0.1));
    EXPECT_LT(rmsSpeed(cloth), 0.01);
}

// A box under a cloth lands on a floor of Bullet's: the cloth must not move it into the floor.
TEST(DynamicBox, LandsUnderAClothWithoutSinkingIntoTheFloor)
{
    const auto lowestBox = [](bool hasCloth)
    {
        Plugin plugin(hostSettings());
        DropWorld world(&plugin);
        btBoxShape floor(btVector3(4, 1, 4)), shape(btVector3(btScalar(0.3), btScalar(0.1), btScalar(0.3)));
        world.addObstacle(floor, at(0, -1, 0));
        btRigidBody& box = world.addDynamic(shape, 2, at(0, 1, 0));
        ClothSpec spec;
        spec.m_centre = btVector3(0, btScalar(1.13), 0);
        if (hasCloth) world.addCloth(spec).m_cfg.piterations = 10;
        btScalar lowest = 1;
        for (int i = 0; i < 60; ++i)
        {
            world.step();
            lowest = std::min(lowest, box.getWorldTransform().getOrigin().y());
        }
        return lowest;
    };
    EXPECT_GT(lowestBox(true), lowestBox(false) - btScalar(0.005));
}

// A heavy box falls on a cloth that lies on the floor.
TEST(DynamicBox, RestsOnClothThatLiesOnTheFloor)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    MeshShape floor(makeBox(4, 0.4f, 4));
    world.addObstacle(floor.shape(), at(0, btScalar(-0.2), 0));
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(0.03), 0);
    btSoftBody& cloth = world.addCloth(spec);
    btBoxShape shape(btVector3(btScalar(0.2), btScalar(0.1), btScalar(0.2)));
    btRigidBody& box = world.addDynamic(shape, 50, at(btScalar(0.05), btScalar(0.5), 0));
    const TriangleMesh mesh = makeBox(0.4f, 0.2f, 0.4f);
    PenetrationMeter ground(placed(makeBox(4, 0.4f, 4), at(0, btScalar(-0.2), 0)), meshOf(cloth));
    for (int i = 0; i < 240; ++i)
    {
        world.step();
        ASSERT_EQ(pairsOf(cloth, mesh, box), 0u) << "step " << i;
        ASSERT_EQ(ground.measure(positionsOf(cloth).data()).m_intersectingPairs, 0u) << "step " << i;
    }
    const btScalar height = box.getWorldTransform().getOrigin().y();
    EXPECT_GT(height, btScalar(0.1) + 2 * kMargin);
    EXPECT_LT(height, btScalar(0.1) + 5 * kMargin);
    EXPECT_LT(box.getLinearVelocity().length(), btScalar(0.01));
}

INSTANTIATE_TEST_SUITE_P(Backends, DynamicBodies, testing::ValuesIn(allBackends()), backendName);

INSTANTIATE_TEST_SUITE_P(Loads, Hammock,
                         testing::Values(std::pair(Load::Mesh, 33), std::pair(Load::Box, 33), std::pair(Load::Ball, 33),
                                         std::pair(Load::Hull, 33), std::pair(Load::Compound, 33)));

INSTANTIATE_TEST_SUITE_P(Loads, FineHammock,
                         testing::Values(std::pair(Load::Mesh, 65), std::pair(Load::Box, 65),
                                         std::pair(Load::Ball, 65)));
}  // namespace drape::test
