// Compares drops with Drape on every back end with drops with Bullet's own collision.
#include <gtest/gtest.h>

#include <string>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr int kSteps = 90;

struct Drop
{
    const char* m_name;
    TriangleMesh m_obstacle;
    btVector3 m_centre;  // centre of the cloth
};

// Makes three cases: round and coarse, round and fine, and sharp. Each lands within 20 steps.
std::vector<Drop> drops()
{
    return {{"coarse_sphere", makeSphere(0.4f, 1), btVector3(0, btScalar(0.5), 0)},
            {"fine_sphere", makeSphere(0.4f, 3), btVector3(0, btScalar(0.5), 0)},
            {"stairs", makeStairs(1.0f, 0.5f, 1.0f, 3), btVector3(0, btScalar(0.65), 0)}};
}

Course runWith(Plugin* plugin, const Drop& drop)
{
    MeshShape shape(drop.m_obstacle);
    DropWorld world(plugin);
    world.addObstacle(shape.shape());
    ClothSpec spec;
    spec.m_centre = drop.m_centre;
    btSoftBody& cloth = world.addCloth(spec);
    return runMeasured(world, cloth, drop.m_obstacle, kSteps);
}

void record(const std::string& name, const Course& course)
{
    testing::Test::RecordProperty(name + "_penetration_max_mm", std::to_string(1000 * course.m_penetrationMax));
    testing::Test::RecordProperty(name + "_nodes_below_end", std::to_string(course.m_end.nodesBelow()));
    testing::Test::RecordProperty(name + "_intersecting_pairs_end", std::to_string(course.m_end.m_intersectingPairs));
}
}  // namespace

class DropComparison : public BackendTest
{
};

TEST_P(DropComparison, EveryBackendGivesTheSameCloth)
{
    for (const Drop& drop : drops())
    {
        SCOPED_TRACE(drop.m_name);
        Plugin host(hostSettings()), chosen(GetParam().m_settings);
        ASSERT_TRUE(host.ready()) << host.error();
        ASSERT_TRUE(chosen.ready()) << chosen.error();
        EXPECT_FALSE(chosen.device().m_onHost);
        const Course here = runWith(&host, drop), there = runWith(&chosen, drop);
        EXPECT_EQ(here.m_hash, there.m_hash);
        EXPECT_GT(chosen.statistics().m_contacts, 0u);
        expectClean(here);
        expectClean(there);
    }
}

INSTANTIATE_TEST_SUITE_P(Device, DropComparison, testing::ValuesIn(openClBackends()), backendName);

// The report records the final position of the cloth with Bullet's own collision. The test asserts only that Bullet
// fails in these scenes: some part of the cloth or the obstacle passes by much more than the thickness.
TEST(DropComparison, BuiltInCollisionLeaksAndDrapeDoesNot)
{
    Plugin plugin(hostSettings());
    for (const Drop& drop : drops())
    {
        SCOPED_TRACE(drop.m_name);
        const Course drape = runWith(&plugin, drop), builtIn = runWith(nullptr, drop);
        record(std::string("drape_") + drop.m_name, drape);
        record(std::string("built_in_") + drop.m_name, builtIn);
        expectClean(drape);
        EXPECT_EQ(builtIn.m_end.m_invalidNodes, 0u);
        EXPECT_GT(builtIn.m_penetrationMax, kThickness);
    }
}

TEST(DropComparison, RunsRepeatBitForBit)
{
    const Drop drop = drops().back();
    Plugin first(hostSettings()), second(hostSettings());
    EXPECT_EQ(runWith(&first, drop).m_hash, runWith(&second, drop).m_hash);
    EXPECT_EQ(runWith(&first, drop).m_hash, runWith(&second, drop).m_hash) << "a used plugin must not remember";
}
}  // namespace drape::test
