// Where cloth comes to rest, and how still it lies there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr double kGapTolerance = 0.02 * kThickness;  // m

// A step of free fall adds g·dt = 0.16 m/s; cloth at rest loses it again in the same step.
constexpr double kSpeedAtRest = 0.02;  // m/s

struct Rest
{
    Plugin m_plugin;
    DropWorld m_world;
    explicit Rest(const Settings& settings) : m_plugin(settings), m_world(&m_plugin) {}

    btSoftBody& cloth(float size, btScalar height)
    {
        ClothSpec spec;
        spec.m_size = size;
        spec.m_centre = btVector3(0, height, 0);
        return m_world.addCloth(spec);
    }

    double greatestSpeed(const btSoftBody& body, int steps)
    {
        double greatest = 0;
        for (int i = 0; i < steps; ++i)
        {
            m_world.step();
            greatest = std::max(greatest, rmsSpeed(body));
        }
        return greatest;
    }
};
}  // namespace

class RestingCloth : public BackendTest
{
};

TEST_P(RestingCloth, liesAtTheThicknessOnAPlane)
{
    Rest rest(GetParam().m_settings);
    const TriangleMesh box = makeBox(3.0f, 0.4f, 3.0f);
    MeshShape shape(box);
    rest.m_world.addObstacle(shape.shape());
    btSoftBody& cloth = rest.cloth(1.0f, btScalar(0.3));
    expectClean(runMeasured(rest.m_world, cloth, box, 180));
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        EXPECT_NEAR(static_cast<double>(cloth.m_nodes[i].m_x.y()) - 0.2, kThickness, kGapTolerance) << "node " << i;
    EXPECT_LT(rest.greatestSpeed(cloth, 60), kSpeedAtRest);
}

TEST_P(RestingCloth, liesAtTheThicknessOnASphere)
{
    Rest rest(GetParam().m_settings);
    const TriangleMesh sphere = makeSphere(0.5f, 4);
    MeshShape shape(sphere);
    rest.m_world.addObstacle(shape.shape());
    btSoftBody& cloth = rest.cloth(0.3f, btScalar(0.56));
    const Course course = runMeasured(rest.m_world, cloth, sphere, 240);
    expectClean(course);
    EXPECT_NEAR(course.m_end.m_gapMin, kThickness, kGapTolerance);
    EXPECT_LT(rest.greatestSpeed(cloth, 60), kSpeedAtRest);
}

INSTANTIATE_TEST_SUITE_P(Backend, RestingCloth, testing::ValuesIn(allBackends()), backendName);

TEST(RestingCloth, thicknessIsTheSumOfBothMargins)
{
    Rest rest(hostSettings());
    MeshShape shape(makeBox(3.0f, 0.4f, 3.0f));
    shape.shape().setMargin(btScalar(0.03));
    rest.m_world.addObstacle(shape.shape());
    btSoftBody& cloth = rest.cloth(0.6f, btScalar(0.3));
    rest.m_world.step(120);
    EXPECT_NEAR(static_cast<double>(lowestOf(cloth)) - 0.2, 0.04, 0.02 * 0.04);
    ASSERT_FALSE(rest.m_plugin.contacts().empty());
    EXPECT_FLOAT_EQ(rest.m_plugin.contacts().front().m_thickness, 0.04f);
}

// The closing pass must not feed energy in: no slow creep over many steps.
TEST(RestingCloth, staysWhereItLies)
{
    Rest rest(hostSettings());
    MeshShape shape(makeBox(3.0f, 0.4f, 3.0f));
    rest.m_world.addObstacle(shape.shape());
    btSoftBody& cloth = rest.cloth(0.5f, btScalar(0.23));
    rest.m_world.step(120);
    const std::vector<float> before = positionsOf(cloth);
    rest.m_world.step(600);
    const std::vector<float> after = positionsOf(cloth);
    double farthest = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
        farthest = std::max(farthest, static_cast<double>(std::abs(after[i] - before[i])));
    EXPECT_LT(farthest, 0.1 * kThickness);
}
}  // namespace drape::test
