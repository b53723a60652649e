// Lines of Settings::m_log about a world's setup and its steps, each told once, and those of Plugin::diagnose().
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "BulletCollision/CollisionDispatch/btGhostObject.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"

namespace drape::test
{
namespace
{
class LogTest : public testing::Test
{
protected:
    LogTest()
    {
        m_settings.m_backend = Backend::Host;
        m_settings.m_log = [this](const char* line) { m_lines.push_back(line); };
    }

    std::size_t countOf(const std::string& part) const
    {
        return std::size_t(std::count_if(m_lines.begin(), m_lines.end(),
                                         [&](const std::string& line)
                                         { return line.find(part) != std::string::npos; }));
    }

    // Drops two cloths onto a ball.
    void drop(DropWorld& world, float margin = kMargin)
    {
        world.addObstacle(m_ball.shape());
        for (const float height : {0.55f, 0.65f})
        {
            ClothSpec spec;
            spec.m_centre = btVector3(0, btScalar(height), 0);
            world.addCloth(spec).getCollisionShape()->setMargin(btScalar(margin));
        }
        world.step(10);
    }

    // Steps a cloth with Bullet's default margin. size, height: m.
    static void stepThick(DropWorld& world, int nodes, float size, float height)
    {
        ClothSpec spec;
        spec.m_nodes = nodes;
        spec.m_size = size;
        spec.m_centre = btVector3(0, btScalar(height), 0);
        world.addCloth(spec).getCollisionShape()->setMargin(btScalar(0.25));
        world.step(3);
    }

    // Steps a cloth that lies on a box, which `move` puts elsewhere before each step: 15 mm higher each time if it puts
    // it at the height that it is given, m.
    template <class Move>
    void lift(Plugin& plugin, DropWorld& world, const Move& move)
    {
        ClothSpec spec;
        spec.m_centre = btVector3(0, btScalar(0.12), 0);
        world.addCloth(spec);
        world.step(30);
        for (int step = 1; step <= 20; ++step)
        {
            move(btTransform(btQuaternion::getIdentity(), btVector3(0, btScalar(0.015 * step), 0)), step);
            world.world().updateAabbs();
            world.step();
        }
        m_diagnosis = plugin.diagnose(world.world());
    }

    std::vector<std::string> m_lines;
    std::string m_diagnosis;
    Settings m_settings;
    btBoxShape m_box{btVector3(1, btScalar(0.1), 1)};
    MeshShape m_ball{makeSphere(0.5f, 3)};
};
}  // namespace

TEST_F(LogTest, SaysNothingOfAGoodWorld)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    drop(world);
    EXPECT_FALSE(plugin.contacts().empty());
    EXPECT_TRUE(m_lines.empty()) << m_lines[0];
}

TEST_F(LogTest, NamesExceptionsOfTheAppsFunctionsOnce)
{
    m_settings.m_threads = 4;
    m_settings.m_parallelFor = [](std::size_t, const std::function<void(std::size_t)>&)
    { throw std::runtime_error("no workers"); };
    Plugin plugin(m_settings);
    plugin.setContactListener([](const StepContacts&) { throw std::runtime_error("an app's mistake"); });
    DropWorld world(&plugin);
    ClothSpec large;
    large.m_nodes = 65;
    large.m_centre = btVector3(5, 1, 0);
    world.addCloth(large);
    drop(world);
    EXPECT_EQ(m_lines.size(), 2u);
    EXPECT_EQ(countOf("contact listener threw an exception"), 1u);
    EXPECT_EQ(countOf("m_parallelFor threw an exception"), 1u);
}

TEST_F(LogTest, NamesAWorldWithoutTheCollisionConfigurationOnce)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin, Wiring::SolverOnly);
    drop(world);
    EXPECT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(countOf("dispatcher does not have this plugin's algorithm"), 1u);
}

TEST_F(LogTest, NamesAWorldWithoutTheSolverOnce)
{
    Plugin plugin(m_settings);
    DropWorld world(nullptr);
    ASSERT_TRUE(install(plugin, world.dispatcher(), world.world()));
    drop(world);
    EXPECT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(countOf("solver is not a drape::SoftBodySolver"), 1u);
    uninstall(plugin, world.dispatcher(), world.world());
}

TEST_F(LogTest, NamesADeviceThatIsMissing)
{
    m_settings.m_backend = Backend::Auto;
    m_settings.m_device = "no device has this name";
    const Plugin plugin(m_settings);
    EXPECT_FALSE(plugin.ready());
    EXPECT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(countOf(m_settings.m_device), 1u);
}

TEST_F(LogTest, NamesAThicknessOutOfProportionToTheEdges)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    drop(world, 0.3f);
    EXPECT_EQ(countOf("times the mean edge"), 2u) << "a line for each cloth";
}

TEST_F(LogTest, NamesBulletsDefaultMargin)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    btTriangleMesh triangles;
    triangles.addTriangle(btVector3(-5, 0, -5), btVector3(0, 0, 5), btVector3(5, 0, -5));
    btBvhTriangleMeshShape ground(&triangles, true);
    ground.setMargin(btScalar(0.01));
    world.addObstacle(ground);
    stepThick(world, 33, 2, 0.2f);
    EXPECT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(countOf("times the mean edge of the cloth"), 1u);
    EXPECT_NE(plugin.diagnose(world.world()).find("times the mean edge of the cloth"), std::string::npos);
}

TEST_F(LogTest, NamesAThicknessOutOfProportionToTheMesh)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    MeshShape fine(makeSphere(0.5f, 5));
    world.addObstacle(fine.shape());
    stepThick(world, 5, 1, 0.7f);
    EXPECT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(countOf("times the mean edge of the mesh"), 1u);
}

TEST_F(LogTest, NamesClothThatStartsThroughClothOnce)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    btSoftBody &flat = world.addCloth(ClothSpec()), &tilted = world.addCloth(ClothSpec());
    tilted.rotate(btQuaternion(btVector3(0, 0, 1), btScalar(0.3)));
    plugin.setSelfCollision(flat, true);
    plugin.setSelfCollision(tilted, true);
    world.step(5);
    ASSERT_TRUE(plugin.statistics().m_status & kStepClothsMeet);
    EXPECT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(countOf("pairs of triangles intersect"), 1u);
    EXPECT_NE(plugin.diagnose(world.world()).find("pairs of triangles intersect"), std::string::npos);
}

// A remark that applies to several is there once, also if the app has one name for them.
TEST_F(LogTest, LinesHaveTheAppsNames)
{
    m_settings.m_nameOf = [](const btCollisionObject& object) {
        return btSoftBody::upcast(&object) ? "sheet " + std::to_string(object.getUserIndex())
                                           : std::string("the\nball");
    };
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    drop(world, 0.3f);
    ASSERT_EQ(m_lines.size(), 2u);
    for (const std::string& line : m_lines)
        EXPECT_EQ(line.rfind("sheet -1 and the ball: the thickness", 0), 0u) << line;
    const std::string text = plugin.diagnose(world.world());
    EXPECT_EQ(text.rfind("sheet -1 and the ball (and 1 more pair): the thickness", 0), 0u) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 0) << text;
}

TEST_F(LogTest, LinesHaveAddressesWhereTheAppHasNoName)
{
    int calls = 0;
    m_settings.m_nameOf = [&calls](const btCollisionObject&) -> std::string
    {
        if (++calls % 2 == 0) throw std::runtime_error("no name");
        return "";
    };
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    drop(world, 0.3f);
    EXPECT_EQ(calls, 4);
    ASSERT_EQ(m_lines.size(), 2u);
    EXPECT_EQ(m_lines[0].rfind("soft body 0x", 0), 0u) << m_lines[0];
    EXPECT_NE(m_lines[0].find(" and object 0x"), std::string::npos) << m_lines[0];
}

TEST_F(LogTest, NamesAnotherWorldAtTheAddressOfAGoodOne)
{
    Plugin plugin(m_settings);
    std::optional<DropWorld> world;
    for (const Wiring wiring : {Wiring::Configuration, Wiring::SolverOnly, Wiring::SolverOnly})
    {
        world.reset();
        world.emplace(&plugin, wiring);
        drop(*world);
    }
    EXPECT_EQ(m_lines.size(), 2u);
    EXPECT_EQ(countOf("dispatcher does not have this plugin's algorithm"), 2u);
}

TEST_F(LogTest, NamesEachWorldWithoutTheSolverAtOneAddress)
{
    Plugin plugin(m_settings);
    for (int i = 0; i < 2; ++i)
    {
        CollisionConfiguration configuration(plugin);
        btCollisionDispatcher dispatcher(&configuration);
        btDbvtBroadphase broadphase;
        btSequentialImpulseConstraintSolver rigidSolver;
        btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &rigidSolver, &configuration);
        btCollisionObject ball;
        ball.setCollisionShape(&m_ball.shape());
        world.addCollisionObject(&ball);
        ClothSpec spec;
        spec.m_centre = btVector3(0, btScalar(0.55), 0);
        const std::unique_ptr<btSoftBody> cloth = makeCloth(world.getWorldInfo(), spec);
        world.addSoftBody(cloth.get());
        world.stepSimulation(kDt, 0);
        world.removeSoftBody(cloth.get());
        world.removeCollisionObject(&ball);
    }
    EXPECT_EQ(m_lines.size(), 2u);
    EXPECT_EQ(countOf("solver is not a drape::SoftBodySolver"), 2u);
}

// Both transforms of a kinematic body are set, which is a teleport, too.
TEST_F(LogTest, NamesAnObjectThatIsPutElsewhereInEveryStep)
{
    for (const bool isKinematic : {false, true})
    {
        SCOPED_TRACE(isKinematic);
        m_lines.clear();
        Plugin plugin(m_settings);
        DropWorld world(&plugin);
        btCollisionObject& object = isKinematic ? world.addKinematic(m_box) : world.addObstacle(m_box);
        const auto move = [&](const btTransform& pose, int)
        {
            object.setWorldTransform(pose);
            object.setInterpolationWorldTransform(pose);
        };
        lift(plugin, world, move);
        EXPECT_EQ(countOf("its pose changes beside cloth in step after step"), 1u);
        EXPECT_NE(m_diagnosis.find("in step after step"), std::string::npos) << m_diagnosis;
    }
}

TEST_F(LogTest, NamesAKinematicGhostThatMovesInEveryStep)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    btPairCachingGhostObject ghost;
    ghost.setCollisionShape(&m_box);
    ghost.setWorldTransform(btTransform::getIdentity());
    ghost.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    world.world().addCollisionObject(&ghost);
    lift(plugin, world, [&](const btTransform& pose, int) { ghost.setWorldTransform(pose); });
    EXPECT_EQ(countOf("its pose changes beside cloth in step after step"), 1u);
    world.world().removeCollisionObject(&ghost);
}

TEST_F(LogTest, SaysNothingOfMotionOrOfSingleTeleports)
{
    Plugin plugin(m_settings);
    {
        DropWorld world(&plugin);
        btRigidBody& body = world.addKinematic(m_box);
        lift(plugin, world, [&](const btTransform& pose, int) { body.setWorldTransform(pose); });
        EXPECT_EQ(m_diagnosis, "");
    }
    {
        DropWorld world(&plugin);
        btCollisionObject& object = world.addObstacle(m_box);
        const auto sink = [&](const btTransform& pose, int step)
        {
            if (step % 10 == 0) object.setWorldTransform(pose.inverse());
        };
        lift(plugin, world, sink);
    }
    EXPECT_EQ(countOf("in step after step"), 0u);
}

TEST_F(LogTest, NamesNodesThatAreNotFiniteOnce)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    world.addObstacle(m_ball.shape());
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(0.55), 0);
    btSoftBody& cloth = world.addCloth(spec);
    world.step();
    cloth.m_nodes[5].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
    world.step(5);
    ASSERT_TRUE(plugin.statistics().m_status & kStepInvalidNodes);
    EXPECT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(countOf("nodes that are not finite or beyond 2^30 m are left out of collision, 1 of"), 1u);
}

TEST_F(LogTest, DiagnoseNamesBodiesWhoseLinksBulletSolves)
{
    if (sizeof(btScalar) != sizeof(float)) GTEST_SKIP() << "Bullet solves all links in double precision";
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(ClothSpec());
    EXPECT_EQ(plugin.diagnose(world.world()), "");
    cloth.m_cfg.diterations = 1;
    EXPECT_NE(plugin.diagnose(world.world()).find("drift iterations"), std::string::npos);
    cloth.m_cfg.diterations = 0;
    cloth.m_cfg.piterations = 0;
    EXPECT_NE(plugin.diagnose(world.world()).find("no position iterations"), std::string::npos);

    m_settings.m_solver = Solver::Bullet;
    Plugin leaves(m_settings);
    DropWorld other(&leaves);
    other.addCloth(ClothSpec());
    EXPECT_EQ(leaves.diagnose(other.world()), "") << "as the settings ask for";
}

TEST_F(LogTest, NamesAThicknessOfClothWithClothThatCannotBeMeant)
{
    Plugin plugin(m_settings);
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(ClothSpec());
    plugin.setSelfCollision(cloth, true, -3);
    EXPECT_EQ(m_lines.size(), 1u);
    EXPECT_EQ(countOf("is -3 m; twice the margin is used"), 1u);
    world.step(2);
    EXPECT_EQ(m_lines.size(), 1u);
    plugin.setSelfCollision(cloth, true, 50);
    world.step(2);
    EXPECT_EQ(m_lines.size(), 2u);
    EXPECT_EQ(countOf("times its mean edge"), 1u);
}

TEST_F(LogTest, NamesCallsWithoutEffectOnAShape)
{
    Plugin plugin(m_settings);
    btCompoundShape compound;
    btTriangleMesh triangles;
    triangles.addTriangle(btVector3(-5, 0, -5), btVector3(0, 0, 5), btVector3(5, 0, -5));
    btBvhTriangleMeshShape mesh(&triangles, true);
    btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
    const TriangleFilter none = [](int, int) { return false; };
    plugin.setTriangleFilter(&mesh, none);
    plugin.setTriangleFilter(&m_box, nullptr);
    plugin.setOneSided(&plane, true);
    plugin.setOneSided(&m_box, true);
    plugin.setOneSided(&compound, false);
    EXPECT_TRUE(m_lines.empty()) << m_lines[0];
    plugin.setTriangleFilter(&m_box, none);
    plugin.setTriangleFilter(&plane, none);
    plugin.setTriangleFilter(&compound, none);
    plugin.setOneSided(&compound, true);
    EXPECT_EQ(m_lines.size(), 4u);
    EXPECT_EQ(countOf("setTriangleFilter() has no effect"), 3u);
    EXPECT_EQ(countOf("setOneSided() has no effect"), 1u);
}

// The second thread calls while the first is in a step, which waits in the log for it.
TEST_F(LogTest, NamesTwoThreadsInOnePlugin)
{
    Plugin* used = nullptr;
    m_settings.m_log = [&](const char* line)
    {
        m_lines.push_back(line);
        if (m_lines.size() == 1)
            std::thread([&] { used->prepare(static_cast<const btCollisionObject*>(nullptr)); }).join();
    };
    Plugin plugin(m_settings);
    used = &plugin;
    DropWorld world(&plugin, Wiring::SolverOnly);
    drop(world);
    ASSERT_EQ(m_lines.size(), 2u);
    EXPECT_EQ(countOf("two threads"), 1u);
    EXPECT_NE(m_lines[1].find("two threads"), std::string::npos) << m_lines[1];
}
}  // namespace drape::test
