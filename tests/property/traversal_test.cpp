// The traversal is a choice of time: contacts are the same, bit for bit, with every one and with a front kept from step
// to step, under random motion, teleports and meshes that come and go.
#include <gtest/gtest.h>

#include "tests/support/backends.h"
#include "tests/support/live_scene.h"
#include "tests/support/side.h"
#include "tests/support/traversals.h"

namespace drape::test
{
class TraversalTest : public BackendTest
{
protected:
    std::unique_ptr<Pipeline> make(Traversal traversal, bool counting = false)
    {
        Settings settings = GetParam().m_settings;
        settings.m_methods.m_traversal = traversal;
        settings.m_methods.m_countTests = counting;
        return makePipeline(settings);
    }
};

TEST_P(TraversalTest, ContactsAreTheSame)
{
    std::size_t contacts = 0;
    for (std::uint32_t seed = 900; seed < 903; ++seed)
    {
        std::vector<std::unique_ptr<Pipeline>> owned;
        std::vector<Pipeline*> pipelines;
        for (Traversal traversal : allTraversals())
        {
            owned.push_back(make(traversal));
            ASSERT_TRUE(owned.back());
            pipelines.push_back(owned.back().get());
        }
        LiveScene scene(pipelines, seed, true);
        for (int step = 0; step < 60; ++step)
        {
            scene.nextStep();
            const std::vector<Contact> first = runStep(*pipelines[0]);
            contacts += first.size();
            for (std::size_t i = 1; i < pipelines.size(); ++i)
            {
                SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step) + ", " +
                             traversalName(allTraversals()[i]));
                const std::vector<Contact> other = runStep(*pipelines[i]);
                ASSERT_TRUE(sameBytes(other, first)) << difference(other, first);
                EXPECT_EQ(pipelines[i]->statistics().m_candidates, pipelines[0]->statistics().m_candidates);
                EXPECT_EQ(pipelines[i]->statistics().m_status, pipelines[0]->statistics().m_status);
            }
        }
    }
    EXPECT_GT(contacts, 10000u);
}

// A front in a pipeline: it is used from the second step on, and drops with a mesh that comes.
TEST_P(TraversalTest, FrontIsKeptUntilMeshesChange)
{
    const std::unique_ptr<Pipeline> pipeline = make(Traversal::Front, true);
    ASSERT_TRUE(pipeline);
    const StepCase step = drapedCase("torus", 33, 0.02f, 910);
    const MeshId cloth = addCloth(*pipeline, step.m_cloth), obstacle = addObstacle(*pipeline, step.m_obstacle);
    std::vector<std::size_t> tests;
    const auto run = [&](int times)
    {
        for (int i = 0; i < times; ++i)
        {
            setMotion(*pipeline, cloth, step.m_cloth.m_positions, step.m_end);
            pipeline->addPair(cloth, obstacle, step.m_thickness);
            EXPECT_FALSE(runStep(*pipeline).empty());
            tests.push_back(pipeline->statistics().m_volumeTests);
        }
    };
    run(4);
    addObstacle(*pipeline, shapeNamed("box"));
    run(2);
    EXPECT_GT(tests[0], 1000u);
    EXPECT_LT(tests[3], tests[0]);
    EXPECT_GT(tests[4], tests[3]);
    EXPECT_LT(tests[5], tests[4]);
}

INSTANTIATE_TEST_SUITE_P(Backends, TraversalTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
