// Thin triangles: the same contacts on every back end by every way to find pairs.
#include <gtest/gtest.h>

#include "tests/support/backends.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"
#include "tests/support/traversals.h"

namespace drape::test
{
class NeedlesOnBackends : public BackendTest
{
};

TEST_P(NeedlesOnBackends, SameContactsByEveryTraversal)
{
    Settings host;
    host.m_backend = Backend::Host;
    std::vector<Traversal> traversals = allTraversals();
    traversals.insert(traversals.begin(), Traversal::Auto);
    for (const ContactMode mode : {ContactMode::Discrete, ContactMode::Continuous, ContactMode::Automatic})
    {
        for (std::uint32_t seed = 550; seed < 556; ++seed)
        {
            const StepCase step = needleCase(Thin(seed % 3), 60, 1.0f, seed % 2 == 0, seed);
            host.m_mode = mode;
            const std::unique_ptr<Pipeline> reference = makePipeline(host);
            ASSERT_TRUE(reference);
            const std::vector<Contact> expected = runCase(*reference, step);
            EXPECT_GT(expected.size(), 100u);
            for (const Traversal traversal : traversals)
            {
                SCOPED_TRACE(step.trace() + ", " + traversalName(traversal) + ", mode " + std::to_string(int(mode)));
                Settings settings = GetParam().m_settings;
                settings.m_mode = mode;
                settings.m_methods.m_traversal = traversal;
                const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
                ASSERT_TRUE(pipeline);
                const std::vector<Contact> contacts = runCase(*pipeline, step);
                EXPECT_TRUE(sameBytes(contacts, expected)) << difference(contacts, expected);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, NeedlesOnBackends, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
