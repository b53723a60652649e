// Plugin::setOneSided: the walls of a closed mesh hold cloth inside, or the cloth comes out. Sheets without thickness
// hold cloth on either side, or on their front alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "oracle/crossings.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
// Returns the height of a cloth's middle node after its fall inside a box of 2 m around the origin.
float heightAfterFall(bool oneSided, bool kinematic)
{
    Plugin plugin(hostSettings());
    MeshShape box(makeBox(2, 2, 2));
    plugin.setOneSided(&box.shape(), oneSided);
    DropWorld world(&plugin);
    if (kinematic)
        world.addKinematic(box.shape());
    else
        world.addObstacle(box.shape());
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(-0.5), 0);
    const btSoftBody& cloth = world.addCloth(spec);
    world.step(90);
    return static_cast<float>(cloth.m_nodes[cloth.m_nodes.size() / 2].m_x.y());
}
}  // namespace

TEST(Sides, ClothInsideOfABoxStaysThereOrFallsOut)
{
    for (const bool kinematic : {false, true})
    {
        EXPECT_NEAR(heightAfterFall(false, kinematic), -1 + kThickness, 0.01f);
        EXPECT_LT(heightAfterFall(true, kinematic), -2);
    }
}

TEST(Sides, AOneSidedBoxHoldsClothThatComesFromOutside)
{
    Plugin plugin(hostSettings());
    MeshShape box(makeBox(2, 2, 2));
    DropWorld world(&plugin);
    world.addObstacle(box.shape());
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(1.1), 0);
    const btSoftBody& cloth = world.addCloth(spec);
    world.step(30);
    plugin.setOneSided(&box.shape(), true);  // while it lies there
    world.step(60);
    const btScalar resting = cloth.m_nodes[cloth.m_nodes.size() / 2].m_x.y();
    EXPECT_NEAR(resting, 1 + kThickness, 0.01f);
    EXPECT_GT(plugin.statistics().m_contacts, 0u);
}

namespace
{
// A cloth thrown at an open sheet whose front is above, from above, or from below in a world whose gravity pulls up.
class SheetScene
{
public:
    SheetScene(const Settings& settings, float amplitude, bool below, btScalar speed, bool oneSided)
        : m_mesh(makeTerrain(4, amplitude, 16, 1)),
          m_shape(m_mesh),
          m_plugin(settings),
          m_world(&m_plugin),
          m_up(below ? -1 : 1),
          m_cloth(m_world.addCloth(specAt(m_up * btScalar(0.35)))),
          m_crossings(m_mesh, positionsOf(m_cloth)),
          m_meter(m_mesh, meshOf(m_cloth))
    {
        m_plugin.setOneSided(&m_shape.shape(), oneSided);
        m_world.addObstacle(m_shape.shape());
        m_world.world().setGravity(btVector3(0, m_up * btScalar(-9.81), 0));
        m_world.world().getWorldInfo().m_gravity = m_world.world().getGravity();
        m_cloth.setVelocity(btVector3(0, -m_up * speed, 0));
    }

    void step()
    {
        m_world.step();
        m_crossings.follow(positionsOf(m_cloth));
        m_most = std::max(m_most, m_plugin.statistics().m_contacts);
    }

    TriangleMesh m_mesh;
    MeshShape m_shape;
    Plugin m_plugin;
    DropWorld m_world;
    btScalar m_up;  // 1 where the cloth starts above, -1 where it starts below
    btSoftBody& m_cloth;
    Crossings m_crossings;
    PenetrationMeter m_meter;
    std::size_t m_most = 0;  // contacts

private:
    static ClothSpec specAt(btScalar height)
    {
        ClothSpec spec;
        spec.m_centre = btVector3(0, height, 0);
        return spec;
    }
};

constexpr int kSheetSteps = 90;

class Sheets : public testing::TestWithParam<std::tuple<BackendCase, float, int>>
{
protected:
    void SetUp() override { requireBackend(backend()); }

    static const BackendCase& backend() { return std::get<0>(GetParam()); }
    static float amplitude() { return std::get<1>(GetParam()); }           // m
    static btScalar speed() { return btScalar(std::get<2>(GetParam())); }  // m/s
    void expectHeld(bool below, bool oneSided);
};

void Sheets::expectHeld(bool below, bool oneSided)
{
    SCOPED_TRACE((below ? "from below" : "from above") + std::string(oneSided ? ", one-sided" : ""));
    SheetScene scene(backend().m_settings, amplitude(), below, speed(), oneSided);
    for (int step = 0; step < kSheetSteps; ++step)
    {
        scene.step();
        ASSERT_EQ(scene.m_crossings.nodes(), 0u) << "step " << step;
        const StepMeasure measure = scene.m_meter.measure(positionsOf(scene.m_cloth).data());
        ASSERT_EQ(measure.nodesBelow(), 0u) << "step " << step;
        ASSERT_EQ(measure.m_intersectingPairs, 0u) << "step " << step;
        ASSERT_EQ(measure.m_invalidNodes, 0u) << "step " << step;
        if (amplitude() > 0) continue;
        for (int node = 0; node < scene.m_cloth.m_nodes.size(); ++node)
            ASSERT_GT(scene.m_up * scene.m_cloth.m_nodes[node].m_x.y(), 0) << "step " << step << ", node " << node;
    }
    EXPECT_GT(scene.m_most, 100u);
}
}  // namespace

TEST_P(Sheets, TwoSidedSheetsHoldClothOnEitherSide)
{
    for (const bool below : {false, true})
        expectHeld(below, false);
}

TEST_P(Sheets, OneSidedSheetsHoldClothOnTheirFront)
{
    expectHeld(false, true);
}

TEST_P(Sheets, OneSidedSheetsLetClothThroughFromBehind)
{
    SheetScene scene(backend().m_settings, amplitude(), true, speed(), true);
    for (int step = 0; step < kSheetSteps; ++step)
        scene.step();
    EXPECT_EQ(scene.m_most, 0u);
    EXPECT_EQ(scene.m_crossings.nodes(), std::size_t(scene.m_cloth.m_nodes.size()));
    EXPECT_GT(lowestOf(scene.m_cloth), btScalar(1));
}

INSTANTIATE_TEST_SUITE_P(Thrown, Sheets,
                         testing::Combine(testing::ValuesIn(allBackends()), testing::Values(0.0f, 0.15f),
                                          testing::Values(5, 50)),
                         [](const testing::TestParamInfo<Sheets::ParamType>& test)
                         {
                             return std::string(std::get<1>(test.param) > 0 ? "wavy" : "flat") +
                                    std::to_string(std::get<2>(test.param)) + "_" + std::get<0>(test.param).m_name;
                         });
}  // namespace drape::test
