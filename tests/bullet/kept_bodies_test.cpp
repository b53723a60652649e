// Bodies whose nodes stay on the device: the trajectories of bodies that Bullet has, whatever brings their nodes back.
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "kernels/lib/geometry/vec3.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr int kSteps = 60;

// A world with a sphere, and what a test does in it.
struct Scene
{
    ClothSpec m_cloth;
    std::function<void(DropWorld&, btSoftBody&)> m_add;                // further objects, pins and velocities
    std::function<void(btRigidBody&, btSoftBody&, int)> m_beforeStep;  // moves the sphere or pins
    btScalar m_friction = btScalar(0.5);
};

// A plugin and a world with a sphere. keeps: cloth may stay on the device of the settings; else the host computes.
struct SphereWorld
{
    SphereWorld(Settings settings, bool keeps) : m_shape(makeSphere(0.4f, 3))
    {
        settings.m_solver = Solver::Drape;
        settings.m_staticConvex = ShapeContacts::Bullet;
        settings.m_solverPlace = keeps ? SolverPlace::Device : SolverPlace::Host;
        m_plugin = std::make_unique<Plugin>(settings);
        m_world = std::make_unique<DropWorld>(m_plugin.get());
        m_sphere = &m_world->addKinematic(m_shape.shape());
    }

    MeshShape m_shape;
    std::unique_ptr<Plugin> m_plugin;
    std::unique_ptr<DropWorld> m_world;
    btRigidBody* m_sphere = nullptr;
};

struct Outcome
{
    std::uint64_t m_hash = kHashStart;
    int m_kept = 0;            // steps that left the nodes on the device
    std::string m_reason;      // why the body could not be kept
    std::size_t m_status = 0;  // bits of all steps
};

std::uint64_t hashOfAll(const btSoftBody& body, std::uint64_t hash)
{
    hash = hashOf(body, hash);
    for (int i = 0; i < body.m_nodes.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            hash = (hash ^ drapeBits(float(body.m_nodes[i].m_v[axis]))) * 0x100000001b3ull;
    return hash;
}

// Looks at the nodes in every tenth step.
Outcome run(const Scene& scene, const Settings& settings, bool keeps)
{
    SphereWorld all(settings, keeps);
    Plugin& plugin = *all.m_plugin;
    all.m_sphere->setFriction(scene.m_friction);
    btSoftBody& cloth = all.m_world->addCloth(scene.m_cloth);
    if (scene.m_add) scene.m_add(*all.m_world, cloth);
    Outcome result;
    if (keeps) result.m_reason = plugin.keepOnDevice(cloth, true);
    for (int step = 0; step < kSteps; ++step)
    {
        if (scene.m_beforeStep) scene.m_beforeStep(*all.m_sphere, cloth, step);
        all.m_world->step();
        result.m_kept += plugin.statistics().m_clothsKept > 0;
        result.m_status |= plugin.statistics().m_status;
        if (step % 10 != 0) continue;
        if (keeps) plugin.fetch(cloth);
        result.m_hash = hashOfAll(cloth, result.m_hash);
    }
    if (keeps) plugin.keepOnDevice(cloth, false);
    result.m_hash = hashOfAll(cloth, result.m_hash);
    return result;
}

class KeptBodyTest : public BackendTest
{
protected:
    Settings settingsFor(bool keeps) const { return keeps ? GetParam().m_settings : hostSettings(); }
    // Runs the scene with and without keeping the cloth. Returns the steps in which it stayed on the device.
    int expectSame(const Scene& scene) const
    {
        const Outcome plain = run(scene, settingsFor(false), false), kept = run(scene, settingsFor(true), true);
        EXPECT_EQ(kept.m_reason, "");
        EXPECT_EQ(plain.m_hash, kept.m_hash);
        EXPECT_EQ(plain.m_status, kept.m_status);
        EXPECT_EQ(plain.m_kept, 0);
        return kept.m_kept;
    }
};

ClothSpec clothOf(int nodes)
{
    ClothSpec spec;
    spec.m_nodes = nodes;
    spec.m_centre = btVector3(0, btScalar(0.45), 0);
    return spec;
}

TEST_P(KeptBodyTest, ClothComesToRestAsAtHome)
{
    EXPECT_GT(expectSame({clothOf(17), nullptr, nullptr}), kSteps / 2);
}

TEST_P(KeptBodyTest, LargeClothMovesAsAtHome)
{
    EXPECT_GT(expectSame({clothOf(60), nullptr, nullptr}), kSteps / 4);
}

// A large cloth is cut into parts where its nodes are as it meets its first obstacle.
TEST_P(KeptBodyTest, AnObstacleArrivesAtLargeClothAsAtHome)
{
    Scene scene = {clothOf(60), nullptr, nullptr};
    scene.m_cloth.m_centre = btVector3(btScalar(1.5), btScalar(0.6), 0);
    scene.m_add = [](DropWorld&, btSoftBody& cloth)
    {
        for (int i = 0; i < 60; ++i)
            cloth.setMass(60 * i, 0);
    };
    scene.m_beforeStep = [](btRigidBody& sphere, btSoftBody&, int step)
    {
        const btVector3 at(btScalar(0.03) * btScalar(step), 0, 0);
        sphere.setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    };
    EXPECT_GT(expectSame(scene), kSteps / 4);
}

TEST_P(KeptBodyTest, AMovingObstacleCarriesClothAsAtHome)
{
    Scene scene = {clothOf(17), nullptr, nullptr};
    scene.m_beforeStep = [](btRigidBody& sphere, btSoftBody&, int step)
    {
        btTransform pose(btQuaternion(btVector3(0, 1, 0), btScalar(0.02) * btScalar(step)));
        pose.setOrigin(btVector3(btScalar(0.005) * btScalar(step), 0, 0));
        sphere.setWorldTransform(pose);
    };
    EXPECT_GT(expectSame(scene), kSteps / 4);
}

// The device solves it without a detection.
TEST_P(KeptBodyTest, AFlagWithoutObstaclesMovesAsAtHome)
{
    Scene scene = {clothOf(17), nullptr, nullptr};
    scene.m_cloth.m_centre = btVector3(5, 5, 0);
    scene.m_add = [](DropWorld&, btSoftBody& cloth)
    {
        cloth.setMass(0, 0);
        cloth.setMass(16, 0);
    };
    EXPECT_EQ(expectSame(scene), kSteps - 1);
}

// The host keeps its momentum, so that it never leaves.
TEST_P(KeptBodyTest, ClothInFreeFallMovesAsAtHome)
{
    Scene scene = {clothOf(9), nullptr, nullptr};
    scene.m_cloth.m_centre = btVector3(5, 50, 0);
    EXPECT_EQ(expectSame(scene), 0);
}

TEST_P(KeptBodyTest, AnAppMovesPinsAsAtHome)
{
    Scene scene = {clothOf(17), nullptr, nullptr};
    scene.m_add = [](DropWorld&, btSoftBody& cloth) { cloth.setMass(0, 0); };
    scene.m_beforeStep = [](btRigidBody&, btSoftBody& cloth, int step)
    {
        if (step > 20 && step < 30) cloth.m_nodes[0].m_x += btVector3(0, btScalar(0.01), 0);
    };
    EXPECT_GT(expectSame(scene), kSteps / 4);
}

// Bullet's own algorithm finds the box; the nodes are brought to the host while it is near.
TEST_P(KeptBodyTest, ABoxBringsClothToTheHost)
{
    btBoxShape box(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1)));
    Scene scene = {clothOf(17), nullptr, nullptr};
    scene.m_add = [&](DropWorld& world, btSoftBody&)
    { world.addKinematic(box, btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.4), btScalar(0.2), 0))); };
    EXPECT_LT(expectSame(scene), kSteps / 2);
}

// A plane's bounds are infinite, and another cloth's overlap. Neither touches it.
TEST_P(KeptBodyTest, ClothStaysAwayOverAPlaneAndBesideAnotherCloth)
{
    btStaticPlaneShape plane(btVector3(0, 1, 0), -3);
    Scene scene = {clothOf(17), nullptr, nullptr};
    scene.m_add = [&](DropWorld& world, btSoftBody&)
    {
        world.addObstacle(plane);
        ClothSpec other = clothOf(9);
        other.m_centre.setY(btScalar(0.6));
        world.addCloth(other);
    };
    EXPECT_GT(expectSame(scene), kSteps / 4);
}

TEST_P(KeptBodyTest, ArraysHaveTheNodesOfTheStepThatAskedForThem)
{
    SphereWorld all(GetParam().m_settings, true);
    Plugin& plugin = *all.m_plugin;
    DropWorld& world = *all.m_world;
    btSoftBody& cloth = world.addCloth(clothOf(17));
    const std::size_t count = 3 * static_cast<std::size_t>(cloth.m_nodes.size());
    std::vector<float> now(count), later(count), velocities(count), normals(count);
    EXPECT_FALSE(plugin.fetch(cloth, {now.data(), nullptr, nullptr}));
    ASSERT_EQ(plugin.keepOnDevice(cloth, true), "");
    for (int step = 0; step < 40; ++step)
        world.step();
    ASSERT_TRUE(plugin.fetch(cloth, {now.data(), nullptr, nullptr}));
    plugin.beginFetch(cloth);
    world.step();
    ASSERT_TRUE(plugin.fetch(cloth, {later.data(), velocities.data(), normals.data()}));
    EXPECT_EQ(now, later);
    ASSERT_TRUE(plugin.fetch(cloth, {later.data(), velocities.data(), normals.data()}));
    EXPECT_NE(now, later);
    ASSERT_TRUE(plugin.fetch(cloth));
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
        {
            const std::size_t at = 3 * std::size_t(i) + std::size_t(axis);
            EXPECT_EQ(cloth.m_nodes[i].m_x[axis], later[at]);
            EXPECT_EQ(cloth.m_nodes[i].m_v[axis], velocities[at]);
            EXPECT_NEAR(cloth.m_nodes[i].m_n[axis], normals[at], 1e-5);
        }
}

TEST_P(KeptBodyTest, NodesThatAnAppSetsAreTakenOnRequest)
{
    const auto runWith = [&](bool keeps)
    {
        SphereWorld all(settingsFor(keeps), keeps);
        Plugin& plugin = *all.m_plugin;
        DropWorld& world = *all.m_world;
        btSoftBody& cloth = world.addCloth(clothOf(17));
        if (keeps) plugin.keepOnDevice(cloth, true);
        for (int step = 0; step < 60; ++step)
        {
            if (step == 30)
            {
                if (keeps) plugin.fetch(cloth);
                cloth.addVelocity(btVector3(btScalar(0.3), 0, 0));
                if (keeps) plugin.takeNodes(cloth);
            }
            if (keeps) plugin.keepOnDevice(cloth, true);  // changes nothing
            world.step();
        }
        if (keeps) plugin.fetch(cloth);
        return hashOfAll(cloth, kHashStart);
    };
    EXPECT_EQ(runWith(false), runWith(true));
}

// The body has more nodes than the device keeps.
namespace
{
// An app's call for a kept cloth after a step.
enum class Then
{
    Nothing,
    Release,
    Take
};

// Lets thin cloth slide on a plate under gravity that leans. Returns the hash of its nodes after 60 steps; `kept` gets
// the number of steps that left them on the device.
std::uint64_t slideOnPlate(const Settings& given, bool keeps, Then then, int& kept)
{
    Settings settings = given;
    settings.m_solver = Solver::Drape;
    settings.m_solverPlace = keeps ? SolverPlace::Device : SolverPlace::Host;
    Plugin plugin(settings);
    MeshShape plate(makeBox(6.0f, 0.4f, 6.0f));
    DropWorld world(&plugin);
    world.addObstacle(plate.shape());
    plate.shape().setMargin(btScalar(0.0005));
    ClothSpec spec;
    spec.m_nodes = 17;
    spec.m_centre = btVector3(btScalar(0.013), btScalar(0.201), btScalar(0.007));
    btSoftBody& cloth = world.addCloth(spec);
    cloth.getCollisionShape()->setMargin(btScalar(0.0005));
    cloth.m_cfg.kDF = 0;
    const btVector3 gravity(3, -9, 0);
    world.world().setGravity(gravity);
    world.world().getWorldInfo().m_gravity = gravity;
    kept = 0;
    for (int step = 0; step < 60; ++step)
    {
        if (keeps) plugin.keepOnDevice(cloth, true);
        world.step();
        if (plugin.statistics().m_clothsKept == 0) continue;
        ++kept;
        if (then == Then::Release) plugin.keepOnDevice(cloth, false);
        if (then == Then::Take && plugin.fetch(cloth)) plugin.takeNodes(cloth);
    }
    if (keeps) plugin.keepOnDevice(cloth, false);
    return hashOfAll(cloth, kHashStart);
}
}  // namespace

// The paths of thin cloth depend on how contacts held it in the step before, on the device and on the way to the host.
TEST_P(KeptBodyTest, ThinClothSlidesAsAtHome)
{
    int kept = 0;
    const std::uint64_t home = slideOnPlate(settingsFor(false), false, Then::Nothing, kept);
    EXPECT_EQ(kept, 0);
    EXPECT_EQ(home, slideOnPlate(settingsFor(true), true, Then::Nothing, kept));
    EXPECT_GT(kept, kSteps / 2);
    for (const Then then : {Then::Release, Then::Take})
    {
        EXPECT_EQ(home, slideOnPlate(settingsFor(true), true, then, kept)) << int(then);
        EXPECT_GT(kept, kSteps / 4) << int(then);
    }
}

TEST_P(KeptBodyTest, ANodeIsAddedAsAtHome)
{
    Scene scene = {clothOf(17), nullptr, nullptr};
    scene.m_beforeStep = [](btRigidBody&, btSoftBody& cloth, int step)
    {
        if (step != 30) return;
        cloth.appendNode(btVector3(2, 2, 0), btScalar(0.1));
        cloth.appendLink(0, cloth.m_nodes.size() - 1);
    };
    EXPECT_GT(expectSame(scene), kSteps / 4);
}

// Links and faces of a large cloth are sorted by where its nodes are.
TEST_P(KeptBodyTest, LinksAndFacesOfALargeClothChangeAsAtHome)
{
    Scene scene = {clothOf(60), nullptr, nullptr};
    scene.m_beforeStep = [](btRigidBody&, btSoftBody& cloth, int step)
    {
        if (step == 30) cloth.appendLink(0, 5);
        if (step == 40) cloth.m_faces.pop_back();
    };
    EXPECT_GT(expectSame(scene), kSteps / 4);
}

// Bodies come and go, and others take their places in the device's memory.
TEST_P(KeptBodyTest, RemovedBodiesAreForgotten)
{
    const auto runWith = [&](bool keeps)
    {
        SphereWorld all(settingsFor(keeps), keeps);
        Plugin& plugin = *all.m_plugin;
        DropWorld& world = *all.m_world;
        std::uint64_t hash = kHashStart;
        for (const int nodes : {17, 17, 23, 17, 9})
        {
            btSoftBody& cloth = world.addCloth(clothOf(nodes));
            if (keeps) plugin.keepOnDevice(cloth, true);
            world.step(40);
            if (keeps) plugin.fetch(cloth);
            hash = hashOfAll(cloth, hash);
            world.remove(cloth);
            world.step();
        }
        return hash;
    };
    EXPECT_EQ(runWith(false), runWith(true));
}

// The box is far away when the step begins. The cloth gets its nodes when Bullet's own algorithm reads them.
TEST_P(KeptBodyTest, ABoxThatAppearsInAStepBringsClothToTheHost)
{
    btBoxShape box(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1)));
    btRigidBody* body = nullptr;
    Scene scene = {clothOf(17), nullptr, nullptr};
    scene.m_add = [&](DropWorld& world, btSoftBody&)
    { body = &world.addKinematic(box, btTransform(btQuaternion::getIdentity(), btVector3(5, 0, 0))); };
    scene.m_beforeStep = [&](btRigidBody&, btSoftBody&, int step)
    {
        const btVector3 place = step < 30 ? btVector3(5, 0, 0) : btVector3(0, btScalar(0.42), 0);
        body->setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
    };
    EXPECT_GT(expectSame(scene), kSteps / 4);
}

// Bullet's prediction reads normals then.
TEST_P(KeptBodyTest, DragThatBeginsActsAsAtHome)
{
    Scene scene = {clothOf(17), nullptr, nullptr};
    scene.m_beforeStep = [](btRigidBody&, btSoftBody& cloth, int step)
    { cloth.m_cfg.kDG = btScalar(step == 30 ? 0.1 : 0); };
    EXPECT_GT(expectSame(scene), kSteps / 4);
}

// Bullet solves the cloth from then on. The flag has no contacts.
TEST_P(KeptBodyTest, ALinkToAnotherBodyBringsClothToTheHost)
{
    for (const btScalar height : {btScalar(0.45), btScalar(5)})
    {
        btSoftBody* other = nullptr;
        Scene scene = {clothOf(17), nullptr, nullptr};
        scene.m_cloth.m_centre.setY(height);
        scene.m_add = [&](DropWorld& world, btSoftBody& cloth)
        {
            cloth.setMass(0, 0);
            ClothSpec spec = clothOf(9);
            spec.m_centre.setX(3);
            other = &world.addCloth(spec);
        };
        scene.m_beforeStep = [&](btRigidBody&, btSoftBody& cloth, int step)
        {
            if (step == 30) cloth.appendLink(&cloth.m_nodes[3], &other->m_nodes[2], cloth.m_materials[0]);
        };
        EXPECT_GT(expectSame(scene), kSteps / 4);
    }
}

// Jumps are no motion, so that a mesh between start and end counts as a start that intersects.
TEST_P(KeptBodyTest, PinsJumpAsAtHome)
{
    Scene scene = {clothOf(17), nullptr, nullptr};
    scene.m_add = [](DropWorld&, btSoftBody& cloth) { cloth.setMass(144, 0); };
    scene.m_beforeStep = [](btRigidBody&, btSoftBody& cloth, int step)
    {
        if (step == 30) cloth.m_nodes[144].m_x -= btVector3(0, btScalar(0.2), 0);
    };
    EXPECT_GT(expectSame(scene), kSteps / 4);
}

TEST_P(KeptBodyTest, ForcesOnClothOnTheDeviceDoNotCount)
{
    Scene scene = {clothOf(17), nullptr, nullptr};
    scene.m_add = [](DropWorld&, btSoftBody& cloth) { cloth.setMass(0, 0); };
    const auto withForce = [](btScalar force)
    {
        return [force](btRigidBody&, btSoftBody& cloth, int step)
        {
            if (step >= 20 && step < 40) cloth.addForce(btVector3(0, force, 0));
            if (step == 40) cloth.m_nodes[0].m_x += btVector3(0, btScalar(0.01), 0);
        };
    };
    scene.m_beforeStep = withForce(0);
    const Outcome without = run(scene, GetParam().m_settings, true);
    scene.m_beforeStep = withForce(1);
    EXPECT_EQ(run(scene, GetParam().m_settings, true).m_hash, without.m_hash);
}

// A cloth that is kept beside the sphere, after some steps.
struct KeptCloth : SphereWorld
{
    explicit KeptCloth(const Settings& settings) : SphereWorld(settings, true), m_cloth(m_world->addCloth(clothOf(17)))
    {
        EXPECT_EQ(m_plugin->keepOnDevice(m_cloth, true), "");
        m_world->step(40);
    }
    std::vector<float> positions()
    {
        std::vector<float> result(3 * std::size_t(m_cloth.m_nodes.size()));
        EXPECT_TRUE(m_plugin->fetch(m_cloth, {result.data(), nullptr, nullptr}));
        return result;
    }

    btSoftBody& m_cloth;
};

TEST_P(KeptBodyTest, ReleasedClothHasTheLastNodesAfterAnEarlierBeginFetch)
{
    KeptCloth kept(GetParam().m_settings);
    kept.m_plugin->beginFetch(kept.m_cloth);
    kept.m_world->step(5);
    const std::vector<float> begun = kept.positions();
    const std::vector<float> last = kept.positions();
    EXPECT_NE(begun, last);
    kept.m_plugin->beginFetch(kept.m_cloth);
    kept.m_world->step();
    kept.m_plugin->keepOnDevice(kept.m_cloth, false);
    EXPECT_NE(positionsOf(kept.m_cloth), last);
}

// The memory that nodes are read to grows meanwhile.
TEST_P(KeptBodyTest, ABegunFetchEndsAfterAnotherClothIsKept)
{
    KeptCloth kept(GetParam().m_settings);
    const std::vector<float> now = kept.positions();
    ClothSpec spec = clothOf(40);
    spec.m_centre.setX(5);
    btSoftBody& other = kept.m_world->addCloth(spec);
    kept.m_plugin->beginFetch(kept.m_cloth);
    EXPECT_EQ(kept.m_plugin->keepOnDevice(other, true), "");
    EXPECT_EQ(kept.positions(), now);
}

// The world goes on without the plugin.
TEST_P(KeptBodyTest, ClothGetsItsNodesOnceThePluginIsDestroyed)
{
    KeptCloth kept(GetParam().m_settings);
    const std::vector<float> before = positionsOf(kept.m_cloth);
    kept.m_plugin.reset();
    kept.m_world->step();
    const std::vector<float> first = positionsOf(kept.m_cloth);
    EXPECT_NE(first, before);
    kept.m_world->step();
    EXPECT_NE(positionsOf(kept.m_cloth), first);
}

// The check of intersections looks at where the cloth is.
TEST_P(KeptBodyTest, ADiagnosisLooksAtTheNodesOfNow)
{
    KeptCloth kept(GetParam().m_settings);
    const std::vector<float> now = kept.positions();
    kept.m_plugin->diagnose(kept.m_world->world());
    EXPECT_EQ(positionsOf(kept.m_cloth), now);
}

// Returns the reason that a plugin with the settings gives for the cloth of a world of its own.
std::string whyNotKept(const Settings& settings, const std::function<void(btSoftBody&)>& change = nullptr)
{
    Plugin plugin(settings);
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(clothOf(9));
    world.step();
    if (change) change(cloth);
    return plugin.keepOnDevice(cloth, true);
}

TEST_P(KeptBodyTest, TheReasonNamesWhatKeepsTheNodesWithBullet)
{
    Settings settings = GetParam().m_settings;
    settings.m_solverPlace = SolverPlace::Device;
    const std::pair<const char*, std::function<void(btSoftBody&)>> cases[] = {
        {"kPR", [](btSoftBody& cloth) { cloth.m_cfg.kPR = 1; }},
        {"kLF", [](btSoftBody& cloth) { cloth.m_cfg.kLF = 1; }},
        {"kVC", [](btSoftBody& cloth) { cloth.m_cfg.kVC = 1; }},
        {"VF_SS", [](btSoftBody& cloth) { cloth.m_cfg.collisions |= btSoftBody::fCollision::VF_SS; }},
        {"setPose", [](btSoftBody& cloth) { cloth.setPose(false, true); }},
        {"faces", [](btSoftBody& cloth) { cloth.initializeFaceTree(); }},
        {"viterations", [](btSoftBody& cloth) { cloth.m_cfg.viterations = 1; }}};
    EXPECT_EQ(whyNotKept(settings), "");
    for (const auto& [word, change] : cases)
        EXPECT_NE(whyNotKept(settings, change).find(word), std::string::npos) << word;
    EXPECT_NE(whyNotKept(hostSettings()).find("m_solverPlace"), std::string::npos);
    settings.m_solver = Solver::Bullet;
    EXPECT_NE(whyNotKept(settings).find("m_solver "), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Devices, KeptBodyTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace
}  // namespace drape::test
