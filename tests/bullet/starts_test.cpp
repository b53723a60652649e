// Cloth that begins a step with its triangles through a mesh. The report names it at once. It comes out of closed
// meshes without being thrown, and is guarded again from then on. Invalid margins are reported, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "BulletCollision/CollisionShapes/btBox2dShape.h"
#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
// Returns the settings with a log that a test can read.
Settings logged(Settings settings, std::vector<std::string>& lines)
{
    settings.m_log = [&lines](const char* line) { lines.push_back(line); };
    return settings;
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

ClothSpec clothAt(float height, int nodes = 25)
{
    ClothSpec spec;
    spec.m_nodes = nodes;
    spec.m_centre = btVector3(0, btScalar(height), 0);
    return spec;
}

double fastestOf(const btSoftBody& cloth)
{
    double speed = 0;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        speed = std::max(speed, double(cloth.m_nodes[i].m_v.length()));
    return speed;
}

// A cloth beside a mesh, and the messages about them.
class StartScene
{
public:
    StartScene(const Settings& settings, const TriangleMesh& mesh, const ClothSpec& spec, bool kinematic = false)
        : m_mesh(mesh),
          m_plugin(logged(settings, m_lines)),
          m_shape(mesh),
          m_world(&m_plugin),
          m_obstacle(kinematic ? m_world.addKinematic(m_shape.shape()) : m_world.addObstacle(m_shape.shape())),
          m_cloth(m_world.addCloth(spec)),
          m_meter(mesh, meshOf(m_cloth))
    {
    }

    StepMeasure step()
    {
        m_world.step();
        m_fastest = std::max(m_fastest, fastestOf(m_cloth));
        return m_meter.measure(positionsOf(m_cloth).data());
    }
    const StepStatistics& statistics() const { return m_plugin.statistics(); }
    bool isTold() const { return (statistics().m_status & kStepStartsIntersecting) != 0; }

    // Expects a message in the next step, and no intersection after `steps` steps.
    void expectToComeOut(int steps)
    {
        const StepMeasure first = step();
        EXPECT_TRUE(isTold());
        EXPECT_EQ(statistics().m_startsIntersecting, 1u);
        EXPECT_GT(statistics().m_startIntersections, 0u);
        ASSERT_EQ(m_lines.size(), 1u);
        EXPECT_TRUE(contains(m_lines[0], std::to_string(statistics().m_startIntersections) + " pairs")) << m_lines[0];
        int needed = 1;
        for (StepMeasure measure = first; measure.m_intersectingPairs + measure.nodesBelow() > 0; ++needed)
        {
            ASSERT_LT(needed, steps) << measure.m_intersectingPairs << " pairs, " << measure.nodesBelow() << " nodes";
            measure = step();
        }
        for (int i = 0; i < 120; ++i)
        {
            const StepMeasure measure = step();
            ASSERT_EQ(measure.m_intersectingPairs, 0u) << "step " << i;
            ASSERT_EQ(measure.nodesBelow(), 0u) << "step " << i;
            ASSERT_EQ(statistics().m_status, kStepGood) << "step " << i;
        }
        EXPECT_LT(m_fastest, 6);
        EXPECT_EQ(m_lines.size(), 1u);
    }

    TriangleMesh m_mesh;
    std::vector<std::string> m_lines;
    Plugin m_plugin;
    MeshShape m_shape;
    DropWorld m_world;
    btCollisionObject& m_obstacle;
    btSoftBody& m_cloth;
    PenetrationMeter m_meter;
    double m_fastest = 0;  // m/s
};

btTransform turnedAndMoved(btScalar angle, const btVector3& shift)
{
    return btTransform(btQuaternion(btVector3(0, 0, 1), angle), shift);
}

class Starts : public BackendTest
{
};
}  // namespace

TEST_P(Starts, ClothTranslatedIntoASphereIsToldAtOnceAndComesOut)
{
    for (const float depth : {0.25f, 0.55f})
    {
        StartScene scene(GetParam().m_settings, makeSphere(0.5f, 3), clothAt(0.7f));
        for (int i = 0; i < 40; ++i)
        {
            scene.step();
            ASSERT_EQ(scene.statistics().m_status, kStepGood);
        }
        scene.m_cloth.translate(btVector3(btScalar(0.03), -depth, btScalar(0.02)));
        scene.expectToComeOut(60);
    }
}

TEST_P(Starts, ClothAddedInsideOfAMovingBodyComesOut)
{
    StartScene scene(GetParam().m_settings, makeBox(0.6f, 0.6f, 0.6f), clothAt(0.2f), true);
    scene.m_cloth.transform(turnedAndMoved(btScalar(0.3), btVector3(btScalar(0.1), 0, btScalar(0.03))));
    scene.expectToComeOut(120);
}

TEST_P(Starts, ClothOnEitherSideOfSomethingThinIsDrawnToOne)
{
    StartScene scene(GetParam().m_settings, makeBox(3, 0.02f, 3), clothAt(0));
    scene.m_cloth.transform(turnedAndMoved(btScalar(0.1), btVector3(0, 0, 0)));
    scene.expectToComeOut(240);
}

TEST_P(Starts, ClothThatIsLinkedWithARingIsMovedOff)
{
    StartScene scene(GetParam().m_settings, makeTorus(0.4f, 0.12f, 32, 16), clothAt(0.05f));
    scene.m_cloth.transform(turnedAndMoved(btScalar(0.4), btVector3(0, 0, 0)));
    scene.expectToComeOut(300);
}

TEST_P(Starts, WindingDoesNotDecideWhichSideIsOut)
{
    TriangleMesh mesh = makeSphere(0.5f, 3);
    for (std::size_t t = 0; t < mesh.triangleCount(); t += 2)
        std::swap(mesh.m_triangles[3 * t], mesh.m_triangles[3 * t + 1]);
    StartScene scene(GetParam().m_settings, mesh, clothAt(0.35f));
    // The meter uses the winding number; the test reads only Drape's report.
    scene.m_world.step();
    EXPECT_TRUE(scene.isTold());
    for (int i = 0; i < 60; ++i)
        scene.m_world.step();
    EXPECT_EQ(scene.statistics().m_status, kStepGood);
    for (int i = 0; i < scene.m_cloth.m_nodes.size(); ++i)
        ASSERT_GT(scene.m_cloth.m_nodes[i].m_x.length(), btScalar(0.49));
}

TEST_P(Starts, ClothInAnOpenMeshIsToldAsLongAsItIntersects)
{
    StartScene scene(GetParam().m_settings, makeTerrain(4, 0, 16, 1), clothAt(0));
    scene.m_cloth.transform(turnedAndMoved(btScalar(0.5), btVector3(0, 0, 0)));
    for (int i = 0; i < 30; ++i)
    {
        const StepMeasure measure = scene.step();
        if (measure.m_intersectingPairs == 0) break;
        ASSERT_TRUE(scene.isTold()) << "step " << i;
    }
    EXPECT_TRUE(scene.isTold());
    ASSERT_EQ(scene.m_lines.size(), 1u);
    EXPECT_TRUE(contains(scene.m_lines[0], "open")) << scene.m_lines[0];
}

TEST_P(Starts, AnObstacleThatIsPutIntoClothIsTold)
{
    StartScene scene(GetParam().m_settings, makeBox(0.5f, 0.5f, 0.5f), clothAt(0.8f));
    for (int i = 0; i < 5; ++i)
        scene.step();
    EXPECT_EQ(scene.statistics().m_status, kStepGood);
    const btScalar height = scene.m_cloth.m_nodes[0].m_x.y();
    scene.m_obstacle.setWorldTransform(btTransform(btMatrix3x3::getIdentity(), btVector3(0, height, 0)));
    scene.m_world.step();
    EXPECT_TRUE(scene.isTold());
    for (int i = 0; i < 120; ++i)
        scene.m_world.step();
    EXPECT_FALSE(scene.isTold());
}

INSTANTIATE_TEST_SUITE_P(Backends, Starts, testing::ValuesIn(allBackends()), backendName);

TEST(StartsOnHost, ANodeThatIsPutIntoAMeshIsToldAndTheOthersStayGuarded)
{
    StartScene scene(hostSettings(), makeBox(2, 0.4f, 2), clothAt(0.3f));
    for (int i = 0; i < 60; ++i)
        scene.step();
    EXPECT_EQ(scene.statistics().m_status, kStepGood);
    scene.m_cloth.m_nodes[0].m_x -= btVector3(0, btScalar(0.1), 0);
    scene.expectToComeOut(60);
}

TEST(StartsOnHost, ARoomKeepsTheClothThatReachesThroughItsWall)
{
    TriangleMesh room = makeBox(2, 2, 2);
    for (std::size_t t = 0; t < room.triangleCount(); ++t)
        std::swap(room.m_triangles[3 * t], room.m_triangles[3 * t + 1]);
    StartScene scene(hostSettings(), room, clothAt(0));
    scene.m_cloth.translate(btVector3(btScalar(0.6), 0, 0));
    for (int i = 0; i < 120; ++i)
        scene.m_world.step();
    EXPECT_EQ(scene.statistics().m_status, kStepGood);
    for (int i = 0; i < scene.m_cloth.m_nodes.size(); ++i)
        ASSERT_LT(scene.m_cloth.m_nodes[i].m_x.x(), btScalar(1));
}

TEST(StartsOnHost, NodesThatAreNoNumbersAreToldUntilTheyAreMended)
{
    StartScene scene(hostSettings(), makeSphere(0.5f, 3), clothAt(0.7f));
    for (int i = 0; i < 30; ++i)
        scene.step();
    const std::vector<float> good = positionsOf(scene.m_cloth);
    const btScalar none = std::numeric_limits<btScalar>::quiet_NaN();
    scene.m_cloth.m_nodes[5].m_x.setValue(none, none, none);
    for (int i = 0; i < 20; ++i)
    {
        scene.m_world.step();
        ASSERT_TRUE(scene.statistics().m_status & kStepInvalidNodes) << "step " << i;
    }
    EXPECT_TRUE(contains(scene.m_plugin.diagnose(scene.m_world.world()), "not finite"));
    scene.m_cloth.setVelocity(btVector3(0, 0, 0));
    for (int i = 0; i < scene.m_cloth.m_nodes.size(); ++i)
    {
        const std::size_t at = 3 * std::size_t(i);
        btSoftBody::Node& node = scene.m_cloth.m_nodes[i];
        node.m_x.setValue(good[at], good[at + 1] - btScalar(0.2), good[at + 2]);
        node.m_q = node.m_x;
        node.m_v.setZero();
        node.m_f.setZero();
    }
    scene.m_cloth.updateBounds();
    scene.m_cloth.forceActivationState(ACTIVE_TAG);
    scene.m_world.step();
    EXPECT_TRUE(scene.isTold());
}

TEST(StartsOnHost, ClothThatWasLeftOutIsToldWhileItIsNotGuarded)
{
    Settings settings = hostSettings();
    settings.m_candidateLimit = 20;
    StartScene scene(settings, makeSphere(0.5f, 3), clothAt(0.52f));
    bool leftOut = false, told = false;
    for (int i = 0; i < 30; ++i)
    {
        const StepMeasure measure = scene.step();
        const std::uint32_t status = scene.statistics().m_status;
        leftOut = leftOut || (status & kStepClothsLeftOut);
        told = told || (status & kStepStartsIntersecting);
        if (measure.m_intersectingPairs > 0)
        {
            ASSERT_NE(status, kStepGood) << "step " << i;
        }
    }
    EXPECT_TRUE(leftOut);
    EXPECT_TRUE(told);
}

TEST(StartsOnHost, NegativeMarginsCountAsNoneAndAreTold)
{
    for (const bool ofCloth : {true, false})
    {
        StartScene scene(hostSettings(), makeSphere(0.5f, 3), clothAt(0.6f));
        if (ofCloth)
            scene.m_cloth.getCollisionShape()->setMargin(-1);
        else
            scene.m_shape.shape().setMargin(-1);
        for (int i = 0; i < 60; ++i)
        {
            const StepMeasure measure = scene.step();
            ASSERT_EQ(measure.m_intersectingPairs, 0u) << "step " << i;
            ASSERT_EQ(measure.nodesBelow(), 0u) << "step " << i;
        }
        ASSERT_EQ(scene.m_lines.size(), 1u) << ofCloth;
        EXPECT_TRUE(contains(scene.m_lines[0], "negative")) << scene.m_lines[0];
        EXPECT_TRUE(contains(scene.m_plugin.diagnose(scene.m_world.world()), "negative"));
    }
}

TEST(StartsOnHost, AMarginAsLargeAsTheMeshIsTold)
{
    StartScene scene(hostSettings(), makeBox(0.2f, 0.2f, 0.2f), clothAt(0.5f));
    scene.m_cloth.getCollisionShape()->setMargin(btScalar(0.25));
    scene.m_world.step(5);
    ASSERT_GE(scene.m_lines.size(), 1u);
    EXPECT_TRUE(contains(scene.m_lines[0], "as large as the mesh")) << scene.m_lines[0];
}

TEST(StartsOnHost, NothingIsToldWithoutALogAndWhatALogThrowsIsDropped)
{
    Settings settings = hostSettings();
    settings.m_log = nullptr;
    for (int i = 0; i < 2; ++i)
    {
        Plugin plugin(settings);
        MeshShape shape(makeSphere(0.5f, 3));
        DropWorld world(&plugin);
        world.addObstacle(shape.shape());
        world.addCloth(clothAt(0.3f));
        testing::internal::CaptureStderr();
        EXPECT_NO_THROW(world.step(3));
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        EXPECT_TRUE(plugin.ready());
        EXPECT_TRUE(plugin.statistics().m_status & kStepStartsIntersecting);
        settings.m_log = [](const char*) { throw 1; };
    }
}

TEST(StartsOnHost, DiagnoseNamesWhatIsWrongAndNothingElse)
{
    StartScene good(hostSettings(), makeSphere(0.5f, 3), clothAt(0.8f));
    EXPECT_EQ(good.m_plugin.diagnose(good.m_world.world()), "");
    good.m_world.step(60);
    EXPECT_EQ(good.m_plugin.diagnose(good.m_world.world()), "");

    StartScene intersecting(hostSettings(), makeSphere(0.5f, 3), clothAt(0.3f));
    EXPECT_TRUE(contains(intersecting.m_plugin.diagnose(intersecting.m_world.world()), "triangles intersect"));

    StartScene inside(hostSettings(), makeBox(3, 3, 3), clothAt(0));
    EXPECT_TRUE(contains(inside.m_plugin.diagnose(inside.m_world.world()), "wholly inside"));

    StartScene thick(hostSettings(), makeSphere(2, 3), clothAt(3, 65));
    thick.m_cloth.getCollisionShape()->setMargin(btScalar(0.25));
    EXPECT_TRUE(contains(thick.m_plugin.diagnose(thick.m_world.world()), "times the mean edge"));
}

TEST(StartsOnHost, DiagnoseNamesWhatIsLeftToBulletAndWhy)
{
    Plugin plugin(hostSettings());
    MeshShape shape(makeSphere(0.5f, 3));
    DropWorld stock(nullptr);
    stock.addObstacle(shape.shape());
    stock.addCloth(clothAt(0.8f));
    const std::string text = plugin.diagnose(stock.world());
    EXPECT_TRUE(contains(text, "dispatcher")) << text;
    EXPECT_TRUE(contains(text, "soft body solver")) << text;

    DropWorld world(&plugin);
    btBox2dShape box(btVector3(1, 1, 1));
    world.addObstacle(box, btTransform(btMatrix3x3::getIdentity(), btVector3(0, -3, 0)));
    world.addCloth(clothAt(0.8f));
    EXPECT_TRUE(contains(plugin.diagnose(world.world()), "not a triangle mesh"));
}
// A kinematic box presses a sheet through the upper side of a floor, and then exactly onto the lower one from within.
// No contact can tell on which side of a surface cloth belongs that lies on it.
TEST(StartsOnHost, ClothThatLeavesASurfaceToTheWrongSideIsTold)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    std::unique_ptr<btSoftBody> sheet(btSoftBodyHelpers::CreatePatch(
        world.world().getWorldInfo(), btVector3(-0.210968524f, 0.0146800736f, -0.298804462f),
        btVector3(0.289031476f, 0.0186560079f, -0.224657997f), btVector3(-0.29993251f, 0.0113439923f, 0.201195538f),
        btVector3(0.20006749f, 0.0153199257f, 0.275341988f), 7, 7, 0, true));
    sheet->getCollisionShape()->setMargin(0.005f);
    sheet->m_cfg.piterations = 5;
    sheet->m_cfg.kDP = 0.01f;
    sheet->setTotalMass(0.05f);
    world.world().addSoftBody(sheet.get());
    btBoxShape floor(btVector3(0.6f, 0.1f, 0.6f)), box(btVector3(0.12f, 0.08f, 0.1f));
    floor.setMargin(0.005f);
    box.setMargin(0.005f);
    btTransform place(btQuaternion::getIdentity(), btVector3(0, -0.11f, 0));
    world.addObstacle(floor, place);
    const TriangleMesh mesh = placed(makeBox(1.2f, 0.2f, 1.2f), place);
    place.setRotation(btQuaternion(0.0393681079f, 0.0118104331f, 0.00787362177f, 0.999123991f));
    place.setOrigin(btVector3(0.01f, 0.165f, 0.02f));
    btRigidBody& press = world.addKinematic(box, place);
    PenetrationMeter meter(mesh, meshOf(*sheet));
    std::size_t leaving = 0, untold = 0;
    for (int step = 0; step < 80; ++step)
    {
        if (step >= 3 && step < 60) place.setOrigin(place.getOrigin() - btVector3(0, 0.3f / 60, 0));
        press.setWorldTransform(place);
        world.step();
        const std::size_t pairs = std::size_t(meter.measure(positionsOf(*sheet).data()).m_intersectingPairs);
        const std::uint32_t told = kStepSurfacePassed | kStepStartsIntersecting;
        untold += pairs > 0 && (plugin.statistics().m_status & told) == 0;
        leaving += step > 30 && pairs > 0;
    }
    EXPECT_GT(leaving, 1u);
    EXPECT_LE(untold, 1u);  // it ends exactly on the surface
    world.world().removeSoftBody(sheet.get());
}

// The cloth stays near another mesh meanwhile, so that its own record lives on.
TEST(Starts, AnObstacleThatComesBackIsCheckedAgain)
{
    for (const int absent : {2, 6, 40})
    {
        MeshShape floor(makeBox(6, 0.2f, 6)), box(makeBox(0.6f, 0.6f, 0.6f));
        Plugin plugin(hostSettings());
        DropWorld world(&plugin);
        world.addObstacle(floor.shape());
        btCollisionObject& object =
            world.addObstacle(box.shape(), btTransform(btQuaternion::getIdentity(), btVector3(0, 0.4f, 0)));
        btSoftBody& cloth = world.addCloth(clothAt(0.75f, 17));
        world.step(30);
        ASSERT_EQ(plugin.statistics().m_status, std::uint32_t(kStepGood));
        world.world().removeCollisionObject(&object);
        // It falls through the place of the box, and is there when the box comes back.
        world.step(absent);
        while (absent > 2 && lowestOf(cloth) > 0.3f)
            world.step();
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
            if (absent == 2) cloth.m_nodes[i].m_x = cloth.m_nodes[i].m_q = cloth.m_nodes[i].m_x - btVector3(0, 0.3f, 0);
        world.step();
        world.world().addCollisionObject(&object, btBroadphaseProxy::StaticFilter,
                                         btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
        world.step();
        EXPECT_NE(plugin.statistics().m_status & kStepStartsIntersecting, 0u) << absent;
    }
}
}  // namespace drape::test
