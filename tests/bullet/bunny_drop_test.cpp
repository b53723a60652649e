// The scene of cloth_drop, 2,048 cloth triangles over the bunny: from rest, and at speeds of up to 200 m/s.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "oracle/crossings.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"
#include "tests/support/published_data.h"

namespace drape::test
{
namespace
{
constexpr int kSteps = 80, kStepsFromRest = 240;
constexpr float kBunnySize = 2.0f;  // m

class BunnyDrop : public testing::TestWithParam<int>
{
protected:
    void SetUp() override
    {
        if (!loadBunny(m_bunny)) return;
        placeOnFloor(m_bunny, kBunnySize);
    }

    // Falls with the parameter's speed. Fails the test where a step ends with anything on the wrong side, or a node
    // went through the bunny and out of it in a step. Returns the hash of the positions of all steps.
    std::uint64_t drop(Settings settings, ContactMode mode)
    {
        settings.m_mode = mode;
        Plugin plugin(settings);
        MeshShape shape(m_bunny);
        DropWorld world(&plugin);
        world.addObstacle(shape.shape());
        ClothSpec spec;
        spec.m_nodes = 33;
        spec.m_size = 2.4f;
        spec.m_centre = btVector3(0, btScalar(boundsOf(m_bunny).m_high[1]) + btScalar(0.32), 0);
        btSoftBody& cloth = world.addCloth(spec);
        cloth.setVelocity(btVector3(0, -btScalar(GetParam()), 0));
        PenetrationMeter meter(m_bunny, meshOf(cloth));
        Crossings crossings(m_bunny, positionsOf(cloth));
        std::uint64_t hash = kHashStart;
        std::size_t most = 0;
        const int steps = GetParam() == 0 ? kStepsFromRest : kSteps;
        for (int step = 0; step < steps; ++step)
        {
            world.step();
            hash = hashOf(cloth, hash);
            most = std::max(most, plugin.statistics().m_contacts);
            const StepMeasure measure = meter.measure(positionsOf(cloth).data());
            EXPECT_EQ(measure.nodesBelow(), 0u) << "step " << step;
            EXPECT_EQ(measure.m_intersectingPairs, 0u) << "step " << step;
            EXPECT_EQ(measure.m_invalidNodes, 0u) << "step " << step;
            crossings.follow(positionsOf(cloth));
            EXPECT_EQ(crossings.nodes(), 0u) << "step " << step;
            if (HasFailure()) break;
        }
        EXPECT_GT(most, 1000u);
        return hash;
    }

    TriangleMesh m_bunny;
};
}  // namespace

TEST_P(BunnyDrop, EndsEveryStepOutsideInBothModesOnEveryBackEnd)
{
    std::uint64_t first = 0;
    for (const BackendCase& backend : allBackends())
    {
        if (backend.m_missing) continue;
        for (const ContactMode mode : {ContactMode::Automatic, ContactMode::Continuous})
        {
            SCOPED_TRACE(backend.m_name + (mode == ContactMode::Automatic ? ", automatic" : ", continuous"));
            // Serial continuous steps take too long to be repeated at every speed.
            if (backend.m_settings.m_backend == Backend::Host && mode == ContactMode::Continuous && GetParam() != 50)
                continue;
            const std::uint64_t hash = drop(backend.m_settings, mode);
            if (first == 0) first = hash;
            EXPECT_EQ(hash, first);
            if (HasFailure()) return;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Speeds, BunnyDrop, testing::Values(0, 2, 10, 50, 200), testing::PrintToStringParamName());
}  // namespace drape::test
