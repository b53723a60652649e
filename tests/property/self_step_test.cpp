// Cloths that collide with themselves in a step: every back end and mode gives the contacts of all pairs, and what a
// scene does not ask for changes nothing.
#include <gtest/gtest.h>

#include <cstring>

#include "scenes/describe_mesh.h"
#include "scenes/shapes.h"
#include "reference/self_pairs.h"
#include "tests/support/backends.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/self_cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
struct SelfResult
{
    std::vector<Contact> m_contacts, m_self;
    StepStatistics m_statistics;
};

std::vector<Contact> listed(ContactList contacts)
{
    return {contacts.begin(), contacts.end()};
}

// Runs the folded cloth over a sphere that it touches.
SelfResult runOverSphere(const Settings& settings, const SelfStepCase& step, bool self)
{
    SelfResult result;
    const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
    if (!pipeline) return result;
    TriangleMesh sphere = makeSphere(0.4f, 3);
    translate(sphere.m_positions, 0.1f, -0.4f - 0.5f * step.m_thickness, 0.0f);
    MeshDescription description = describeMesh(step.m_motion.m_mesh);
    description.m_selfThickness = self ? step.m_thickness : 0.0f;
    description.m_restPositions = step.m_rest.data();
    const MeshId cloth = pipeline->addCloth(description), obstacle = addObstacle(*pipeline, sphere);
    setMotion(*pipeline, cloth, step.m_motion.m_mesh.m_positions, step.m_motion.m_end);
    pipeline->addPair(cloth, obstacle, 0.03f);
    if (self) pipeline->addSelf(cloth);
    pipeline->submit();
    result.m_contacts = listed(pipeline->finish());
    result.m_self = listed(pipeline->selfContacts());
    result.m_statistics = pipeline->statistics();
    return result;
}

// Results of a comparison of all pairs, which shares no cull with the tested code.
struct Expected
{
    std::vector<Contact> m_contacts;
    SelfCounts m_counts;
};

Expected expectedOf(const SelfStepCase& step, const Settings& settings)
{
    Side side = makeSide({step.m_motion.m_mesh});
    side.m_end = step.m_motion.m_end;
    ClothView cloth = side.cloth();
    cloth.m_mode = std::uint32_t(settings.m_mode);
    const float reachScale = 1.0f + settings.m_activation;
    const SelfReach reach = {{step.m_thickness}, {selfGrowth(step.m_thickness * reachScale)}};
    const std::vector<float> noObstacle = {-1.0f};
    Expected expected;
    expected.m_counts = HostSelfTrees().run(
        {side.m_pool, selfView(cloth, step.m_rest.data(), reachScale), reach, noObstacle}, {}, expected.m_contacts);
    return expected;
}
}  // namespace

class SelfStepTest : public BackendTest
{
};

TEST_P(SelfStepTest, EveryBackEndFindsTheSame)
{
    std::size_t contacts = 0, swept = 0;
    for (const ContactMode mode : {ContactMode::Automatic, ContactMode::Continuous, ContactMode::Discrete})
    {
        for (const SelfStepCase& step : selfStepCases())
        {
            SCOPED_TRACE(step.m_motion.m_name + ", mode " + std::to_string(int(mode)));
            Settings settings = GetParam().m_settings;
            settings.m_mode = mode;
            const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
            ASSERT_TRUE(pipeline);
            const std::vector<Contact> found = runSelfCase(*pipeline, step);
            const Expected expected = expectedOf(step, settings);
            const StepStatistics& statistics = pipeline->statistics();
            EXPECT_TRUE(sameBytes(found, expected.m_contacts)) << difference(found, expected.m_contacts);
            EXPECT_EQ(statistics.m_selfCandidates, expected.m_counts.m_candidates);
            EXPECT_EQ(statistics.m_selfSweptTests, expected.m_counts.m_swept);
            EXPECT_EQ(statistics.m_invalidNodes, expected.m_counts.m_invalidNodes);
            EXPECT_EQ(statistics.m_status,
                      std::uint32_t(statistics.m_invalidNodes > 0 ? kStepInvalidNodes : kStepGood));
            EXPECT_EQ(pipeline->statistics().m_contacts, 0u);
            contacts += found.size();
            swept += expected.m_counts.m_swept;
            for (std::size_t i = 1; i < found.size(); ++i)
            {
                EXPECT_TRUE(found[i - 1].m_featureIndex < found[i].m_featureIndex ||
                            (found[i - 1].m_featureIndex == found[i].m_featureIndex &&
                             found[i - 1].m_obstacleFeature < found[i].m_obstacleFeature));
            }
        }
    }
    EXPECT_GT(contacts, 10000u);
    EXPECT_GT(swept, 10000u);
}

TEST_P(SelfStepTest, AutomaticGivesTheContactsOfContinuous)
{
    for (const SelfStepCase& step : selfStepCases())
    {
        SCOPED_TRACE(step.m_motion.m_name);
        Settings automatic = GetParam().m_settings, continuous = GetParam().m_settings;
        automatic.m_mode = ContactMode::Automatic;
        continuous.m_mode = ContactMode::Continuous;
        const std::unique_ptr<Pipeline> first = makePipeline(automatic), second = makePipeline(continuous);
        ASSERT_TRUE(first && second);
        const std::vector<Contact> a = runSelfCase(*first, step), b = runSelfCase(*second, step);
        EXPECT_TRUE(sameBytes(a, b)) << difference(a, b);
        EXPECT_LE(first->statistics().m_selfSweptTests, second->statistics().m_selfSweptTests);
    }
}

TEST_P(SelfStepTest, ContactsWithObstaclesStayWhatTheyAre)
{
    const SelfStepCase step = foldedCase(25, 4, 0.003f, 120);
    const SelfResult host = runOverSphere(allBackends()[0].m_settings, step, true);
    const Settings& settings = GetParam().m_settings;
    const Expected self = expectedOf(step, settings);
    const SelfResult with = runOverSphere(settings, step, true), without = runOverSphere(settings, step, false);
    EXPECT_TRUE(sameBytes(with.m_contacts, without.m_contacts)) << difference(with.m_contacts, without.m_contacts);
    EXPECT_TRUE(sameBytes(with.m_contacts, host.m_contacts)) << difference(with.m_contacts, host.m_contacts);
    EXPECT_TRUE(sameBytes(with.m_self, self.m_contacts)) << difference(with.m_self, self.m_contacts);
    EXPECT_GT(with.m_contacts.size(), 50u);
    EXPECT_GT(with.m_self.size(), 500u);
    EXPECT_EQ(with.m_statistics.m_contacts, with.m_contacts.size());
    EXPECT_EQ(with.m_statistics.m_selfContacts, with.m_self.size());
    EXPECT_TRUE(without.m_self.empty());
    EXPECT_EQ(without.m_statistics.m_selfCandidates, 0u);
}

// The lists start smaller than this cloth needs.
TEST_P(SelfStepTest, ListsGrowToWhatIsThere)
{
    const SelfStepCase step = {crumpledCase(70, 121), crumpledCase(70, 121).m_mesh.m_positions, 0.01f};
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    const std::vector<Contact> found = runSelfCase(*pipeline, step),
                               expected = expectedOf(step, GetParam().m_settings).m_contacts;
    EXPECT_TRUE(sameBytes(found, expected)) << difference(found, expected);
    EXPECT_GT(pipeline->statistics().m_selfCandidates, std::size_t(1) << 16);
    EXPECT_GT(pipeline->statistics().m_retries, 0u);
}

TEST_P(SelfStepTest, AClothOfLooseNodesIsPrepared)
{
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    SelfStepCase loose = foldedCase(13, 3, 0.0f, 124);
    loose.m_motion.m_mesh.m_triangles.clear();
    addSelfCloth(*pipeline, loose);
    pipeline->prepare();
    pipeline->submit();
    pipeline->finish();
    EXPECT_TRUE(listed(pipeline->selfContacts()).empty());
    EXPECT_GT(runSelfCase(*pipeline, foldedCase(13, 3, 0.0f, 124)).size(), 100u);
}

TEST_P(SelfStepTest, TooManyLeaveTheClothOut)
{
    const SelfStepCase large = {crumpledCase(30, 122), crumpledCase(30, 122).m_mesh.m_positions, 0.03f};
    const SelfStepCase small = foldedCase(13, 3, 0.0f, 123);
    for (const bool contacts : {false, true})
    {
        Settings settings = GetParam().m_settings;
        (contacts ? settings.m_contactLimit : settings.m_candidateLimit) = contacts ? 4000 : 20000;
        const std::unique_ptr<Pipeline> pipeline = makePipeline(settings), alone = makePipeline(settings);
        ASSERT_TRUE(pipeline && alone);
        addSelfCloth(*pipeline, large);
        // Adding a cloth resets the nodes of the others.
        const MeshId second = addSelfCloth(*pipeline, small);
        setMotion(*pipeline, second - 1, large.m_motion.m_mesh.m_positions, large.m_motion.m_end);
        pipeline->submit();
        pipeline->finish();
        const std::vector<Contact> found = listed(pipeline->selfContacts()), expected = runSelfCase(*alone, small);
        EXPECT_TRUE(pipeline->statistics().m_status & kStepClothsLeftOut);
        EXPECT_EQ(pipeline->statistics().m_clothsLeftOut, 1u);
        ASSERT_EQ(found.size(), expected.size());
        EXPECT_GT(found.size(), 100u);
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_EQ(std::memcmp(found[i].m_normal, expected[i].m_normal, sizeof(Contact) - 16), 0) << i;
    }
}

// Cloths that lie in one another touch themselves only.
TEST_P(SelfStepTest, ClothsDoNotMeetOneAnother)
{
    const SelfStepCase step = foldedCase(13, 3, 0.003f, 124);
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings),
                                    alone = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline && alone);
    const MeshId first = addSelfCloth(*pipeline, step), second = addSelfCloth(*pipeline, step);
    setMotion(*pipeline, first, step.m_motion.m_mesh.m_positions, step.m_motion.m_end);
    pipeline->submit();
    pipeline->finish();
    const std::vector<Contact> found = listed(pipeline->selfContacts()), expected = runSelfCase(*alone, step);
    std::size_t counts[2] = {0, 0};
    for (const Contact& contact : found)
    {
        const SelfContactView view = pipeline->viewSelf(contact);
        ++counts[view.m_cloth == second];
        float sums[2] = {0, 0};
        for (int i = 0; i < 4; ++i)
        {
            EXPECT_TRUE(view.m_nodes[i] >= 0 && view.m_nodes[i] < 169);
            sums[i < (view.m_kind == DRAPE_SELF_EDGE_EDGE ? 2 : 1) ? 0 : 1] += view.m_weights[i];
        }
        EXPECT_NEAR(sums[0], 1.0f, 1e-6f);
        EXPECT_NEAR(sums[1], 1.0f, 1e-6f);
        EXPECT_TRUE(view.m_thickness > 0.0f && view.m_thickness <= step.m_thickness);
    }
    EXPECT_EQ(counts[0], expected.size());
    EXPECT_EQ(counts[1], expected.size());
    EXPECT_GT(expected.size(), 100u);
}

// A cloth with self-collision that is not named costs nothing, and one that is flat at rest has no contacts.
TEST_P(SelfStepTest, ClothsThatAreNotNamedAndFlatOnes)
{
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    SelfStepCase flat = foldedCase(13, 1, 0.0f, 125);
    flat.m_motion.m_mesh.m_positions = flat.m_motion.m_end = flat.m_rest;
    flat.m_thickness = 0.5f;  // six cells: nearer than much of the cloth at rest
    EXPECT_TRUE(runSelfCase(*pipeline, flat).empty());
    EXPECT_GT(pipeline->statistics().m_selfCandidates, 1000u);
    EXPECT_FALSE(pipeline->statistics().m_skipped);
    pipeline->submit();
    pipeline->finish();
    EXPECT_TRUE(pipeline->statistics().m_skipped);
    EXPECT_EQ(pipeline->selfContacts().size(), 0u);
    EXPECT_EQ(pipeline->statistics().m_selfCandidates, 0u);
}

INSTANTIATE_TEST_SUITE_P(Backends, SelfStepTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
