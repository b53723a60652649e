// Steps over trees: the contacts of the pipeline, bit for bit, with every traversal and builder on the host and on a
// device, as a cloth comes down.
#include "study/step/tree_step.h"

#include <gtest/gtest.h>

#include "tests/support/backends.h"
#include "tests/support/cases.h"
#include "tests/support/pipeline_driver.h"
#include "study/tests/traversals.h"

namespace drape::test
{
namespace
{
constexpr int kSteps = 12;

// A cloth that comes down on a torus; positions at the start of each step and at the end of the last.
struct Fall
{
    Fall() : m_step(fallingCase("torus", 21, 0.02f, 560))
    {
        for (int i = 0; i <= kSteps; ++i)
        {
            m_frames.push_back(m_step.m_end);
            translate(m_frames.back(), 0.0f, 0.02f * float(kSteps / 2 - i), 0.0f);
        }
    }

    StepCase m_step;
    std::vector<std::vector<float>> m_frames;
};

// Runs the fall and returns the sum of the candidates.
std::size_t expectPipelinesContacts(TreeStep& step, const Fall& fall)
{
    Settings host;
    host.m_backend = Backend::Host;
    const std::unique_ptr<Pipeline> pipeline = makePipeline(host);
    if (!pipeline) return 0;
    const MeshId cloth = addCloth(*pipeline, fall.m_step.m_cloth),
                 obstacle = addObstacle(*pipeline, fall.m_step.m_obstacle);
    std::size_t candidates = 0, contacts = 0;
    for (int i = 0; i < kSteps; ++i)
    {
        SCOPED_TRACE("step " + std::to_string(i));
        const std::vector<float>&start = fall.m_frames[std::size_t(i)], &end = fall.m_frames[std::size_t(i) + 1];
        setMotion(*pipeline, cloth, start, end);
        pipeline->addPair(cloth, obstacle, fall.m_step.m_thickness);
        const std::vector<Contact> expected = runStep(*pipeline);
        TreeStepResult result;
        EXPECT_TRUE(step.run(start.data(), end.data(), result));
        EXPECT_TRUE(sameBytes(result.m_contacts, expected)) << difference(result.m_contacts, expected);
        candidates += result.m_candidates;
        contacts += expected.size();
    }
    EXPECT_GT(contacts, 1000u);
    return candidates;
}

TreeScene sceneOf(const Fall& fall, TreeBuilder builder)
{
    TreeMethods methods;
    methods.m_builder = builder;
    return TreeScene({fall.m_step.m_cloth}, fall.m_step.m_obstacle, methods, fall.m_step.m_thickness,
                     1.0f + Settings().m_activation);
}
}  // namespace

class TreeStepTest : public DeviceTest
{
};

TEST_P(TreeStepTest, ContactsAreThePipelinesWithEveryTraversalAndBuilder)
{
    const Fall fall;
    std::set<std::size_t> candidates;
    for (const TreeBuilder builder : {TreeBuilder::Radix, TreeBuilder::Ploc})
    {
        for (const Traversal traversal : allTraversals())
        {
            SCOPED_TRACE(std::string(traversalName(traversal)) + ", builder " + std::to_string(int(builder)));
            TreeScene scene = sceneOf(fall, builder);
            Methods methods;
            methods.m_traversal = traversal;
            methods.m_tree.m_builder = builder;
            HostTreeStep onHost(scene, traversal);
            DeviceTreeStep onDevice(*m_device, scene, methods, "none");
            candidates.insert(expectPipelinesContacts(onHost, fall));
            candidates.insert(expectPipelinesContacts(onDevice, fall));
        }
    }
    EXPECT_EQ(candidates.size(), 1u) << "every method finds the same pairs";
}

INSTANTIATE_TEST_SUITE_P(Devices, TreeStepTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
