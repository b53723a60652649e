// Scenes of cloth with itself, with other cloth and with moving obstacles (scenes/cloth_scene.h), by the exact check.
#include <gtest/gtest.h>

#include <algorithm>
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
        world.step(double(kDt));
        EXPECT_EQ(plugin.statistics().m_status, 0u) << step << ": " << statusText(plugin.statistics().m_status);
        if (step % kStepsPerCheck != 0) continue;
        EXPECT_EQ(check.find(world.positions()).size(), 0u) << step;
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
    const int node = scene.m_cloths[0].m_held[0];
    const float* const start = scene.m_cloths[0].m_positions.data() + 3 * node;
    const Vector3 held = scene.m_heldAt(0, {start[0], start[1], start[2]}, world.time());
    EXPECT_EQ(float(world.cloth(0).m_nodes[node].m_x.x()), float(held.x));
    world.release();
    const btScalar height = world.cloth(0).m_nodes[node].m_x.y();
    for (int step = 0; step < 10; ++step)
        world.step(double(kDt));
    EXPECT_LT(world.cloth(0).m_nodes[node].m_x.y(), height - btScalar(0.02));
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
