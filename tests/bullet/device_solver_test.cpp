// Cloth solved on an OpenCL device: the host's trajectories bit for bit, for one cloth and for many, beside obstacles
// that rest or move, and the host's help where a device cannot solve.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr int kSteps = 60;

struct Trajectory
{
    std::uint64_t m_hash = kHashStart;
    std::size_t m_onDevice = 0;        // cloths that the device solved, over all steps
    std::size_t m_waitsAtEnd = 0;      // for the device, in the last step
    std::size_t m_contactsAtEnd = 0;   // number in the last step
    std::vector<ContactInfo> m_asked;  // the last step's contacts, asked for after it
};

// A world with a sphere, to which a test adds cloths and other objects.
struct Scene
{
    std::function<void(DropWorld&, std::vector<btSoftBody*>&)> m_addCloths;
    btVector3 m_shift = btVector3(0, 0, 0);  // m, of the obstacle in each step
    btScalar m_turn = 0;                     // rad, about y
    btScalar m_friction = btScalar(0.5);
    int m_levels = 3;  // subdivisions of the sphere
    btScalar m_margin = kMargin;
    int m_steps = kSteps;
    std::function<void(std::vector<btSoftBody*>&, int)> m_beforeStep = nullptr;  // gets the cloths and the step
};

Trajectory run(const Scene& scene, Settings settings, SolverPlace place)
{
    settings.m_solver = Solver::Drape;
    settings.m_solverPlace = place;
    settings.m_dynamicConvex = settings.m_staticConvex = ShapeContacts::Bullet;
    settings.m_surfaces = ShapeContacts::Bullet;
    Plugin plugin(settings);
    MeshShape shape(makeSphere(0.4f, scene.m_levels));
    shape.shape().setMargin(scene.m_margin);
    DropWorld world(&plugin);
    btRigidBody& obstacle = world.addKinematic(shape.shape());
    obstacle.setFriction(scene.m_friction);
    std::vector<btSoftBody*> cloths;
    scene.m_addCloths(world, cloths);
    for (btSoftBody* cloth : cloths)
        cloth->getCollisionShape()->setMargin(scene.m_margin);
    Trajectory trajectory;
    btTransform pose = btTransform::getIdentity();
    for (int step = 0; step < scene.m_steps; ++step)
    {
        pose.setOrigin(pose.getOrigin() + scene.m_shift);
        pose.setBasis(btMatrix3x3(btQuaternion(btVector3(0, 1, 0), scene.m_turn * btScalar(step + 1))));
        obstacle.setWorldTransform(pose);
        if (scene.m_beforeStep) scene.m_beforeStep(cloths, step);
        world.step();
        trajectory.m_onDevice += plugin.statistics().m_clothsSolvedOnDevice;
        for (const btSoftBody* cloth : cloths)
            trajectory.m_hash = hashOf(*cloth, trajectory.m_hash);
    }
    trajectory.m_waitsAtEnd = plugin.statistics().m_deviceWaits;
    trajectory.m_contactsAtEnd = plugin.statistics().m_contacts;
    trajectory.m_asked = plugin.contacts();
    return trajectory;
}

std::function<void(DropWorld&, std::vector<btSoftBody*>&)> clothsOf(int count, int nodes, btScalar speed)
{
    return [=](DropWorld& world, std::vector<btSoftBody*>& cloths)
    {
        for (int i = 0; i < count; ++i)
        {
            ClothSpec spec;
            spec.m_nodes = nodes;
            spec.m_centre = btVector3(0, btScalar(0.5) + btScalar(0.1) * btScalar(i), 0);
            btSoftBody& cloth = world.addCloth(spec);
            cloth.addVelocity(btVector3(0, -speed, 0));
            cloths.push_back(&cloth);
        }
    };
}

class DeviceSolverTest : public BackendTest
{
protected:
    // Runs the scene on the host and on the device. Returns the number of cloths that the device solved.
    std::size_t expectSame(const Scene& scene) const
    {
        const Trajectory host = run(scene, hostSettings(), SolverPlace::Host);
        const Trajectory device = run(scene, GetParam().m_settings, SolverPlace::Device);
        EXPECT_EQ(host.m_onDevice, 0u);
        EXPECT_EQ(host.m_hash, device.m_hash);
        return device.m_onDevice;
    }
};

TEST_P(DeviceSolverTest, AClothDropsAsOnTheHost)
{
    EXPECT_EQ(expectSame({clothsOf(1, 17, 0)}), std::size_t(kSteps));
    EXPECT_EQ(expectSame({clothsOf(1, 17, 20)}), std::size_t(kSteps));
}

// Paths of thin cloth follow the surface on which it lies.
TEST_P(DeviceSolverTest, ThinClothSlidesAsOnTheHost)
{
    Scene scene = {clothsOf(1, 17, 0)};
    scene.m_margin = btScalar(0.0007);
    scene.m_friction = 0;
    EXPECT_GT(expectSame(scene), std::size_t(kSteps / 2));
}

// Cloth that comes apart may exceed the limits of ordinary motion. All back ends agree on whether it does.
TEST_P(DeviceSolverTest, FastClothOnAFineMeshMovesAsOnTheHost)
{
    for (const btScalar speed : {btScalar(100), btScalar(200)})
    {
        Scene scene = {clothsOf(1, 33, speed)};
        scene.m_levels = 6;
        scene.m_steps = 10;
        expectSame(scene);
    }
}

// The contacts stay on the device, and the step is solved behind the detection. The last contacts come on request.
TEST_P(DeviceSolverTest, AStepAtRestWaitsOnce)
{
    const Scene scene = {clothsOf(1, 17, 0)};
    const Trajectory host = run(scene, hostSettings(), SolverPlace::Host);
    const Trajectory device = run(scene, GetParam().m_settings, SolverPlace::Device);
    EXPECT_EQ(device.m_waitsAtEnd, 1u);
    EXPECT_GT(device.m_contactsAtEnd, 0u);
    EXPECT_EQ(device.m_contactsAtEnd, host.m_contactsAtEnd);
    ASSERT_EQ(device.m_asked.size(), host.m_asked.size());
    for (std::size_t i = 0; i < host.m_asked.size(); ++i)
    {
        EXPECT_EQ(device.m_asked[i].m_gap, host.m_asked[i].m_gap);
        EXPECT_EQ(device.m_asked[i].m_nodes[0], host.m_asked[i].m_nodes[0]);
    }
}

// Cloths of two and of eight leaves, which take launches for each level.
TEST_P(DeviceSolverTest, ALargeClothDropsAsOnTheHost)
{
    EXPECT_EQ(expectSame({clothsOf(1, 52, 2)}), std::size_t(kSteps));
    EXPECT_EQ(expectSame({clothsOf(1, 100, 10)}), std::size_t(kSteps));
}

TEST_P(DeviceSolverTest, AMovingObstacleCarriesALargeClothAsOnTheHost)
{
    Scene scene = {clothsOf(1, 60, 1)};
    scene.m_shift = btVector3(btScalar(0.01), btScalar(0.005), 0);
    scene.m_turn = btScalar(0.05);
    EXPECT_EQ(expectSame(scene), std::size_t(kSteps));
}

// The host solves those whose paths meet a surface beside others whose paths do not.
TEST_P(DeviceSolverTest, ClothsOfAllSizesDropTogetherAsOnTheHost)
{
    const auto addAll = [](DropWorld& world, std::vector<btSoftBody*>& cloths)
    {
        for (const int nodes : {9, 60, 30, 100})
            clothsOf(1, nodes, 2)(world, cloths);
    };
    EXPECT_GT(expectSame({addAll}), std::size_t(4 * kSteps / 2));
}

TEST_P(DeviceSolverTest, ManyClothsDropAsOnTheHost)
{
    EXPECT_GT(expectSame({clothsOf(20, 9, 1)}), std::size_t(20 * kSteps / 2));
}

TEST_P(DeviceSolverTest, AMovingObstacleCarriesClothAsOnTheHost)
{
    Scene scene = {clothsOf(2, 17, 1)};
    scene.m_shift = btVector3(btScalar(0.01), btScalar(0.005), 0);
    scene.m_turn = btScalar(0.05);
    EXPECT_GT(expectSame(scene), std::size_t(2 * kSteps / 2));
}

TEST_P(DeviceSolverTest, APinnedFlagWithoutContactsMovesAsOnTheHost)
{
    const auto addFlag = [](DropWorld& world, std::vector<btSoftBody*>& cloths)
    {
        ClothSpec spec;
        spec.m_centre = btVector3(5, 5, 0);
        btSoftBody& flag = world.addCloth(spec);
        flag.setMass(0, 0);
        flag.setMass(16, 0);
        cloths.push_back(&flag);
    };
    EXPECT_EQ(expectSame({addFlag}), std::size_t(kSteps));
}

// Away from the obstacle, so that its momentum is kept.
TEST_P(DeviceSolverTest, AFreeClothTurnsAsOnTheHost)
{
    const auto addTurning = [](DropWorld& world, std::vector<btSoftBody*>& cloths)
    {
        ClothSpec spec;
        spec.m_centre = btVector3(5, 25, 0);
        btSoftBody& cloth = world.addCloth(spec);
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
            cloth.m_nodes[i].m_v = btVector3(1, 2, 3).cross(cloth.m_nodes[i].m_x - spec.m_centre);
        cloths.push_back(&cloth);
    };
    EXPECT_EQ(expectSame({addTurning}), std::size_t(kSteps));
}

btTransform at(btScalar x, btScalar y, btScalar z)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(x, y, z));
}

// Cloths of one leaf and of several that touch the sphere's mesh, a box, a ball and a plane, whose contacts Bullet's
// own algorithms find.
TEST_P(DeviceSolverTest, ClothOnBoxBallPlaneAndMeshMovesAsOnTheHost)
{
    btBoxShape box(btVector3(btScalar(0.2), btScalar(0.1), btScalar(0.2)));
    btSphereShape ball(btScalar(0.2));
    btStaticPlaneShape plane(btVector3(0, 1, 0), btScalar(0.1));
    for (const int nodes : {17, 60})
    {
        const auto addAll = [&](DropWorld& world, std::vector<btSoftBody*>& cloths)
        {
            clothsOf(1, nodes, 1)(world, cloths);
            world.addObstacle(box, at(btScalar(0.45), btScalar(0.2), 0));
            world.addKinematic(ball, at(btScalar(-0.4), btScalar(0.15), btScalar(0.2)));
            world.addObstacle(plane);
        };
        EXPECT_EQ(expectSame({addAll}), std::size_t(kSteps)) << nodes;
    }
}

TEST_P(DeviceSolverTest, ClothHangsOnAKinematicBodyAsOnTheHost)
{
    btBoxShape box(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1)));
    const auto addHanging = [&](DropWorld& world, std::vector<btSoftBody*>& cloths)
    {
        clothsOf(1, 17, 0)(world, cloths);
        btRigidBody& holder = world.addKinematic(box, at(btScalar(-0.5), btScalar(0.7), btScalar(-0.5)));
        cloths[0]->appendAnchor(0, &holder, true);
        cloths[0]->appendAnchor(17, &holder, true, btScalar(0.5));
    };
    EXPECT_EQ(expectSame({addHanging}), std::size_t(kSteps));
}

// A large cloth loses its only row. The device then solves steps without rows.
TEST_P(DeviceSolverTest, RowsOfALargeClothVanishAsOnTheHost)
{
    btBoxShape box(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1)));
    Scene scene;
    scene.m_addCloths = [&](DropWorld& world, std::vector<btSoftBody*>& cloths)
    {
        clothsOf(1, 60, 0)(world, cloths);
        btRigidBody& holder = world.addKinematic(box, at(btScalar(-0.5), btScalar(0.7), btScalar(-0.5)));
        cloths[0]->appendAnchor(0, &holder, true);
    };
    scene.m_steps = 10;
    scene.m_beforeStep = [](std::vector<btSoftBody*>& cloths, int step)
    {
        if (step == 5) cloths[0]->m_anchors.clear();
    };
    EXPECT_EQ(expectSame(scene), 10u);
}

// Two cloths hang on one weight, and a third falls beside them. Both pull at the weight in the same substeps.
TEST_P(DeviceSolverTest, ClothsShareADynamicBodyAsOnTheHost)
{
    btBoxShape weight(btVector3(btScalar(0.1), btScalar(0.05), btScalar(0.1)));
    const auto addSharing = [&](DropWorld& world, std::vector<btSoftBody*>& cloths)
    {
        clothsOf(3, 17, 0)(world, cloths);
        btRigidBody& body = world.addDynamic(weight, btScalar(0.2), at(btScalar(0.7), btScalar(0.6), 0));
        for (std::size_t i = 0; i < 2; ++i)
        {
            cloths[i]->appendAnchor(16 * 17, &body, true);
            cloths[i]->appendAnchor(17 * 17 - 1, &body, true, btScalar(0.5));
        }
    };
    EXPECT_GT(expectSame({addSharing}), std::size_t(5 * kSteps / 2));
}

// A light box falls onto cloth on the sphere, beside a fixed box.
TEST_P(DeviceSolverTest, ABoxFallsOnClothAsOnTheHost)
{
    btBoxShape box(btVector3(btScalar(0.25), btScalar(0.1), btScalar(0.25)));
    for (const int nodes : {17, 52})
    {
        const auto addFalling = [&](DropWorld& world, std::vector<btSoftBody*>& cloths)
        {
            clothsOf(1, nodes, 1)(world, cloths);
            world.addDynamic(box, btScalar(0.1), at(0, btScalar(0.8), 0));
            world.addObstacle(box, at(btScalar(0.5), btScalar(0.3), 0));
        };
        EXPECT_GT(expectSame({addFalling}), std::size_t(kSteps / 2)) << nodes;
    }
}

// All nodes of a cloth touch a plate that may move. A device would visit them one after the other.
TEST_P(DeviceSolverTest, TheHostSolvesManyRowsWithADynamicBody)
{
    btBoxShape plate(btVector3(btScalar(0.6), btScalar(0.05), btScalar(0.6)));
    const auto addOnPlate = [&](DropWorld& world, std::vector<btSoftBody*>& cloths)
    {
        clothsOf(1, 40, 1)(world, cloths);
        world.addDynamic(plate, 5, at(0, btScalar(0.42), 0));
    };
    EXPECT_LT(expectSame({addOnPlate}), std::size_t(kSteps / 2));
}

// The host solves a cloth whose path meets the sphere, and with it the one that shares its weight.
TEST_P(DeviceSolverTest, ClothsThatShareABodyGoToTheHostTogether)
{
    btBoxShape weight(btVector3(btScalar(0.1), btScalar(0.05), btScalar(0.1)));
    const auto addThree = [&](DropWorld& world, std::vector<btSoftBody*>& cloths)
    {
        clothsOf(3, 9, 0)(world, cloths);
        cloths[0]->addVelocity(btVector3(0, btScalar(-20), 0));
        btRigidBody& body = world.addDynamic(weight, btScalar(0.2), at(5, btScalar(0.6), 0));
        cloths[0]->appendAnchor(0, &body, true);
        cloths[1]->appendAnchor(0, &body, true);
    };
    const std::size_t onDevice = expectSame({addThree});
    EXPECT_GT(onDevice, std::size_t(kSteps));
    EXPECT_LT(onDevice, std::size_t(3 * kSteps));
}

// The device has the data of one solver's cloths at a time.
TEST_P(DeviceSolverTest, TwoWorldsShareADevice)
{
    const auto runBoth = [](Settings settings, SolverPlace place)
    {
        settings.m_solver = Solver::Drape;
        settings.m_solverPlace = place;
        Plugin plugin(settings);
        MeshShape shape(makeSphere(0.4f, 3));
        DropWorld small(&plugin), large(&plugin);
        std::vector<btSoftBody*> cloths;
        clothsOf(1, 9, 1)(small, cloths);
        clothsOf(3, 17, 1)(large, cloths);
        std::uint64_t hash = kHashStart;
        for (DropWorld* world : {&small, &large})
            world->addKinematic(shape.shape());
        for (int step = 0; step < kSteps; ++step)
        {
            small.step();
            large.step();
        }
        for (const btSoftBody* cloth : cloths)
            hash = hashOf(*cloth, hash);
        return hash;
    };
    EXPECT_EQ(runBoth(hostSettings(), SolverPlace::Host), runBoth(GetParam().m_settings, SolverPlace::Device));
}

INSTANTIATE_TEST_SUITE_P(Devices, DeviceSolverTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace
}  // namespace drape::test
