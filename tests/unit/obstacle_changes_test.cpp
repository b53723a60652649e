// Finds the obstacles that a back end must update: new ones, and ones with other positions or another pose.
#include "bullet_plugin/core/scene/obstacle_changes.h"

#include <gtest/gtest.h>

namespace drape::test
{
namespace
{
// Four obstacles, all where they were made.
class ObstacleChangesTest : public testing::Test
{
protected:
    ObstacleChangesTest()
    {
        for (MeshId id = 0; id < 4; ++id)
        {
            PooledMesh mesh;
            mesh.m_id = id;
            m_scene.m_obstacles.add(std::move(mesh));
        }
        m_scene.m_obstacles.update();
        m_scene.m_places.resize(4);
    }

    void place(std::size_t slot, float shift)
    {
        m_scene.m_places[slot].m_posed = 1;
        m_scene.m_places[slot].m_pose[3] = shift;
        ++m_scene.m_posesRevision;
    }
    void reshape(std::size_t slot)
    {
        m_scene.m_obstacles.mesh(slot).m_positionsRevision = ++m_scene.m_positionsRevision;
    }

    // Returns a letter for each slot: reshaped, placed, or nothing.
    std::string changed(std::size_t fresh)
    {
        m_changes.update(m_scene, fresh);
        std::string all;
        for (std::size_t slot = 0; slot < m_scene.m_places.size(); ++slot)
            all += m_changes.reshaped(slot) ? 'r' : m_changes.moved(slot) ? 'p' : '-';
        return all;
    }

    Scene m_scene;
    ObstacleChanges m_changes;
};
}  // namespace

TEST_F(ObstacleChangesTest, NewReshapedAndMovedObstaclesAreFound)
{
    EXPECT_EQ(changed(0), "rrrr");
    EXPECT_FALSE(m_changes.any(m_scene));
    EXPECT_EQ(changed(4), "----");
    place(1, 0.5f);
    reshape(3);
    EXPECT_TRUE(m_changes.any(m_scene));
    EXPECT_EQ(changed(4), "-p-r");
    EXPECT_FALSE(m_changes.any(m_scene));
    place(1, 0.5f);
    EXPECT_TRUE(m_changes.any(m_scene)) << "it may have moved";
    EXPECT_EQ(changed(4), "----") << "it has not moved";
    reshape(0);
    reshape(2);
    EXPECT_EQ(changed(3), "r-rr");
}

TEST_F(ObstacleChangesTest, ForgottenObstaclesAreNew)
{
    place(2, 1.0f);
    EXPECT_EQ(changed(0), "rrrr");
    m_changes.forget();
    EXPECT_TRUE(m_changes.any(m_scene));
    EXPECT_EQ(changed(0), "rrrr");
    EXPECT_EQ(m_changes.places()[2].m_pose[3], 1.0f);
}
}  // namespace drape::test
