// Cloth that falls fast: by many times its thickness, and through the whole obstacle, in one step.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
struct FastDrop
{
    const char* m_shape;
    btScalar m_speed;   // m/s, downwards
    btScalar m_height;  // m, of the cloth at the start
};

constexpr int kSteps = 60;

class FastDropping : public testing::TestWithParam<std::tuple<FastDrop, BackendCase>>
{
protected:
    void SetUp() override { requireBackend(std::get<1>(GetParam())); }
};
}  // namespace

// After every step nothing is on the wrong side and nothing intersects.
TEST_P(FastDropping, EndsEveryStepOutside)
{
    const FastDrop& drop = std::get<0>(GetParam());
    TriangleMesh mesh;
    ASSERT_TRUE(makeShape(drop.m_shape, mesh));
    MeshShape shape(mesh);
    Plugin plugin(std::get<1>(GetParam()).m_settings);
    DropWorld world(&plugin);
    world.addObstacle(shape.shape());
    ClothSpec spec;
    spec.m_size = 2.4f;
    spec.m_centre = btVector3(0, drop.m_height, 0);
    btSoftBody& cloth = world.addCloth(spec);
    cloth.setVelocity(btVector3(0, -drop.m_speed, 0));
    PenetrationMeter meter(mesh, meshOf(cloth));
    std::size_t most = 0;
    for (int step = 0; step < kSteps; ++step)
    {
        world.step();
        most = std::max(most, plugin.statistics().m_contacts);
        const StepMeasure measure = meter.measure(positionsOf(cloth).data());
        ASSERT_EQ(measure.nodesBelow(), 0u) << "step " << step;
        ASSERT_EQ(measure.m_intersectingPairs, 0u) << "step " << step;
        ASSERT_EQ(measure.m_invalidNodes, 0u) << "step " << step;
    }
    EXPECT_GT(most, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Drops, FastDropping,
    testing::Combine(testing::Values(FastDrop{"sphere", 10, btScalar(1.3)}, FastDrop{"sphere", 200, btScalar(1.3)},
                                     FastDrop{"stairs", 50, btScalar(1.5)}, FastDrop{"box", 200, btScalar(0.8)},
                                     FastDrop{"torus", 50, btScalar(0.6)}, FastDrop{"bowl", 3, btScalar(0.1)}),
                     testing::ValuesIn(allBackends())),
    [](const testing::TestParamInfo<std::tuple<FastDrop, BackendCase>>& test)
    {
        const FastDrop& drop = std::get<0>(test.param);
        return drop.m_shape + std::to_string(static_cast<int>(drop.m_speed)) + "_" + std::get<1>(test.param).m_name;
    });
}  // namespace drape::test
