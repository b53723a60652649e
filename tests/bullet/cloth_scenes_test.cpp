// Scenes of cloth with itself, with other cloth and with moving obstacles (scenes/cloth_scene.h), by the exact check.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "oracle/self_intersections.h"
#include "tests/bullet/drop_world.h"
#include "tools/scene_world/scene_world.h"

namespace drape::test
{
namespace
{
class ClothScenes : public testing::TestWithParam<std::string>
{
protected:
    static constexpr int kSteps = 16, kStepsPerCheck = 4;
};

constexpr double kSceneStep = 1.0 / 240;  // s

// Returns the angle by which a cloth's one end is turned against the other about x, rad, counted over all turns.
double twistOf(const btSoftBody& body, int columns)
{
    double all = 0, before = 0;
    for (int column = 0; column < columns; ++column)
    {
        const btVector3 across = body.m_nodes[body.m_nodes.size() - columns + column].m_x - body.m_nodes[column].m_x;
        const double angle = std::atan2(double(across.y()), double(across.z()));
        if (column > 0) all += std::remainder(angle - before, 2 * 3.14159265358979);
        before = angle;
    }
    return std::abs(all);
}
}  // namespace

TEST_P(ClothScenes, NoTwoTrianglesMeet)
{
    ClothScene scene;
    ASSERT_TRUE(makeClothScene(GetParam(), ClothSceneSize(), 1, scene));
    Plugin plugin(hostSettings());
    SceneWorld world(scene, plugin);
    SelfIntersections check(world.mesh());
    EXPECT_EQ(check.find(world.positions()).size(), 0u) << "at the start";
    for (int step = 1; step <= kSteps; ++step)
    {
        world.step(kSceneStep);
        EXPECT_EQ(plugin.statistics().m_status, 0u) << step << ": " << statusText(plugin.statistics().m_status);
        if (step % kStepsPerCheck != 0) continue;
        EXPECT_EQ(check.find(world.positions()).size(), 0u) << step;
    }
}

TEST(ClothScene, AnyNumberOfThreadsGivesTheSameBits)
{
    std::vector<std::vector<float>> ends;
    for (const unsigned threads : {1u, 2u, 7u})
    {
        ClothScene scene;
        ASSERT_TRUE(makeClothScene("towel", ClothSceneSize(), 1, scene));
        scene.m_thickness *= 1.5;  // so that all layers touch at once
        Settings settings = hostSettings();
        settings.m_threads = threads;
        Plugin plugin(settings);
        SceneWorld world(scene, plugin);
        for (int step = 0; step < 4; ++step)
            world.step(kSceneStep);
        EXPECT_GT(plugin.statistics().m_selfContacts, 3000u);  // enough for threads to share their rows
        ends.push_back(world.positions());
        EXPECT_EQ(ends.back(), ends.front()) << threads;
    }
}

// Held nodes go where the scene says, and fall once it lets them go.
TEST(ClothScene, HeldNodesGoWithTheScene)
{
    ClothScene scene;
    ASSERT_TRUE(makeClothScene("cape", ClothSceneSize(), 1, scene));
    Plugin plugin(hostSettings());
    SceneWorld world(scene, plugin);
    for (int step = 0; step < 10; ++step)
        world.step(double(kDt));
    const ScenePins& pins = scene.m_cloths[0].m_pins[0];
    const int node = pins.m_nodes[0];
    const float* const start = scene.m_cloths[0].m_positions.data() + 3 * node;
    const Vector3 held = pins.at({start[0], start[1], start[2]}, world.time());
    EXPECT_EQ(float(world.cloth(0).m_nodes[node].m_x.x()), float(held.x));
    world.release();
    const btScalar height = world.cloth(0).m_nodes[node].m_x.y();
    for (int step = 0; step < 10; ++step)
        world.step(double(kDt));
    EXPECT_LT(world.cloth(0).m_nodes[node].m_x.y(), height - btScalar(0.02));
}

TEST(ClothScene, SpringsKeepTheLengthsThatFlatClothHas)
{
    ClothScene scene;
    ASSERT_TRUE(makeClothScene("roll", ClothSceneSize(), 1, scene));
    Plugin plugin(hostSettings());
    SceneWorld world(scene, plugin);
    world.step(kSceneStep);
    const std::vector<float>& rest = scene.m_cloths[0].m_rest.m_mesh.m_positions;
    const btSoftBody& body = world.cloth(0);
    for (int i = 0; i < body.m_links.size(); ++i)
    {
        btVector3 ends[2];
        for (int k = 0; k < 2; ++k)
            for (int axis = 0; axis < 3; ++axis)
                ends[k][axis] = rest[std::size_t(3 * (body.m_links[i].m_n[k] - &body.m_nodes[0]) + axis)];
        ASSERT_NEAR(body.m_links[i].m_rl, (ends[1] - ends[0]).length(), 1e-6) << i;
        ASSERT_NEAR(body.m_links[i].m_c1, body.m_links[i].m_rl * body.m_links[i].m_rl, 1e-6) << i;
    }
}

TEST(ClothScene, ATwistedTowelUntwistsWhenItIsReleased)
{
    ClothScene scene;
    ASSERT_TRUE(makeClothScene("twist", ClothSceneSize(), 1, scene));
    Plugin plugin(hostSettings());
    SceneWorld world(scene, plugin);
    world.world().setGravity(btVector3(0, 0, 0));
    world.world().getWorldInfo().m_gravity.setZero();
    const int columns = world.cloth(0).m_nodes.size() / int(scene.m_cloths[0].m_pins[0].m_nodes.size());
    while (world.time() < 4)
        world.step(kSceneStep);
    const double twisted = twistOf(world.cloth(0), columns);
    EXPECT_GT(twisted, 4);
    world.release();
    while (world.time() < 6)
        world.step(kSceneStep);
    EXPECT_LT(twistOf(world.cloth(0), columns), 0.3 * twisted);
}

TEST(ClothScene, SeedsDisplaceTheStartALittle)
{
    for (const std::string& name : clothSceneNames())
    {
        ClothScene first, again, other;
        ASSERT_TRUE(makeClothScene(name, ClothSceneSize(), 1, first));
        ASSERT_TRUE(makeClothScene(name, ClothSceneSize(), 1, again));
        ASSERT_TRUE(makeClothScene(name, ClothSceneSize(), 2, other));
        float most = 0;
        for (std::size_t i = 0; i < first.m_cloths[0].m_positions.size(); ++i)
            most = std::max(most, std::abs(first.m_cloths[0].m_positions[i] - other.m_cloths[0].m_positions[i]));
        EXPECT_EQ(first.m_cloths[0].m_positions, again.m_cloths[0].m_positions) << name;
        EXPECT_GT(most, 0) << name;
        EXPECT_LT(most, 0.4f * float(first.m_thickness)) << name;
    }
    ClothScene none;
    EXPECT_FALSE(makeClothScene("twists", ClothSceneSize(), 1, none));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ClothScenes, testing::ValuesIn(clothSceneNames()),
                         [](const testing::TestParamInfo<std::string>& test) { return test.param; });
}  // namespace drape::test
