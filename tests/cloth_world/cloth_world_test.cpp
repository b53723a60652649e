// ClothWorld: the bits of a world that is built by hand, and what its functions promise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "BulletSoftBody/btSoftBody.h"
#include <drape/cloth_world.h>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/cloth_world/hand_built_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr double kDt = 1.0 / 60;  // s
constexpr double kUpright[4] = {0, 0, 0, 1};

Settings onHost()
{
    Settings settings;
    settings.m_backend = Backend::Host;
    return settings;
}

ClothDescription describeCloth(const TriangleMesh& mesh)
{
    ClothDescription cloth = defaultCloth();
    cloth.m_positions = mesh.m_positions.data();
    cloth.m_vertexCount = mesh.vertexCount();
    cloth.m_triangles = mesh.m_triangles.data();
    cloth.m_triangleCount = mesh.triangleCount();
    return cloth;
}

ObstacleDescription describeObstacle(const TriangleMesh& mesh)
{
    ObstacleDescription obstacle = defaultObstacle();
    obstacle.m_positions = mesh.m_positions.data();
    obstacle.m_vertexCount = mesh.vertexCount();
    obstacle.m_triangles = mesh.m_triangles.data();
    obstacle.m_triangleCount = mesh.triangleCount();
    return obstacle;
}

class ClothWorldTest : public testing::Test
{
protected:
    void SetUp() override
    {
        Error error;
        m_world = ClothWorld::create(onHost(), error);
        ASSERT_TRUE(m_world) << error.text();
    }

    void steps(int count)
    {
        for (int i = 0; i < count; ++i)
            ASSERT_TRUE(m_world->step(kDt)) << m_world->error().text();
    }
    int add(const ClothDescription& cloth)
    {
        const int index = m_world->addCloth(cloth);
        EXPECT_GE(index, 0) << m_world->error().text();
        return index;
    }
    int add(const ObstacleDescription& obstacle)
    {
        const int index = m_world->addObstacle(obstacle);
        EXPECT_GE(index, 0) << m_world->error().text();
        return index;
    }
    std::vector<float> positions(int cloth)
    {
        NodeView view = {};
        EXPECT_TRUE(m_world->nodes(cloth, view)) << m_world->error().text();
        std::vector<float> found(3 * view.m_count);
        NodeArrays arrays;
        arrays.m_positions = found.data();
        EXPECT_TRUE(m_world->copyNodes(cloth, arrays));
        return found;
    }
    double meanHeight(int cloth)
    {
        const std::vector<float> all = positions(cloth);
        double sum = 0;
        for (std::size_t i = 1; i < all.size(); i += 3)
            sum += double(all[i]);
        return sum / (double(all.size()) / 3);
    }
    void expectRefused(bool good, const std::string& text)
    {
        EXPECT_FALSE(good);
        EXPECT_EQ(m_world->error().m_call.rfind(text, 0), 0u) << m_world->error().text();
        EXPECT_EQ(m_world->error().m_kind, ErrorKind::Input);
    }

    std::unique_ptr<ClothWorld> m_world;
    TriangleMesh m_sheet = makeClothGrid(9, 9, 0.8f, 0.3f).m_mesh;
    TriangleMesh m_plate = makeTerrain(3, 0, 4, 1);
};

TEST_F(ClothWorldTest, LinesHaveIndicesOfItsBodiesAndTheAppsNamesOfOthers)
{
    Settings settings = onHost();
    std::vector<std::string> lines;
    settings.m_log = [&](const char* line) { lines.push_back(line); };
    settings.m_nameOf = [](const btCollisionObject&) { return "the app's box"; };
    Error error;
    m_world = ClothWorld::create(settings, error);
    ASSERT_TRUE(m_world) << error.text();
    ClothDescription cloth = describeCloth(m_sheet);
    cloth.m_thickness = 0.6;
    add(cloth);
    add(describeObstacle(m_plate));
    btBoxShape shape(btVector3(1, 1, 1));
    btRigidBody box(0, nullptr, &shape);
    m_world->world().addRigidBody(&box);
    steps(1);
    std::sort(lines.begin(), lines.end());
    ASSERT_EQ(lines.size(), 2u) << testing::PrintToString(lines);
    EXPECT_EQ(lines[0].rfind("cloth 0 and obstacle 0: the thickness", 0), 0u) << lines[0];
    EXPECT_EQ(lines[1].rfind("cloth 0 and the app's box: the thickness", 0), 0u) << lines[1];
    m_world->world().removeRigidBody(&box);
}

class ClothWorldOnBackends : public BackendTest
{
};
}  // namespace

TEST_P(ClothWorldOnBackends, StepsAreThoseOfAWorldBuiltByHand)
{
    const TriangleMesh sheet = makeClothGrid(13, 13, 1, 0.45f).m_mesh, ball = makeSphere(0.4f, 3);
    const std::int32_t pin = 5;
    HandBuiltWorld byHand(GetParam().m_settings, sheet, ball, pin);
    Error error;
    const std::unique_ptr<ClothWorld> world = ClothWorld::create(GetParam().m_settings, error);
    ASSERT_TRUE(world) << error.text();
    ClothDescription cloth = describeCloth(sheet);
    cloth.m_mass = 1.5;
    cloth.m_thickness = 0.024;
    cloth.m_stiffness = 0.9;
    cloth.m_bendingStiffness = 0.1;
    cloth.m_friction = 0.4;
    cloth.m_damping = 0.03;
    cloth.m_iterations = 4;
    cloth.m_pins = &pin;
    cloth.m_pinCount = 1;
    ASSERT_EQ(world->addCloth(cloth), 0) << world->error().text();
    ASSERT_EQ(world->addObstacle(describeObstacle(ball)), 0) << world->error().text();
    const double centre[3] = {0, 0, 0};
    std::size_t contacts = 0;
    for (int step = 1; step <= 60; ++step)
    {
        byHand.step();
        ASSERT_TRUE(world->setPose(0, centre, HandBuiltWorld::rotationAfter(step).data())) << world->error().text();
        ASSERT_TRUE(world->step(kDt)) << world->error().text();
        NodeView view = {};
        ASSERT_TRUE(world->nodes(0, view));
        ASSERT_EQ(view.m_count, sheet.vertexCount());
        for (std::size_t i = 0; i < view.m_count; ++i)
        {
            const btSoftBody::Node& node = byHand.cloth().m_nodes[int(i)];
            const auto* const at = static_cast<const char*>(view.m_positions) + i * view.m_strideBytes;
            const auto* const speed = static_cast<const char*>(view.m_velocities) + i * view.m_strideBytes;
            ASSERT_EQ(std::memcmp(at, node.m_x.m_floats, 3 * view.m_scalarBytes), 0) << "step " << step;
            ASSERT_EQ(std::memcmp(speed, node.m_v.m_floats, 3 * view.m_scalarBytes), 0) << "step " << step;
        }
        contacts += world->plugin().statistics().m_contacts;
        EXPECT_EQ(world->plugin().statistics().m_contacts, byHand.plugin().statistics().m_contacts);
    }
    EXPECT_GT(contacts, 1000u);
}

INSTANTIATE_TEST_SUITE_P(Backend, ClothWorldOnBackends, testing::ValuesIn(allBackends()), backendName);

TEST_F(ClothWorldTest, ClothRestsAtHalfItsThicknessAndTheMargin)
{
    ClothDescription cloth = describeCloth(m_sheet);
    cloth.m_thickness = 0.04;
    ObstacleDescription plate = describeObstacle(m_plate);
    plate.m_margin = 0.03;
    const int own = add(cloth), below = add(plate);
    steps(90);
    EXPECT_NEAR(meanHeight(own), 0.05, 0.05 / 16);
    std::vector<ClothContact> contacts;
    ASSERT_TRUE(m_world->contacts(contacts));
    ASSERT_FALSE(contacts.empty());
    for (const ClothContact& contact : contacts)
    {
        EXPECT_EQ(contact.m_cloth, own);
        EXPECT_EQ(contact.m_obstacle, below);
        EXPECT_NEAR(contact.m_thickness, 0.05f, 1e-6f);
        EXPECT_NEAR(contact.m_normal[1], 1, 1e-4f);
    }
    EXPECT_EQ(m_world->diagnose(), "");
    ASSERT_TRUE(m_world->removeObstacle(below));
    steps(30);
    EXPECT_LT(meanHeight(own), -0.5);
}

// Queries after a step must not touch bodies that have been removed since.
TEST_F(ClothWorldTest, ContactsOfWhatWasRemovedAreLeftOut)
{
    const int first = add(describeCloth(m_sheet)), below = add(describeObstacle(m_plate));
    m_world->plugin().recordContacts(true);
    steps(90);
    std::vector<ClothStepContact> records;
    std::vector<ClothContact> contacts;
    ASSERT_TRUE(m_world->stepContacts(records) && m_world->contacts(contacts));
    ASSERT_FALSE(records.empty() || contacts.empty());
    ASSERT_TRUE(m_world->removeCloth(first));
    add(describeCloth(m_sheet));  // perhaps at the same address
    ASSERT_TRUE(m_world->stepContacts(records) && m_world->contacts(contacts));
    EXPECT_TRUE(records.empty() && contacts.empty());
    steps(90);
    ASSERT_TRUE(m_world->stepContacts(records));
    ASSERT_FALSE(records.empty());
    ASSERT_TRUE(m_world->removeObstacle(below));
    ASSERT_TRUE(m_world->stepContacts(records) && m_world->contacts(contacts));
    EXPECT_TRUE(records.empty() && contacts.empty());
}

TEST_F(ClothWorldTest, RecordedImpulsesCarryTheCloth)
{
    ClothDescription cloth = describeCloth(m_sheet);
    cloth.m_mass = 2;
    const int own = add(cloth), below = add(describeObstacle(m_plate));
    steps(90);
    std::vector<ClothStepContact> contacts;
    ASSERT_TRUE(m_world->stepContacts(contacts));
    EXPECT_TRUE(contacts.empty());
    m_world->plugin().recordContacts(true);
    steps(1);
    ASSERT_TRUE(m_world->stepContacts(contacts));
    double held = 0;
    for (const ClothStepContact& contact : contacts)
    {
        EXPECT_EQ(contact.m_cloth, own);
        EXPECT_EQ(contact.m_obstacle, below);
        EXPECT_EQ(contact.m_other, -1);
        EXPECT_GE(contact.m_triangle, 0);
        EXPECT_LT(std::size_t(contact.m_triangle), m_plate.triangleCount());
        held += double(contact.m_impulse[1]);
    }
    EXPECT_NEAR(held, 2 * 9.81 / 60, 0.01);
}

TEST_F(ClothWorldTest, PinnedNodesStayOrGoWhereTheyAreMoved)
{
    const std::int32_t pins[] = {0, 8};
    ClothDescription cloth = describeCloth(m_sheet);
    cloth.m_pins = pins;
    cloth.m_pinCount = 2;
    const int own = add(cloth);
    steps(60);
    EXPECT_EQ(positions(own)[1], 0.3f);
    EXPECT_LT(meanHeight(own), 0.2);
    for (int step = 1; step <= 120; ++step)
    {
        const float height = 0.3f + 0.01f * float(step);
        const float moved[] = {-0.4f, height, -0.4f, 0.4f, height, -0.4f};
        ASSERT_TRUE(m_world->setPositions(own, pins, 2, moved)) << m_world->error().text();
        steps(1);
    }
    EXPECT_EQ(positions(own)[1], 1.5f);
    EXPECT_GT(meanHeight(own), 0.9);
    const float velocity[] = {0, 1, 0, 0, 1, 0};
    expectRefused(m_world->setVelocities(own, pins, 2, velocity), "setVelocities: node 0 is pinned");
    ASSERT_TRUE(m_world->setPinned(own, pins, 2, false));
    EXPECT_TRUE(m_world->setVelocities(own, pins, 2, velocity));
    EXPECT_EQ(m_world->body(own)->getMass(0), m_world->body(own)->getMass(40));
    steps(60);
    EXPECT_LT(meanHeight(own), -0.5);
}

TEST_F(ClothWorldTest, PinningKeepsTheLengthsAtRest)
{
    const std::int32_t pin = 40, other = 3;
    ClothDescription cloth = describeCloth(m_sheet);
    cloth.m_pins = &pin;
    cloth.m_pinCount = 1;
    cloth.m_stiffness = 0.05;
    const int own = add(cloth);
    const btSoftBody& body = *m_world->body(own);
    const auto lengths = [&]
    {
        std::vector<btScalar> found;
        for (int i = 0; i < body.m_links.size(); ++i)
            found.push_back(body.m_links[i].m_rl);
        return found;
    };
    const std::vector<btScalar> atRest = lengths();
    steps(30);
    ASSERT_TRUE(m_world->setPinned(own, &other, 1, true));
    steps(1);
    EXPECT_EQ(lengths(), atRest);
}

TEST_F(ClothWorldTest, MassesAreThoseGiven)
{
    std::vector<float> masses(m_sheet.vertexCount(), 0.5f);
    masses[3] = 2;
    ClothDescription cloth = describeCloth(m_sheet);
    cloth.m_masses = masses.data();
    const int own = add(cloth);
    EXPECT_EQ(m_world->body(own)->getMass(3), 2);
    EXPECT_EQ(m_world->body(own)->getMass(4), btScalar(0.5));
}

// A plate lifts its cloth, whether by its pose or by its vertices; a teleport does not carry it.
TEST_F(ClothWorldTest, ObstaclesCarryClothUnlessTheyTeleport)
{
    for (const bool byVertices : {false, true})
        for (const bool teleport : {false, true})
        {
            SetUp();
            const int own = add(describeCloth(m_sheet)), plate = add(describeObstacle(m_plate));
            steps(60);
            const double before = meanHeight(own);
            for (int step = 1; step <= (teleport ? 1 : 20); ++step)
            {
                const double height = teleport ? -10 : 0.05 * step;
                const double position[3] = {0, height, 0};
                TriangleMesh moved = m_plate;
                for (std::size_t i = 1; i < moved.m_positions.size(); i += 3)
                    moved.m_positions[i] += float(height);
                const bool good =
                    byVertices ? m_world->setVertices(plate, moved.m_positions.data(), moved.vertexCount(), teleport)
                               : m_world->setPose(plate, position, kUpright, teleport);
                ASSERT_TRUE(good) << m_world->error().text();
                steps(1);
                EXPECT_EQ(m_world->plugin().statistics().m_status, kStepGood) << m_world->plugin().report();
            }
            if (teleport)
                EXPECT_NEAR(meanHeight(own), before, 0.02);
            else
                EXPECT_GT(meanHeight(own), 1);
        }
}

TEST_F(ClothWorldTest, TrianglesThatAreLeftOutLetClothThrough)
{
    for (const bool leavesOut : {false, true})
    {
        SetUp();
        const int own = add(describeCloth(m_sheet)), plate = add(describeObstacle(m_plate));
        std::vector<std::int32_t> all(m_plate.triangleCount());
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] = std::int32_t(i);
        ASSERT_TRUE(m_world->leaveOutTriangles(plate, all.data(), all.size())) << m_world->error().text();
        const std::size_t count = leavesOut ? all.size() : 0;
        ASSERT_TRUE(m_world->leaveOutTriangles(plate, all.data(), count)) << m_world->error().text();
        steps(60);
        EXPECT_EQ(meanHeight(own) < -1, leavesOut) << meanHeight(own);
    }
}

TEST_F(ClothWorldTest, LayersStayApartOnRequest)
{
    for (const bool apart : {true, false})
    {
        SetUp();
        ClothDescription cloth = describeCloth(m_sheet);
        cloth.m_selfCollision = apart;
        TriangleMesh higher = m_sheet;
        for (std::size_t i = 1; i < higher.m_positions.size(); i += 3)
            higher.m_positions[i] += 0.1f;
        const int lower = add(cloth);
        cloth.m_positions = higher.m_positions.data();
        const int upper = add(cloth);
        add(describeObstacle(m_plate));
        steps(120);
        std::vector<ClothTriangles> meeting;
        ASSERT_TRUE(m_world->clothTriangles(meeting));
        EXPECT_TRUE(meeting.empty());
        EXPECT_NEAR(meanHeight(lower), 0.02, 0.004);
        EXPECT_NEAR(meanHeight(upper), apart ? 0.04 : 0.02, 0.004);
    }
}

// Two sheets that cross at the start.
TEST_F(ClothWorldTest, ListsClothThatStartsIntersecting)
{
    ClothDescription cloth = describeCloth(m_sheet);
    cloth.m_selfCollision = 1;
    TriangleMesh upright = m_sheet;
    for (std::size_t i = 0; i < upright.m_positions.size(); i += 3)
    {
        upright.m_positions[i + 1] += upright.m_positions[i];
        upright.m_positions[i] = 0.013f;
    }
    const int first = add(cloth);
    cloth.m_positions = upright.m_positions.data();
    const int second = add(cloth);
    steps(1);
    std::vector<ClothTriangles> meeting;
    ASSERT_TRUE(m_world->clothTriangles(meeting));
    ASSERT_FALSE(meeting.empty());
    EXPECT_NE(m_world->plugin().statistics().m_status & kStepClothsMeet, 0u);
    for (const ClothTriangles& pair : meeting)
        EXPECT_EQ(std::minmax(pair.m_cloths[0], pair.m_cloths[1]), std::minmax(first, second));
}

TEST_F(ClothWorldTest, RestPositionsGiveLinksTheirLengths)
{
    TriangleMesh rest = m_sheet;
    for (float& value : rest.m_positions)
        value *= 0.5f;
    ClothDescription cloth = describeCloth(m_sheet);
    cloth.m_restPositions = rest.m_positions.data();
    const double noGravity[3] = {0, 0, 0};
    ASSERT_TRUE(m_world->setGravity(noGravity));
    const int own = add(cloth);
    EXPECT_EQ(positions(own), m_sheet.m_positions);
    steps(120);
    const std::vector<float> end = positions(own);
    EXPECT_NEAR(std::hypot(end[3] - end[0], end[4] - end[1], end[5] - end[2]), 0.05, 0.005);
}

TEST_F(ClothWorldTest, RopesHangFromTheirPin)
{
    const std::vector<float> along = {0, 0, 0, 0.1f, 0, 0, 0.2f, 0, 0, 0.3f, 0, 0};
    const std::int32_t edges[] = {0, 1, 1, 2, 2, 3}, pin = 0;
    ClothDescription rope = defaultCloth();
    rope.m_positions = along.data();
    rope.m_vertexCount = 4;
    rope.m_edges = edges;
    rope.m_edgeCount = 3;
    rope.m_pins = &pin;
    rope.m_pinCount = 1;
    rope.m_damping = 0.2;
    const int own = add(rope);
    steps(240);
    const std::vector<float> end = positions(own);
    EXPECT_NEAR(end[10], -0.3f, 0.02f);
}

TEST_F(ClothWorldTest, ClothComesOutThroughTheBackOfAOneSidedMesh)
{
    for (const int oneSided : {0, 1})
    {
        SetUp();
        TriangleMesh flipped = m_plate;
        for (std::size_t t = 0; t < flipped.m_triangles.size(); t += 3)
            std::swap(flipped.m_triangles[t], flipped.m_triangles[t + 1]);
        ObstacleDescription plate = describeObstacle(flipped);
        plate.m_oneSided = oneSided;
        add(plate);
        const int own = add(describeCloth(m_sheet));
        steps(60);
        EXPECT_EQ(meanHeight(own) < -0.1, oneSided == 1);
    }
}

TEST_F(ClothWorldTest, ViewsKeepTheirPlaceAndTheBodyMayOutliveTheWorld)
{
    const int own = add(describeCloth(m_sheet));
    NodeView before = {}, after = {};
    ASSERT_TRUE(m_world->nodes(own, before));
    steps(3);
    ASSERT_TRUE(m_world->nodes(own, after));
    EXPECT_EQ(before.m_positions, after.m_positions);
    const std::vector<float> last = positions(own);
    const std::shared_ptr<btSoftBody> body = m_world->body(own);
    EXPECT_EQ(m_world->body(7), nullptr);
    m_world.reset();
    btScalar height = 0;
    std::memcpy(&height, static_cast<const char*>(after.m_positions) + sizeof(btScalar), sizeof(btScalar));
    EXPECT_EQ(float(height), last[1]);
}

TEST_F(ClothWorldTest, RemovedIndicesAreUnknownAndNotUsedAgain)
{
    const int first = add(describeCloth(m_sheet));
    const int plate = add(describeObstacle(m_plate));
    steps(2);
    ASSERT_TRUE(m_world->removeCloth(first));
    ASSERT_TRUE(m_world->removeObstacle(plate));
    EXPECT_EQ(m_world->body(first), nullptr);
    NodeView view = {};
    expectRefused(m_world->nodes(first, view), "nodes: there is no cloth 0");
    expectRefused(m_world->removeCloth(first), "removeCloth: there is no cloth 0");
    expectRefused(m_world->removeObstacle(plate), "removeObstacle: there is no obstacle 0");
    const double position[3] = {0, 0, 0};
    expectRefused(m_world->setPose(-1, position, kUpright), "setPose: there is no obstacle -1");
    EXPECT_EQ(add(describeCloth(m_sheet)), first + 1);
    EXPECT_EQ(add(describeObstacle(m_plate)), plate + 1);
    steps(2);
}

TEST_F(ClothWorldTest, BadClothIsRefused)
{
    const auto refused = [&](const std::string& text, const auto& change)
    {
        ClothDescription cloth = describeCloth(m_sheet);
        change(cloth);
        expectRefused(m_world->addCloth(cloth) >= 0, "addCloth: " + text);
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refused("a cloth has one vertex", [](ClothDescription& c) { c.m_vertexCount = 0; });
    refused("the mesh: a mesh without one of its arrays", [](ClothDescription& c) { c.m_positions = nullptr; });
    refused("the mesh: a mesh with an index out of range", [](ClothDescription& c) { c.m_vertexCount = 3; });
    for (const double bad : {0.0, -1.0, nan})
    {
        refused("mass", [&](ClothDescription& c) { c.m_mass = bad; });
        refused("thickness", [&](ClothDescription& c) { c.m_thickness = bad; });
        refused("stiffness", [&](ClothDescription& c) { c.m_stiffness = bad; });
    }
    for (const double bad : {-0.1, 1.1, nan})
    {
        refused("bendingStiffness", [&](ClothDescription& c) { c.m_bendingStiffness = bad; });
        refused("friction", [&](ClothDescription& c) { c.m_friction = bad; });
        refused("damping", [&](ClothDescription& c) { c.m_damping = bad; });
    }
    refused("iterations", [](ClothDescription& c) { c.m_iterations = 0; });
    const std::int32_t pin = 81;
    refused("pins: there is no node 81 among 81",
            [&](ClothDescription& c)
            {
                c.m_pins = &pin;
                c.m_pinCount = 1;
            });
    std::vector<float> bad = m_sheet.m_positions;
    bad[4] = std::numeric_limits<float>::infinity();
    refused("positions: value 4 is not finite", [&](ClothDescription& c) { c.m_positions = bad.data(); });
    refused("restPositions: value 4", [&](ClothDescription& c) { c.m_restPositions = bad.data(); });
    EXPECT_EQ(add(describeCloth(m_sheet)), 0);
}

TEST_F(ClothWorldTest, BadObstaclesAndArgumentsAreRefused)
{
    ObstacleDescription obstacle = describeObstacle(m_plate);
    obstacle.m_triangleCount = 0;
    expectRefused(m_world->addObstacle(obstacle) >= 0, "addObstacle: an obstacle has one triangle");
    obstacle = describeObstacle(m_plate);
    obstacle.m_margin = -1;
    expectRefused(m_world->addObstacle(obstacle) >= 0, "addObstacle: margin");
    obstacle = describeObstacle(m_plate);
    obstacle.m_rotation[3] = 0;
    expectRefused(m_world->addObstacle(obstacle) >= 0, "addObstacle: rotation");
    const int own = add(describeCloth(m_sheet)), plate = add(describeObstacle(m_plate));
    EXPECT_EQ(plate, 0);
    for (const double bad : {0.0, -kDt, std::numeric_limits<double>::quiet_NaN()})
        expectRefused(m_world->step(bad), "step: dt");
    expectRefused(m_world->setGravity(nullptr), "setGravity: gravity: the array is missing");
    expectRefused(m_world->setVertices(plate, m_plate.m_positions.data(), 3), "setVertices: the obstacle has another");
    const std::int32_t triangle = std::int32_t(m_plate.triangleCount());
    expectRefused(m_world->leaveOutTriangles(plate, &triangle, 1),
                  "leaveOutTriangles: triangles: there is no triangle");
    const std::int32_t node = -1;
    expectRefused(m_world->setPinned(own, &node, 1, true), "setPinned: nodes: there is no node -1");
    expectRefused(m_world->setPositions(own, nullptr, 1, nullptr), "setPositions: nodes: the array is missing");
    Settings settings = onHost();
    settings.m_threads = 65;
    Error error;
    EXPECT_FALSE(ClothWorld::create(settings, error));
    EXPECT_EQ(error.m_kind, ErrorKind::Input) << error.text();
    settings = onHost();
    settings.m_backend = Backend::OpenCl;
    settings.m_device = "there is no such device";
    EXPECT_FALSE(ClothWorld::create(settings, error));
    EXPECT_EQ(error.m_kind, ErrorKind::Environment) << error.text();
}
}  // namespace drape::test
