// The state that a pipeline keeps from step to step only saves time: patches and hierarchies of resting obstacles,
// buffers on the device.
#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/cloth_grid.h"
#include "scenes/describe_mesh.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/live_scene.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"

namespace drape::test
{
class SkipsTest : public BackendTest
{
protected:
    std::unique_ptr<Pipeline> make() const { return makePipeline(GetParam().m_settings); }
};

// Returns contacts whose meshes are named by their positions among `ids`, since earlier meshes give features other
// numbers.
std::vector<ContactView> viewsOf(const Pipeline& pipeline, const std::vector<Contact>& contacts,
                                 const std::vector<MeshId>& ids)
{
    const auto place = [&](MeshId id) { return MeshId(std::find(ids.begin(), ids.end(), id) - ids.begin()); };
    std::vector<ContactView> views;
    for (const Contact& contact : contacts)
    {
        views.push_back(pipeline.view(contact));
        views.back().m_cloth = place(views.back().m_cloth);
        views.back().m_obstacle = place(views.back().m_obstacle);
    }
    return views;
}

// One pipeline lives through the steps; the other gets every mesh again in each of them.
TEST_P(SkipsTest, KeptStateGivesTheContactsOfNewState)
{
    std::size_t contacts = 0;
    for (std::uint32_t seed = 980; seed < 983; ++seed)
    {
        const std::unique_ptr<Pipeline> kept = make(), anew = make();
        ASSERT_TRUE(kept && anew);
        std::vector<MeshId> added;
        LiveScene scene({kept.get()}, seed, true);
        for (int step = 0; step < 60; ++step)
        {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
            scene.nextStep();
            scene.giveAnew(*anew, added);
            const std::vector<Contact> first = runStep(*kept), other = runStep(*anew);
            ASSERT_TRUE(sameBytes(viewsOf(*kept, first, scene.ids()), viewsOf(*anew, other, added)))
                << difference(first, other);
            EXPECT_EQ(kept->statistics().m_status, anew->statistics().m_status);
            contacts += first.size();
        }
    }
    EXPECT_GT(contacts, 10000u);
}

TEST_P(SkipsTest, ObstaclesAreCountedAsKeptThatAre)
{
    const std::unique_ptr<Pipeline> pipeline = make();
    ASSERT_TRUE(pipeline);
    const TriangleMesh sphere = makeSphere(0.5f, 2), grid = makeClothGrid(5, 5, 1.0f, 0.505f).m_mesh;
    const MeshId cloth = pipeline->addCloth(describeMesh(grid));
    std::vector<MeshId> obstacles;
    const auto kept = [&]
    {
        for (const MeshId obstacle : obstacles)
            pipeline->addPair(cloth, obstacle, 0.02f);
        EXPECT_FALSE(runStep(*pipeline).empty());
        return pipeline->statistics().m_obstaclesKept;
    };
    for (int i = 0; i < 2; ++i)
        obstacles.push_back(pipeline->addObstacle(describeMesh(sphere)));
    EXPECT_EQ(kept(), 0u);
    EXPECT_EQ(kept(), 2u);
    obstacles.push_back(pipeline->addObstacle(describeMesh(sphere)));
    EXPECT_EQ(kept(), 2u) << "one came";
    EXPECT_EQ(kept(), 3u);
    const float pose[12] = {1, 0, 0, 0.01f, 0, 1, 0, 0, 0, 0, 1, 0};
    pipeline->placeObstacle(obstacles[1], pose, pose);
    EXPECT_EQ(kept(), 2u) << "one was placed";
    pipeline->moveObstacle(obstacles[0], sphere.m_positions.data());
    EXPECT_EQ(kept(), 2u) << "one was given other positions";
    pipeline->remove(obstacles.back());
    obstacles.pop_back();
    EXPECT_EQ(kept(), 2u) << "one went";
}

INSTANTIATE_TEST_SUITE_P(Backends, SkipsTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
