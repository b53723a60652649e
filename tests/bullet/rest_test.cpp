// Cloth comes to rest and lies still.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "oracle/rest_meter.h"
#include "scenes/mesh_builder.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"
#include "tests/support/published_data.h"

namespace drape::test
{
namespace
{
constexpr double kGapTolerance = 0.02 * kThickness;  // m

// A step of free fall adds g·dt = 0.16 m/s; cloth at rest loses it again in the same step.
constexpr double kSpeedAtRest = 0.02;  // m/s

// The guarantees for cloth that had time to settle, over kStepsAtRest steps.
constexpr double kSpeedSettled = 0.001;  // m/s
constexpr int kStepsToSettle = 500, kStepsAtRest = 2000;

// The worst of these steps, RMS over the nodes, m/s: no jerk. Twice what was measured: 1.3 mm/s on the sphere, where
// the cloth slips now and then, 0.5 on the pile of boards; on the bunny, where it slips over the ears, 4.5.
constexpr double kWorstStep = 0.0026, kWorstStepOnBunny = 0.009;

// Returns the RMS speed in m/s, from the positions before and after a step.
double rmsMotion(const std::vector<float>& before, const std::vector<float>& after)
{
    double sum = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
        sum += (static_cast<double>(after[i]) - before[i]) * (static_cast<double>(after[i]) - before[i]);
    return std::sqrt(3 * sum / static_cast<double>(before.size())) / kDt;
}

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

TEST_P(RestingCloth, LiesAtTheThicknessOnAPlane)
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

TEST_P(RestingCloth, LiesAtTheThicknessOnASphere)
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

namespace
{
// Obstacles on which cloth can rest, from smooth to sharp, with the cloth hanging over their edges or lying in them.
struct Bed
{
    const char* m_shape;
    float m_size;       // m, of the cloth
    btScalar m_height;  // m, of the cloth at the start; the obstacle's top is below
};

double square(double a)
{
    return a * a;
}

class SettledCloth : public testing::TestWithParam<std::tuple<Bed, BackendCase>>
{
protected:
    void SetUp() override { requireBackend(std::get<1>(GetParam())); }
};

class SettledBunny : public BackendTest
{
};

class SettledPile : public BackendTest
{
};
}  // namespace

// The speed that Bullet keeps and the motion that is seen: a correction of places alone would show in the second only.
// RMS over all steps: cloth that hangs over a sphere slips now and then, on which steps is chance of the height it fell
// from.
TEST_P(SettledCloth, LiesStill)
{
    const Bed& bed = std::get<0>(GetParam());
    Rest rest(std::get<1>(GetParam()).m_settings);
    TriangleMesh mesh;
    ASSERT_TRUE(makeShape(bed.m_shape, mesh));
    MeshShape shape(mesh);
    rest.m_world.addObstacle(shape.shape());
    btSoftBody& cloth = rest.cloth(bed.m_size, bed.m_height);
    rest.m_world.step(kStepsToSettle);
    double speed2 = 0, motion2 = 0, worst = 0;
    for (int i = 0; i < kStepsAtRest; ++i)
    {
        const std::vector<float> before = positionsOf(cloth);
        rest.m_world.step();
        const double speed = rmsSpeed(cloth), motion = rmsMotion(before, positionsOf(cloth));
        speed2 += square(speed);
        motion2 += square(motion);
        worst = std::max({worst, speed, motion});
    }
    EXPECT_LE(worst, kWorstStep);
    EXPECT_LE(std::sqrt(speed2 / kStepsAtRest), kSpeedSettled);
    EXPECT_LE(std::sqrt(motion2 / kStepsAtRest), kSpeedSettled);
    ASSERT_GT(rest.m_plugin.statistics().m_contacts, 0u);
    const StepMeasure end = PenetrationMeter(mesh, meshOf(cloth)).measure(positionsOf(cloth).data());
    EXPECT_EQ(end.m_intersectingPairs, 0u);
    EXPECT_GT(end.m_gapMin, 0.9 * kThickness);
}

namespace
{
// Drops cloth_drop's cloth of 2,048 triangles from `fall` (m) and expects it to lie still on the mesh: RMS speed over
// all steps. At edges friction lets hanging cloth slip now and then; no step is faster than worstStep (m/s).
void expectLiesStill(Rest& rest, const TriangleMesh& mesh, float size, btScalar fall, double worstStep)
{
    MeshShape shape(mesh);
    rest.m_world.addObstacle(shape.shape());
    ClothSpec spec;
    spec.m_nodes = 33;
    spec.m_size = size;
    spec.m_damping = btScalar(0.02);
    spec.m_centre = btVector3(0, btScalar(boundsOf(mesh).m_high[1]) + btScalar(kThickness) + fall, 0);
    btSoftBody& cloth = rest.m_world.addCloth(spec);
    cloth.m_cfg.piterations = 5;
    cloth.m_materials[0]->m_kLST = btScalar(0.9);
    rest.m_world.step(kStepsToSettle);
    double sum2 = 0, worst = 0;
    for (int i = 0; i < kStepsAtRest; ++i)
    {
        rest.m_world.step();
        sum2 += square(rmsSpeed(cloth));
        worst = std::max(worst, rmsSpeed(cloth));
    }
    EXPECT_LE(worst, worstStep);
    EXPECT_LE(std::sqrt(sum2 / kStepsAtRest), kSpeedSettled);
    const StepMeasure end = PenetrationMeter(mesh, meshOf(cloth)).measure(positionsOf(cloth).data());
    EXPECT_EQ(end.m_intersectingPairs, 0u);
    EXPECT_GT(end.m_gapMin, 0.9 * kThickness);
}

constexpr int kBoards = 24;

// Makes thin boards on top of each other, each rotated against the last. Their corners press into the cloth's faces.
TriangleMesh makePileOfBoards()
{
    TriangleMesh pile;
    for (int i = 0; i < kBoards; ++i)
    {
        const btTransform pose(btQuaternion(btVector3(0, 1, 0), btScalar(0.26) * btScalar(i)),
                               btVector3(0, btScalar(0.03) * (btScalar(i) + btScalar(0.5)), 0));
        const TriangleMesh board = placed(makeBox(0.9f, 0.008f, 0.9f), pose);
        const std::int32_t first = static_cast<std::int32_t>(pile.vertexCount());
        pile.m_positions.insert(pile.m_positions.end(), board.m_positions.begin(), board.m_positions.end());
        for (const std::int32_t vertex : board.m_triangles)
            pile.m_triangles.push_back(first + vertex);
    }
    return pile;
}
}  // namespace

// The bunny has 69,666 triangles and a height of 2 m. Cloth that falls by 0.5 m would keep moving at 1.3 mm/s with
// planes of the predicted step's end and contacts that do not settle.
TEST_P(SettledBunny, LiesStill)
{
    TriangleMesh bunny;
    if (!loadBunny(bunny)) return;
    placeOnFloor(bunny, 2.0f);
    for (const btScalar fall : {btScalar(0.3), btScalar(0.5)})
    {
        SCOPED_TRACE(testing::Message() << "fall of " << fall << " m");
        Rest rest(GetParam().m_settings);
        expectLiesStill(rest, bunny, 2.4f, fall, kWorstStepOnBunny);
        ASSERT_GT(rest.m_plugin.statistics().m_contacts, 1000u);
    }
}

// Faces would rock on the boards' corners for ever, at 20 mm/s, if contacts' planes stayed those of the predicted
// step's end.
TEST_P(SettledPile, LiesStill)
{
    Rest rest(GetParam().m_settings);
    expectLiesStill(rest, makePileOfBoards(), 1.8f, btScalar(0.3), kWorstStep);
}

INSTANTIATE_TEST_SUITE_P(
    Beds, SettledCloth,
    testing::Combine(testing::Values(Bed{"sphere", 2.4f, btScalar(1.08)}, Bed{"sphere", 2.4f, btScalar(1.1)},
                                     Bed{"sphere", 2.4f, btScalar(1.15)}, Bed{"sphere", 2.4f, btScalar(1.2)},
                                     Bed{"box", 2.4f, btScalar(0.6)}, Bed{"bowl", 1.2f, btScalar(0.1)},
                                     Bed{"torus", 1.6f, btScalar(0.4)}),
                     testing::ValuesIn(allBackends())),
    [](const testing::TestParamInfo<std::tuple<Bed, BackendCase>>& test)
    {
        const Bed& bed = std::get<0>(test.param);
        const int height = static_cast<int>(std::lround(100 * bed.m_height));  // cm
        return bed.m_shape + std::string("_") + std::to_string(height) + "_" + std::get<1>(test.param).m_name;
    });

INSTANTIATE_TEST_SUITE_P(Backend, SettledBunny, testing::ValuesIn(openClBackends()), backendName);
INSTANTIATE_TEST_SUITE_P(Backend, SettledPile, testing::ValuesIn(allBackends()), backendName);

namespace
{
// Makes a sphere of radius 1 m with triangles between meridians and parallels.
TriangleMesh makeGlobe()
{
    constexpr int kParts = 48;
    TriangleMesh mesh;
    for (int i = 0; i <= kParts; ++i)
        for (int j = 0; j < kParts; ++j)
        {
            const double fromPole = i * 3.14159265 / kParts, turn = j * 2 * 3.14159265 / kParts;
            addVertex(mesh, std::cos(turn) * std::sin(fromPole), std::cos(fromPole),
                      std::sin(turn) * std::sin(fromPole));
        }
    for (int i = 0; i < kParts; ++i)
        for (int j = 0; j < kParts; ++j)
        {
            const int next = (j + 1) % kParts, a = i * kParts, b = a + kParts;
            addTriangle(mesh, a + j, a + next, b + j);
            addTriangle(mesh, a + next, b + next, b + j);
        }
    return mesh;
}
}  // namespace

// README's cloth, with Bullet's default of one iteration. The RMS is over all steps and nodes. The fastest node slips;
// the limit is twice the value measured with four iterations, 22 mm/s.
TEST(IterationsOfBullet, ASingleIterationBringsClothToRestLikeFour)
{
    for (const int iterations : {1, 4})
    {
        SCOPED_TRACE(testing::Message() << iterations << " iterations");
        Rest rest(hostSettings());
        MeshShape shape(makeGlobe());
        rest.m_world.addObstacle(shape.shape());
        const std::unique_ptr<btSoftBody> cloth(btSoftBodyHelpers::CreatePatch(
            rest.m_world.world().getWorldInfo(), btVector3(-1, btScalar(1.1), -1), btVector3(1, btScalar(1.1), -1),
            btVector3(-1, btScalar(1.1), 1), btVector3(1, btScalar(1.1), 1), 33, 33, 0, true));
        cloth->getCollisionShape()->setMargin(kMargin);
        cloth->m_cfg.piterations = iterations;
        rest.m_world.world().addSoftBody(cloth.get());
        rest.m_world.step(kStepsToSettle);
        double sum2 = 0, worst = 0;
        for (int i = 0; i < 300; ++i)
        {
            rest.m_world.step();
            sum2 += square(rmsSpeed(*cloth));
            for (int node = 0; node < cloth->m_nodes.size(); ++node)
                worst = std::max(worst, static_cast<double>(cloth->m_nodes[node].m_v.length()));
        }
        EXPECT_LE(std::sqrt(sum2 / 300), kSpeedSettled);
        EXPECT_LE(worst, 2 * 0.022);
        rest.m_world.world().removeSoftBody(cloth.get());
    }
}

namespace
{
// Returns the RMS speed over the last 200 of 1,000 steps, m/s, of a cloth that is pinned in its middle. plugin: null
// for Bullet alone.
double hangingSpeed(Plugin* plugin, int nodes)
{
    DropWorld world(plugin);
    ClothSpec spec;
    spec.m_nodes = nodes;
    spec.m_size = 2.4f;
    spec.m_damping = btScalar(0.02);
    btSoftBody& cloth = world.addCloth(spec);
    cloth.m_cfg.piterations = 5;
    cloth.m_materials[0]->m_kLST = btScalar(0.9);
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
    {
        const btVector3& place = cloth.m_nodes[i].m_x;
        if (std::max(btFabs(place.x()), btFabs(place.z())) < btScalar(0.3)) cloth.setMass(i, 0);
    }
    world.step(800);
    double sum2 = 0;
    for (int i = 0; i < 200; ++i)
    {
        world.step();
        sum2 += square(rmsSpeed(cloth));
    }
    return std::sqrt(sum2 / 200);
}
}  // namespace

// Bullet's links alone, without an obstacle or contacts, keep fine hanging cloth in motion. Cloth of 4,225 nodes that
// is pinned in its middle keeps fluttering at 122 mm/s; cloth of 1,089 nodes comes to rest at 0.1 mm/s.
TEST(HangingCloth, FluttersBecauseOfBulletsLinksAlone)
{
    EXPECT_LT(hangingSpeed(nullptr, 33), kSpeedSettled);
    EXPECT_GT(hangingSpeed(nullptr, 65), 50 * kSpeedSettled);
}

TEST(HangingCloth, ComesToRestInSubsteps)
{
    Settings settings = hostSettings();
    settings.m_solver = Solver::Drape;
    Plugin plugin(settings);
    EXPECT_LT(hangingSpeed(&plugin, 65), 1e-3);
}

// The speed by positions and by velocities. Without nodeSettle() and a tolerance for closing sweeps, single nodes would
// keep moving to and fro beside the edges, at 0.2 to 0.6 mm/s over all nodes.
TEST(ClothOnStairs, LiesStill)
{
    Rest rest(hostSettings());
    MeshShape shape(makeStairs(2.0f, 1.2f, 2.0f, 6));
    btCollisionObject& stairs = rest.m_world.addObstacle(shape.shape());
    stairs.setFriction(1);
    ClothSpec spec;
    spec.m_nodes = 33;
    spec.m_size = 2.4f;
    spec.m_damping = btScalar(0.05);
    spec.m_centre = btVector3(btScalar(0.1), btScalar(1.3), btScalar(0.05));
    btSoftBody& cloth = rest.m_world.addCloth(spec);
    cloth.m_cfg.piterations = 5;
    cloth.m_cfg.kDF = btScalar(0.6);
    cloth.m_materials[0]->m_kLST = btScalar(0.9);
    rest.m_world.step(600);
    RestMeter meter(positionsOf(cloth));
    double speed2 = 0;
    for (int i = 0; i < 200; ++i)
    {
        rest.m_world.step();
        meter.add(positionsOf(cloth), static_cast<double>(kDt));
        speed2 += square(rmsSpeed(cloth)) / 200;
    }
    EXPECT_LE(meter.speed(), 1e-4);
    EXPECT_LE(std::sqrt(speed2), 1e-4);
    ASSERT_GT(rest.m_plugin.statistics().m_contacts, 0u);
}

TEST_P(RestingCloth, TheThicknessIsTheSumOfBothMargins)
{
    Rest rest(GetParam().m_settings);
    MeshShape shape(makeBox(3.0f, 0.4f, 3.0f));
    shape.shape().setMargin(btScalar(0.03));
    rest.m_world.addObstacle(shape.shape());
    btSoftBody& cloth = rest.cloth(0.6f, btScalar(0.3));
    rest.m_world.step(120);
    EXPECT_NEAR(static_cast<double>(lowestOf(cloth)) - 0.2, 0.04, 0.02 * 0.04);
    ASSERT_FALSE(rest.m_plugin.contacts().empty());
    EXPECT_FLOAT_EQ(rest.m_plugin.contacts().front().m_thickness, 0.04f);
}

// The contact sweeps must not add energy: the cloth does not creep over many steps.
TEST_P(RestingCloth, StaysWhereItLies)
{
    Rest rest(GetParam().m_settings);
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

INSTANTIATE_TEST_SUITE_P(Backend, RestingCloth, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
