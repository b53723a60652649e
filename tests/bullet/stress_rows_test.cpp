// Rows of the stress table that need a whole Bullet world. tests/README.md has the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"
#include "tests/support/memory.h"

namespace drape::test
{
namespace
{
constexpr btScalar kTop = btScalar(0.2);  // m, of the box

ClothSpec smallCloth(btScalar height)
{
    ClothSpec spec;
    spec.m_nodes = 9;
    spec.m_size = 0.5f;
    spec.m_centre = btVector3(0, height, 0);
    return spec;
}

btTransform at(double x, double y, double z)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

// Sets both transforms. A kinematic body of which only the world transform changes has moved there within the step.
void teleport(btCollisionObject& object, const btTransform& pose)
{
    object.setWorldTransform(pose);
    object.setInterpolationWorldTransform(pose);
}

bool allFinite(const btSoftBody& cloth)
{
    const std::vector<float> positions = positionsOf(cloth);
    return std::all_of(positions.begin(), positions.end(), [](float value) { return std::isfinite(value); });
}

double fastest(const btSoftBody& cloth)
{
    double speed = 0;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        speed = std::max(speed, double(cloth.m_nodes[i].m_v.length()));
    return speed;
}
}  // namespace

class WorldRows : public BackendTest
{
protected:
    WorldRows() : m_box(makeBox(3.0f, 0.4f, 3.0f)), m_boxShape(m_box) {}

    std::uint64_t hashBesideABall(bool kinematic, bool jumping);
    // Returns the fastest node's speed of a cloth on the box while a ball jumps into it repeatedly.
    double fastestWithABallInside(bool kinematic);

    static btCollisionObject& addBall(DropWorld& world, MeshShape& sphere, const btTransform& pose, bool kinematic)
    {
        return kinematic ? world.addKinematic(sphere.shape(), pose) : world.addObstacle(sphere.shape(), pose);
    }

    TriangleMesh m_box;
    MeshShape m_boxShape;
};

std::uint64_t WorldRows::hashBesideABall(bool kinematic, bool jumping)
{
    MeshShape sphere(makeSphere(0.3f, 2));
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    world.addObstacle(m_boxShape.shape());
    btSoftBody& cloth = world.addCloth(smallCloth(kTop + btScalar(0.5)));
    btCollisionObject& ball = addBall(world, sphere, at(0, 3, 0), kinematic);
    std::uint64_t hash = kHashStart;
    for (int step = 0; step < 60; ++step)
    {
        // The ball jumps above the cloth, far below it, and beside it, each time through it.
        if (jumping) teleport(ball, at(step % 3 == 2 ? 2 : 0, step % 3 == 1 ? -3 : 3, 0));
        world.step();
        hash = hashOf(cloth, hash);
    }
    EXPECT_GT(plugin.statistics().m_contacts, 0u);
    return hash;
}

// An obstacle that jumps from one side of the cloth to the other sweeps nothing: the cloth moves as without it.
TEST_P(WorldRows, Row15TeleportSweepsNothing)
{
    for (const bool kinematic : {false, true})
        EXPECT_EQ(hashBesideABall(kinematic, true), hashBesideABall(kinematic, false)) << "kinematic " << kinematic;
}

double WorldRows::fastestWithABallInside(bool kinematic)
{
    MeshShape sphere(makeSphere(0.15f, 2));
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    world.addObstacle(m_boxShape.shape());
    btSoftBody& cloth = world.addCloth(smallCloth(kTop + btScalar(0.03)));
    btCollisionObject& ball = addBall(world, sphere, at(0, 5, 0), kinematic);
    world.step(60);
    double speed = 0;
    std::size_t touching = 0;  // contacts with the ball
    for (int jump = 0; jump < 6; ++jump)
    {
        teleport(ball, at(0.1 * jump - 0.25, double(kTop) + 0.1, 0));
        for (int step = 0; step < 5; ++step)
        {
            world.step();
            EXPECT_TRUE(allFinite(cloth));
            speed = std::max(speed, fastest(cloth));
            for (const ContactInfo& contact : plugin.contacts())
                touching += contact.m_obstacle == &ball;
        }
        teleport(ball, at(0, 5, 0));
        world.step(5);
    }
    EXPECT_GT(touching, 0u) << "the ball never touched the cloth";
    world.step(120);
    EXPECT_GT(lowestOf(cloth), kTop);
    return speed;
}

// The ball jumps into the middle of the cloth, and pushes it out gently.
TEST_P(WorldRows, Row15TeleportIntoTheClothGivesNoGiantImpulse)
{
    // A displacement of the ball's radius in one step would be 9 m/s.
    for (const bool kinematic : {false, true})
        EXPECT_LT(fastestWithABallInside(kinematic), 9.0) << "kinematic " << kinematic;
}

namespace
{
// Returns the nodes' positions and velocities, bit for bit.
std::vector<float> stateOf(const btSoftBody& cloth)
{
    std::vector<float> state = positionsOf(cloth);
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            state.push_back(static_cast<float>(cloth.m_nodes[i].m_v[axis]));
    return state;
}
}  // namespace

// Bullet's world skips steps of zero duration, but an app may call the solver.
TEST_P(WorldRows, Row16StepOfNoTimeMovesNothing)
{
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    world.addObstacle(m_boxShape.shape());
    btSoftBody& cloth = world.addCloth(smallCloth(kTop + btScalar(0.1)));
    btSoftBodySolver& solver = *world.solver();
    for (const int steps : {4, 4, 60})  // it falls, comes to lie, lies
    {
        world.step(steps);
        const std::vector<float> before = stateOf(cloth);
        for (int step = 0; step < 3; ++step)
        {
            solver.predictMotion(0);
            world.world().performDiscreteCollisionDetection();
            solver.solveConstraints(0);
            solver.updateSoftBodies();
            ASSERT_EQ(stateOf(cloth), before);
            ASSERT_EQ(plugin.statistics().m_status, std::uint32_t(kStepGood));
        }
    }
    world.step(10);
    ASSERT_GT(plugin.statistics().m_contacts, 0u);
    EXPECT_TRUE(allFinite(cloth));
    EXPECT_NEAR(double(lowestOf(cloth)) - double(kTop), kThickness, 0.05 * kThickness);
}

// The cloth's time stands still in a running world. A plate comes up through it and another cloth falls beside it.
TEST_P(WorldRows, Row16ClothWithoutTimeStaysAsItIs)
{
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    MeshShape plateShape(makeBox(0.8f, 0.02f, 0.8f));
    btRigidBody& plate = world.addKinematic(plateShape.shape(), at(0, 0, 0));
    world.addObstacle(m_boxShape.shape(), at(4, 0, 0));
    btSoftBody& still = world.addCloth(smallCloth(btScalar(0.1)));
    ClothSpec spec = smallCloth(kTop + btScalar(0.1));
    spec.m_centre.setX(4);
    btSoftBody& falling = world.addCloth(spec);
    world.step(2);
    const std::vector<float> before = stateOf(still);
    for (int step = 1; step <= 60; ++step)
    {
        still.m_cfg.timescale = step % 2 ? btScalar(0) : btScalar(-1);
        plate.setWorldTransform(at(0, 0.01 * step, 0));
        world.step();
        ASSERT_EQ(stateOf(still), before) << "step " << step;
        ASSERT_EQ(plugin.statistics().m_status, std::uint32_t(kStepGood));
    }
    EXPECT_NEAR(double(lowestOf(falling)) - double(kTop), kThickness, 0.05 * kThickness);
    still.m_cfg.timescale = 1;
    world.step(30);
    EXPECT_TRUE(allFinite(still));
    EXPECT_NE(stateOf(still), before);
}

TEST_P(WorldRows, Row16HugeTimeStepsStayFinite)
{
    for (const btScalar dt : {btScalar(1), btScalar(10), btScalar(1000)})
    {
        SCOPED_TRACE(dt);
        Plugin plugin(GetParam().m_settings);
        DropWorld world(&plugin);
        world.addObstacle(m_boxShape.shape());
        btSoftBody& cloth = world.addCloth(smallCloth(kTop + btScalar(0.1)));
        for (int step = 0; step < 3; ++step)
        {
            world.world().stepSimulation(dt, 1, dt);
            ASSERT_TRUE(allFinite(cloth));
            // An upper bound is each feature of the cloth with each of the box; there are far fewer.
            EXPECT_LT(plugin.statistics().m_contacts, 10000u);
            EXPECT_EQ(plugin.statistics().m_status, std::uint32_t(kStepGood));
        }
    }
}

// The pair of pinned cloth and a static obstacle is skipped, and nothing moves. New masses restore the contacts.
TEST_P(WorldRows, Row17BothSidesPinned)
{
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    world.addObstacle(m_boxShape.shape());
    btSoftBody& cloth = world.addCloth(smallCloth(kTop + btScalar(0.01)));
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        cloth.setMass(i, 0);
    const std::uint64_t hash = hashOf(cloth);
    for (int step = 0; step < 20; ++step)
    {
        world.step();
        ASSERT_TRUE(plugin.statistics().m_skipped);
        ASSERT_EQ(plugin.statistics().m_candidates, 0u);
        ASSERT_TRUE(plugin.contacts().empty());
    }
    EXPECT_EQ(hashOf(cloth), hash);
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        cloth.setMass(i, btScalar(1) / btScalar(cloth.m_nodes.size()));
    world.step(60);
    EXPECT_TRUE(allFinite(cloth));
    EXPECT_NEAR(double(lowestOf(cloth)) - double(kTop), kThickness, 0.05 * kThickness);
}

// Faces are added and removed while the cloth lies on the box. Each change counts in the same step: a node that lost
// its faces has no contact of them, and a node that got a face has one.
TEST_P(WorldRows, Row24NodesAndFacesAddedAndRemoved)
{
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    world.addObstacle(m_boxShape.shape());
    btSoftBody& cloth = world.addCloth(smallCloth(kTop + btScalar(0.03)));
    world.step(30);
    const int facesBefore = cloth.m_faces.size();
    for (int round = 0; round < 12; ++round)
    {
        SCOPED_TRACE("round " + std::to_string(round));
        // A new corner beside the cloth's first edge, with a face to it.
        const btVector3 place = cloth.m_nodes[0].m_x + btVector3(btScalar(-0.06), 0, btScalar(0.02) * btScalar(round));
        cloth.appendNode(place, btScalar(0.01));
        cloth.appendLink(0, cloth.m_nodes.size() - 1);
        cloth.appendFace(0, 1, cloth.m_nodes.size() - 1);
        world.step();
        const std::vector<ContactInfo> contacts = plugin.contacts();
        EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(),
                                [&](const ContactInfo& contact)
                                { return contact.m_nodes[0] == cloth.m_nodes.size() - 1; }));
        for (const ContactInfo& contact : contacts)
            for (int node : contact.m_nodes)
                ASSERT_LT(node, cloth.m_nodes.size());
        if (round % 3 == 2)
        {
            // Cutting a link doubles its nodes and faces.
            const int nodes = cloth.m_nodes.size();
            cloth.cutLink(10 + round, 11 + round, btScalar(0.5));
            EXPECT_GE(cloth.m_nodes.size(), nodes);
        }
        world.step(5);
        ASSERT_TRUE(allFinite(cloth));
        EXPECT_GT(lowestOf(cloth), kTop);
    }
    while (cloth.m_faces.size() > facesBefore / 2)
        cloth.m_faces.pop_back();
    world.step(10);
    EXPECT_TRUE(allFinite(cloth));
    while (cloth.m_faces.size() > 0)
        cloth.m_faces.pop_back();
    world.step(2);
    EXPECT_GT(plugin.statistics().m_contacts, 0u) << "links without faces collide";
    while (cloth.m_links.size() > 0)
        cloth.m_links.pop_back();
    world.step(2);
    EXPECT_EQ(plugin.statistics().m_contacts, 0u);
}

// The cloth does not drift, memory does not grow, and the cloth lies still.
TEST_P(WorldRows, Row25TenThousandStepsAtRest)
{
    constexpr int kSettle = 300, kSteps = 10000;
    constexpr double kStill = 0.001;  // m/s, RMS; a step of free fall adds 0.16
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    world.addObstacle(m_boxShape.shape());
    btSoftBody& cloth = world.addCloth(smallCloth(kTop + btScalar(0.03)));
    world.step(kSettle);
    const std::vector<float> before = positionsOf(cloth);
    const std::size_t memory = residentBytes(), contacts = plugin.statistics().m_contacts;
    ASSERT_GT(contacts, 0u);
    double jitter = 0;
    for (int step = 0; step < kSteps; ++step)
    {
        world.step();
        jitter = std::max(jitter, rmsSpeed(cloth));
    }
    EXPECT_LT(jitter, kStill);
    EXPECT_LT(residentBytes(), memory + kGrowthBytes);
    EXPECT_LT(plugin.statistics().m_contacts, 2 * contacts);
    const std::vector<float> after = positionsOf(cloth);
    for (std::size_t i = 0; i < before.size(); ++i)
        ASSERT_NEAR(after[i], before[i], 0.1f * kThickness) << "coordinate " << i;
}

INSTANTIATE_TEST_SUITE_P(Backend, WorldRows, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
