// Cloth that hangs on a slender obstacle. One or two vertices under faces four times as long as the thickness carry all
// of the cloth, and the faces around them close in.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/mesh_builder.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr double kHeight = 2;  // m
constexpr int kSides = 6, kSteps = 240;

// Makes a needle with its tip at (0, 0, 0) and its axis downwards.
TriangleMesh makeNeedle(double radius)
{
    TriangleMesh mesh;
    addVertex(mesh, 0, 0, 0);
    for (int i = 0; i < kSides; ++i)
    {
        const double angle = 2 * std::acos(-1.0) * i / kSides;
        addVertex(mesh, radius * std::cos(angle), -kHeight, radius * std::sin(angle));
    }
    for (int i = 0; i < kSides; ++i)
        addTriangle(mesh, 0, 1 + (i + 1) % kSides, 1 + i);
    for (int i = 1; i + 1 < kSides; ++i)
        addTriangle(mesh, 1, 1 + i, 2 + i);
    return mesh;
}

class Slender : public BackendTest
{
protected:
    // Lets a cloth fall, and fails the test where a step ends with an intersection or too near.
    void drop(const TriangleMesh& obstacle, btScalar speed)
    {
        MeshShape shape(obstacle);
        Plugin plugin(GetParam().m_settings);
        DropWorld world(&plugin);
        world.addObstacle(shape.shape());
        ClothSpec spec;
        spec.m_nodes = 33;
        spec.m_size = 2.4f;
        spec.m_centre = btVector3(btScalar(-0.03), btScalar(0.3), btScalar(-0.02));
        spec.m_damping = btScalar(0.02);
        btSoftBody& cloth = world.addCloth(spec);
        cloth.m_cfg.piterations = 5;
        cloth.m_materials[0]->m_kLST = btScalar(0.9);
        cloth.setVelocity(btVector3(0, -speed, 0));
        PenetrationMeter meter(obstacle, meshOf(cloth));
        for (int step = 0; step < kSteps && !HasFailure(); ++step)
        {
            world.step();
            const StepMeasure measure = meter.measure(positionsOf(cloth).data());
            EXPECT_EQ(measure.m_intersectingPairs, 0u) << "step " << step;
            EXPECT_GT(measure.m_gapMin, kThickness / 4) << "step " << step;
        }
    }
};
}  // namespace

TEST_P(Slender, NeedlesHoldCloth)
{
    for (const double radius : {0.003, 0.02, 0.05})
    {
        SCOPED_TRACE(radius);
        drop(makeNeedle(radius), 0);
    }
}

// Bullet's links stretch to three times their length at 50 m/s.
TEST_P(Slender, PostsHoldClothThatIsThrown)
{
    const btTransform down(btQuaternion::getIdentity(), btVector3(0, btScalar(-kHeight / 2), 0));
    for (const btScalar speed : {btScalar(10), btScalar(50)})
    {
        SCOPED_TRACE(speed);
        drop(placed(makeBox(0.06f, float(kHeight), 0.06f), down), speed);
    }
}

INSTANTIATE_TEST_SUITE_P(Backend, Slender, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
