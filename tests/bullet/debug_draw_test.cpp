// Tests the lines that debugDraw() draws, and the profile zones of a step.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <drape/debug_draw.h>

#include "LinearMath/btIDebugDraw.h"
#include "LinearMath/btQuickprof.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"

namespace drape::test
{
namespace
{
struct DrawnLine
{
    btVector3 m_from, m_to, m_colour;
};

class RecordingDrawer : public btIDebugDraw
{
public:
    using btIDebugDraw::drawLine;
    void drawLine(const btVector3& from, const btVector3& to, const btVector3& colour) override
    {
        m_lines.push_back({from, to, colour});
    }
    void drawContactPoint(const btVector3&, const btVector3&, btScalar, int, const btVector3&) override {}
    void reportErrorWarning(const char*) override {}
    void draw3dText(const btVector3&, const char*) override {}
    void setDebugMode(int) override {}
    int getDebugMode() const override { return 0; }

    std::vector<DrawnLine> m_lines;
};

std::vector<DrawnLine> linesOf(const Plugin& plugin, unsigned flags, const DebugDrawOptions& options = {})
{
    RecordingDrawer drawer;
    debugDraw(plugin, drawer, flags, options);
    return drawer.m_lines;
}

// A cloth that rests on the flat top of a box of 0.5 m.
class DebugDraw : public testing::Test
{
protected:
    DebugDraw() : m_ground(makeBox(4, 0.5f, 4)), m_plugin(hostSettings()), m_world(&m_plugin)
    {
        ClothSpec spec;
        spec.m_centre = btVector3(0, btScalar(0.3), 0);
        m_cloth = &m_world.addCloth(spec);
        m_world.addObstacle(m_ground.shape());
        m_world.step(60);
    }

    MeshShape m_ground;
    Plugin m_plugin;
    DropWorld m_world;
    btSoftBody* m_cloth;
};
}  // namespace

TEST_F(DebugDraw, ShowsACrossAndANormalForEachContact)
{
    const std::size_t contacts = m_plugin.contacts().size();
    ASSERT_GT(contacts, 0u);
    EXPECT_EQ(linesOf(m_plugin, kDrawContacts).size(), 3 * contacts);
    DebugDrawOptions options;
    options.m_normalScale = 5;
    const std::vector<DrawnLine> normals = linesOf(m_plugin, kDrawNormals, options);
    EXPECT_EQ(normals.size(), contacts);
    for (const DrawnLine& line : normals)
    {
        EXPECT_NEAR(line.m_from.y(), 0.25, 1e-4);
        EXPECT_NEAR((line.m_to - line.m_from).y(), 5 * kThickness, 1e-5);
        EXPECT_EQ(line.m_colour, btVector3(1, btScalar(0.9), btScalar(0.1))) << "a contact at rest is yellow";
    }
    EXPECT_TRUE(linesOf(m_plugin, 0).empty());
}

TEST_F(DebugDraw, ShowsTheGapFromTheObstacleToTheCloth)
{
    const std::vector<DrawnLine> gaps = linesOf(m_plugin, kDrawGaps);
    EXPECT_EQ(gaps.size(), m_plugin.contacts().size());
    for (const DrawnLine& line : gaps)
        EXPECT_NEAR((line.m_to - line.m_from).length(), kThickness, 0.02 * kThickness);
    m_cloth->translate(btVector3(0, btScalar(-0.005), 0));
    for (const DrawnLine& line : linesOf(m_plugin, kDrawGaps))
        EXPECT_EQ(line.m_colour, btVector3(1, btScalar(0.15), btScalar(0.1))) << "a contact too close is red";
}

TEST_F(DebugDraw, ShowsImpulsesIfTheyAreRecorded)
{
    EXPECT_TRUE(linesOf(m_plugin, kDrawNormals | kDrawImpulses).empty());
    m_plugin.recordContacts(true);
    m_world.step();
    const std::vector<StepContact>& contacts = m_plugin.stepContacts();
    const auto pushed = [](const StepContact& contact) { return contact.m_normalImpulse > 0; };
    const std::vector<DrawnLine> lines = linesOf(m_plugin, kDrawImpulses);
    EXPECT_EQ(lines.size(), std::size_t(std::count_if(contacts.begin(), contacts.end(), pushed)));
    btScalar longest = 0;
    for (const DrawnLine& line : lines)
        longest = std::max(longest, (line.m_to - line.m_from).length());
    EXPECT_NEAR(longest, DebugDrawOptions().m_normalScale * kThickness, 1e-5);
}

TEST(DebugDrawPatches, AreThoseBelowTheCloth)
{
    Plugin plugin(hostSettings());
    MeshShape ground(makeTerrain(8, 0.05f, 64, 1));
    DropWorld world(&plugin);
    ClothSpec spec;
    spec.m_centre = btVector3(1, btScalar(0.2), 1);
    world.addCloth(spec);
    const btVector3 shift(btScalar(0.5), 0, 0);
    world.addKinematic(ground.shape(), btTransform(btQuaternion::getIdentity(), shift));
    world.step(40);
    const std::vector<DrawnLine> lines = linesOf(plugin, kDrawPatches);
    ASSERT_GT(lines.size(), 3u * 2 * 64);           // triangles below a cloth of 1 x 1 m
    EXPECT_LT(lines.size(), 3u * 2 * 64 * 64 / 4);  // a quarter of all
    for (const DrawnLine& line : lines)
    {
        EXPECT_NEAR(line.m_from.x(), 1, 2);
        EXPECT_NEAR(line.m_from.z(), 1, 2);
        EXPECT_NEAR(line.m_from.y(), 0, 0.2);
    }
}

TEST(DebugDrawFlagged, ShowsBothTriangles)
{
    Settings settings = hostSettings();
    settings.m_log = nullptr;
    Plugin plugin(settings);
    MeshShape ground(makeTerrain(4, 0.0f, 8, 1));
    DropWorld world(&plugin);
    world.addObstacle(ground.shape());
    btSoftBody& cloth = world.addCloth(ClothSpec());
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        cloth.m_nodes[i].m_x.setY(cloth.m_nodes[i].m_x.x() > 0 ? btScalar(0.05) : btScalar(-0.05));
    world.step();
    const std::size_t pairs = plugin.flaggedPairs().size();
    ASSERT_GT(pairs, 0u);
    const std::vector<DrawnLine> lines = linesOf(plugin, kDrawFlagged);
    EXPECT_EQ(lines.size(), 6 * pairs);
    for (const DrawnLine& line : lines)
        EXPECT_EQ(line.m_colour, btVector3(1, 0, 1));
}

TEST(DebugDrawWithoutDrape, DrawsNothing)
{
    Settings settings = hostSettings();
    settings.m_log = nullptr;
    settings.m_activation = -1;  // out of range
    const Plugin plugin(settings);
    ASSERT_FALSE(plugin.ready());
    EXPECT_TRUE(linesOf(plugin, kDrawEverything).empty());
}

namespace
{
struct Zones
{
    std::map<std::string, int> m_entered;
    std::vector<std::string> m_open;
    bool m_leavesTooOften = false;
};

Zones& zones()
{
    static Zones all;
    return all;
}

void enterZone(const char* name)
{
    ++zones().m_entered[name];
    zones().m_open.emplace_back(name);
}

void leaveZone()
{
    zones().m_leavesTooOften = zones().m_leavesTooOften || zones().m_open.empty();
    if (!zones().m_open.empty()) zones().m_open.pop_back();
}
}  // namespace

TEST(ProfileZones, AppearInEachStepAndBalance)
{
    Plugin plugin(hostSettings());
    MeshShape ground(makeBox(4, 0.5f, 4));
    DropWorld world(&plugin);
    world.addCloth(ClothSpec());
    world.addObstacle(ground.shape());
    plugin.setContactListener([](const StepContacts&) {});
    zones() = Zones();
    btEnterProfileZoneFunc* const enter = btGetCurrentEnterProfileZoneFunc();
    btLeaveProfileZoneFunc* const leave = btGetCurrentLeaveProfileZoneFunc();
    btSetCustomEnterProfileZoneFunc(enterZone);
    btSetCustomLeaveProfileZoneFunc(leaveZone);
    world.step(4);
    btSetCustomEnterProfileZoneFunc(enter);
    btSetCustomLeaveProfileZoneFunc(leave);
    EXPECT_TRUE(zones().m_open.empty());
    EXPECT_FALSE(zones().m_leavesTooOften);
    for (const char* name : {"Drape predictMotion", "Drape solveConstraints", "Drape mirrors", "Drape detection",
                             "Drape solver", "Drape check", "Drape listener", "Drape normals"})
        EXPECT_EQ(zones().m_entered[name], 4) << name;
}
}  // namespace drape::test
