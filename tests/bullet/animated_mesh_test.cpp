// Meshes whose vertices the app moves in place: that is motion within the step, as a body's is. Cloth is pushed and
// carried along, and stays on its side.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
using Pose = std::function<void(double time, float* vertex)>;

// Poses a mesh beside a cloth before each step. At time 0 vertices have their given positions.
class AnimatedScene
{
public:
    AnimatedScene(const Settings& settings, const TriangleMesh& rest, float height, bool kinematic)
        : m_rest(rest),
          m_now(rest),
          m_shape(rest),
          m_plugin(settings),
          m_world(&m_plugin),
          m_obstacle(kinematic ? m_world.addKinematic(m_shape.shape()) : m_world.addObstacle(m_shape.shape())),
          m_cloth(m_world.addCloth(specAt(height)))
    {
    }

    void step(double time, const Pose& pose)
    {
        m_now = m_rest;
        btVector3 low(SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY), high = -low;
        for (std::size_t i = 0; i < m_now.vertexCount(); ++i)
        {
            float* const vertex = &m_now.m_positions[3 * i];
            pose(time, vertex);
            const btVector3 place(vertex[0], vertex[1], vertex[2]);
            low.setMin(place);
            high.setMax(place);
        }
        std::copy(m_now.m_positions.begin(), m_now.m_positions.end(), m_shape.positions().begin());
        m_shape.shape().refitTree(low, high);
        m_plugin.obstacleChanged(&m_shape.shape());
        m_world.step();
    }
    // Steps and requires that nothing intersects afterwards, and that nothing is inside of a closed mesh.
    void checkedStep(double time, const Pose& pose, bool closed)
    {
        step(time, pose);
        PenetrationMeter meter(m_now, meshOf(m_cloth));
        const StepMeasure measure = meter.measure(positionsOf(m_cloth).data());
        ASSERT_EQ(measure.m_intersectingPairs, 0u) << "at " << time;
        if (closed)
        {
            ASSERT_EQ(measure.nodesBelow(), 0u) << "at " << time;
        }
        ASSERT_EQ(m_plugin.statistics().m_status, kStepGood) << "at " << time;
    }

    TriangleMesh m_rest, m_now;
    MeshShape m_shape;
    Plugin m_plugin;
    DropWorld m_world;
    btCollisionObject& m_obstacle;
    btSoftBody& m_cloth;

private:
    static ClothSpec specAt(float height)
    {
        ClothSpec spec;
        spec.m_nodes = 21;
        spec.m_centre = btVector3(0, btScalar(height), 0);
        return spec;
    }
};

// The speeds move several thicknesses of 20 mm a step.
constexpr double kSpeeds[] = {0.5, 1.5, 6};

class AnimatedMeshes : public BackendTest
{
};
}  // namespace

// The cloth is thrown up and caught again: it and the plate lose contact for a while.
TEST_P(AnimatedMeshes, APlateThatGoesUpAndDownKeepsClothOnItsSide)
{
    for (const bool kinematic : {true, false})
    {
        for (const double speed : kSpeeds)
        {
            AnimatedScene scene(GetParam().m_settings, makeTerrain(3, 0, 8, 1), 0.05f, kinematic);
            const auto height = [&](double time) { return speed / 6 * std::sin(6 * std::max(0.0, time - 0.5)); };
            const Pose pose = [&](double time, float* vertex) { vertex[1] += float(height(time)); };
            for (int i = 0; i < 150; ++i)
            {
                const double time = i / 60.0;
                scene.checkedStep(time, pose, false);
                ASSERT_GT(double(lowestOf(scene.m_cloth)), height(time)) << "speed " << speed << ", step " << i;
            }
        }
    }
}

TEST_P(AnimatedMeshes, APlateThatComesDownOnClothTakesItAlong)
{
    // Gravity pulls the cloth up against the plate.
    for (const double speed : kSpeeds)
    {
        AnimatedScene scene(GetParam().m_settings, makeTerrain(3, 0, 8, 1), -0.05f, true);
        scene.m_world.world().setGravity(btVector3(0, btScalar(9.81), 0));
        scene.m_world.world().getWorldInfo().m_gravity = scene.m_world.world().getGravity();
        const auto height = [&](double time) { return -speed * std::max(0.0, time - 0.5); };
        const Pose pose = [&](double time, float* vertex) { vertex[1] += float(height(time)); };
        for (int i = 0; i < 90; ++i)
        {
            const double time = i / 60.0;
            scene.checkedStep(time, pose, false);
            for (int node = 0; node < scene.m_cloth.m_nodes.size(); ++node)
                ASSERT_LT(double(scene.m_cloth.m_nodes[node].m_x.y()), height(time)) << "speed " << speed;
        }
    }
}

TEST_P(AnimatedMeshes, ATiltingBoardKeepsClothAbove)
{
    for (const double speed : {0.35, 1.4, 4.0})
    {
        AnimatedScene scene(GetParam().m_settings, makeTerrain(2, 0, 12, 1), 0.1f, true);
        const auto slope = [&](double time) { return speed / 3 * std::sin(3 * std::max(0.0, time - 1)); };
        const Pose pose = [&](double time, float* vertex) { vertex[1] += float(vertex[0] * slope(time)); };
        for (int i = 0; i < 240; ++i)
        {
            const double time = i / 60.0;
            scene.checkedStep(time, pose, false);
            for (int node = 0; node < scene.m_cloth.m_nodes.size(); ++node)
            {
                const btVector3& place = scene.m_cloth.m_nodes[node].m_x;
                if (std::fabs(place.x()) > 1 || std::fabs(place.z()) > 1) continue;
                ASSERT_GT(double(place.y()), double(place.x()) * slope(time)) << "speed " << speed << ", step " << i;
            }
        }
    }
}

TEST_P(AnimatedMeshes, WavesUnderClothNeverIntersectIt)
{
    AnimatedScene scene(GetParam().m_settings, makeTerrain(3, 0, 40, 1), 0.05f, true);
    const auto height = [](double time, double x) { return 0.12 * std::min(1.0, time) * std::sin(6 * x + 8 * time); };
    const Pose pose = [&](double time, float* vertex) { vertex[1] += float(height(time, double(vertex[0]))); };
    for (int i = 0; i < 180; ++i)
        scene.checkedStep(i / 60.0, pose, false);
    const btVector3 middle = scene.m_cloth.m_nodes[scene.m_cloth.m_nodes.size() / 2].m_x;
    EXPECT_GT(double(middle.y()), height(179 / 60.0, double(middle.x())));
}

TEST_P(AnimatedMeshes, ClosedBodiesThatGrowAndTwistKeepClothOutside)
{
    const Pose pulses = [](double time, float* vertex)
    {
        for (int axis = 0; axis < 3; ++axis)
            vertex[axis] *= float(1 + 0.15 * std::sin(10 * time));
    };
    const Pose twists = [](double time, float* vertex)
    {
        const double angle = std::sin(8 * time) * double(vertex[1]), x = double(vertex[0]), z = double(vertex[2]);
        vertex[0] = float(x * std::cos(angle) - z * std::sin(angle));
        vertex[2] = float(x * std::sin(angle) + z * std::cos(angle));
    };
    for (const Pose& pose : {pulses, twists})
    {
        AnimatedScene scene(GetParam().m_settings, makeSphere(0.5f, 3), 0.55f, true);
        for (int i = 0; i < 120; ++i)
            scene.checkedStep(i / 60.0, pose, true);
        EXPECT_GT(double(lowestOf(scene.m_cloth)), -1);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, AnimatedMeshes, testing::ValuesIn(allBackends()), backendName);

// Cloth moves with a belt, as it does with a moving body.
TEST(AnimatedMeshesOnHost, FrictionCarriesClothAlongWithTheSurface)
{
    AnimatedScene scene(hostSettings(), makeTerrain(6, 0, 24, 1), 0.03f, true);
    const Pose pose = [](double time, float* vertex) { vertex[0] += float(0.3 * std::max(0.0, time - 0.5)); };
    for (int i = 0; i < 150; ++i)
        scene.checkedStep(i / 60.0, pose, false);
    const btScalar gone = scene.m_cloth.m_nodes[scene.m_cloth.m_nodes.size() / 2].m_x.x();
    EXPECT_NEAR(double(gone), 0.3 * (149 / 60.0 - 0.5), 0.03);
}

// Vertices move while the body itself is moved.
TEST(AnimatedMeshesOnHost, ABodyThatMovesWhileItsVerticesDo)
{
    AnimatedScene scene(hostSettings(), makeSphere(0.5f, 3), 0.55f, true);
    const Pose pose = [](double time, float* vertex) { vertex[1] *= float(1 + 0.2 * std::sin(8 * time)); };
    for (int i = 0; i < 120; ++i)
    {
        const double time = i / 60.0;
        const btTransform place(btMatrix3x3::getIdentity(), btVector3(0, btScalar(0.3 * std::sin(5 * time)), 0));
        scene.m_obstacle.setWorldTransform(place);
        scene.step(time, pose);
        PenetrationMeter meter(placed(scene.m_now, place), meshOf(scene.m_cloth));
        const StepMeasure measure = meter.measure(positionsOf(scene.m_cloth).data());
        ASSERT_EQ(measure.m_intersectingPairs, 0u) << "step " << i;
        ASSERT_EQ(measure.nodesBelow(), 0u) << "step " << i;
    }
    EXPECT_GT(double(lowestOf(scene.m_cloth)), -1.5);
}

// A jump to another pose far away is no motion: the cloth is not dragged there, and intersections are reported.
TEST(AnimatedMeshesOnHost, AMeshThatBecomesAnotherPoseStartsAnew)
{
    AnimatedScene scene(hostSettings(), makeBox(0.4f, 0.4f, 0.4f), 0.23f, true);
    const Pose pose = [](double time, float* vertex) { vertex[1] += time < 0.5 ? 0.0f : 0.25f; };
    scene.m_plugin.setOneSided(&scene.m_shape.shape(), false);
    for (int i = 0; i < 30; ++i)
        scene.step(0, pose);
    const btVector3 before = scene.m_cloth.m_nodes[0].m_x;
    scene.step(1, pose);
    EXPECT_LT((scene.m_cloth.m_nodes[0].m_x - before).length(), btScalar(0.05));
    EXPECT_TRUE(scene.m_plugin.statistics().m_status & kStepStartsIntersecting);
    for (int i = 0; i < 120; ++i)
        scene.step(1, pose);
    EXPECT_EQ(scene.m_plugin.statistics().m_status, kStepGood);
}
}  // namespace drape::test
