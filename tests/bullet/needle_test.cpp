// Cloth that hangs on the tip of a slender cone: one vertex under a face four times as long as the thickness bears all
// of it, and the faces around it close in on the tip.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/mesh_builder.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr double kHeight = 2;  // m
constexpr int kSides = 6, kSteps = 240;

// Its tip is at (0, 0, 0), its axis downwards.
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

class Needle : public BackendTest
{
};
}  // namespace

TEST_P(Needle, holdsClothOnItsTip)
{
    for (const double radius : {0.003, 0.02, 0.05})
    {
        SCOPED_TRACE(radius);
        const TriangleMesh needle = makeNeedle(radius);
        MeshShape shape(needle);
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
        PenetrationMeter meter(needle, meshOf(cloth));
        double leastGap = std::numeric_limits<double>::infinity();
        for (int step = 0; step < kSteps && !HasFailure(); ++step)
        {
            world.step();
            const StepMeasure measure = meter.measure(positionsOf(cloth).data());
            EXPECT_EQ(measure.m_intersectingPairs, 0u) << "step " << step;
            leastGap = std::min(leastGap, measure.m_gapMin);
        }
        EXPECT_GT(leastGap, kThickness / 4);
    }
}

INSTANTIATE_TEST_SUITE_P(Backend, Needle, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
