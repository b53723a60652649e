// One-sided obstacles have the contacts of two-sided ones on their front, and none on their back.
#include <gtest/gtest.h>

#include "scenes/describe_mesh.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/oracle.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"

namespace drape::test
{
class SidesTest : public BackendTest
{
protected:
    std::vector<Contact> run(const StepCase& step, bool oneSided, const float* pose = nullptr)
    {
        const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
        if (!pipeline) return {};
        MeshDescription description = describeMesh(step.m_obstacle);
        description.m_oneSided = oneSided;
        const MeshId cloth = addCloth(*pipeline, step.m_cloth), obstacle = pipeline->addObstacle(description);
        if (pose) pipeline->placeObstacle(obstacle, pose, pose);
        setMotion(*pipeline, cloth, step.m_cloth.m_positions, step.m_end);
        pipeline->addPair(cloth, obstacle, step.m_thickness);
        return runStep(*pipeline);
    }
};

// Makes a cloth scaled about the sphere's middle, to lie inside or outside of it.
StepCase aroundSphere(float radius)
{
    StepCase step = {"around a sphere", 0, shapeNamed("sphere"), shapeNamed("sphere"), {}, 0.03f};
    float size = 0;
    Vector3 middle;
    for (std::size_t v = 0; v < step.m_cloth.vertexCount(); ++v)
        middle += (1.0 / double(step.m_cloth.vertexCount())) * position(step.m_cloth.m_positions, std::uint32_t(v));
    size = float(length(position(step.m_cloth.m_positions, 0) - middle));
    for (std::size_t v = 0; v < step.m_cloth.vertexCount(); ++v)
    {
        const Vector3 p =
            middle + double(1 + radius / size) * (position(step.m_cloth.m_positions, std::uint32_t(v)) - middle);
        for (int axis = 0; axis < 3; ++axis)
            step.m_cloth.m_positions[3 * v + std::size_t(axis)] = float(p[axis]);
    }
    step.m_end = step.m_cloth.m_positions;
    return step;
}

TEST_P(SidesTest, ClosedMeshHoldsFromOutsideOnly)
{
    for (const float gap : {0.02f, -0.02f})
    {
        const StepCase step = aroundSphere(gap);
        const std::vector<Contact> both = run(step, false), front = run(step, true);
        EXPECT_GT(both.size(), 500u);
        ASSERT_EQ(front.size(), gap > 0 ? both.size() : 0u);
        if (gap > 0)
        {
            EXPECT_TRUE(sameBytes(both, front));
        }
    }
}

TEST_P(SidesTest, OpenMeshLetsClothThroughFromBehind)
{
    // The floor faces up if its corners run counter-clockwise seen from above.
    const TriangleMesh floor = looseTriangles({-1, 0, -1, 0, 0, 1, 1, 0, -1});
    for (const float from : {0.2f, -0.2f})
    {
        StepCase step = {"through a floor",
                         0,
                         looseTriangles({-0.1f, from, -0.6f, 0.1f, from, -0.6f, 0, from, -0.4f}),
                         floor,
                         {},
                         0.02f};
        step.m_end = step.m_cloth.m_positions;
        translate(step.m_end, 0, -2 * from, 0);
        EXPECT_GT(run(step, false).size(), 0u);
        EXPECT_EQ(run(step, true).size(), from > 0 ? run(step, false).size() : 0u);
        // The result over the edge, which has no neighbour to determine the outside, is equal.
        for (std::vector<float>* positions : {&step.m_cloth.m_positions, &step.m_end})
            translate(*positions, 0, 0, -0.5f);
        EXPECT_GT(run(step, false).size(), 0u);
        EXPECT_EQ(run(step, true).size(), from > 0 ? run(step, false).size() : 0u);
    }
}

TEST_P(SidesTest, FrontTurnsWithThePose)
{
    const float upsideDown[12] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0};
    for (const float from : {0.2f, -0.2f})
    {
        StepCase step = {"through a turned floor",
                         0,
                         looseTriangles({-0.1f, from, 0.4f, 0.1f, from, 0.4f, 0, from, 0.6f}),
                         looseTriangles({-1, 0, -1, 0, 0, 1, 1, 0, -1}),
                         {},
                         0.02f};
        step.m_end = step.m_cloth.m_positions;
        translate(step.m_end, 0, -2 * from, 0);
        EXPECT_GT(run(step, false, upsideDown).size(), 0u);
        EXPECT_EQ(run(step, true, upsideDown).size(), from < 0 ? run(step, false, upsideDown).size() : 0u);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, SidesTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
