// The pipeline as a caller sees it: views, pairs, refit against rebuild, contacts that are consistent in themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/oracle.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"

namespace drape::test
{
class PipelineTest : public BackendTest
{
protected:
    std::unique_ptr<Pipeline> make() { return makePipeline(GetParam().m_settings); }
};

// A contact's own data are consistent: weights, gaps and point give the nodes' positions.
TEST_P(PipelineTest, ContactsAreConsistent)
{
    for (const StepCase& step : {fallingCase("bowl", 24, 0.03f, 700), soupCase(200, 200, true, 701)})
    {
        SCOPED_TRACE(step.trace());
        const std::unique_ptr<Pipeline> pipeline = make();
        ASSERT_TRUE(pipeline);
        const std::vector<Contact> contacts = runCase(*pipeline, step);
        EXPECT_GT(contacts.size(), 100u);
        for (const Contact& contact : contacts)
        {
            const ContactView view = pipeline->view(contact);
            const Vector3 normal = {view.m_normal[0], view.m_normal[1], view.m_normal[2]};
            const Vector3 point = {view.m_point[0], view.m_point[1], view.m_point[2]};
            Vector3 start, end;
            double sum = 0;
            for (int i = 0; i < 3; ++i)
            {
                if (view.m_nodes[i] < 0)
                {
                    EXPECT_EQ(view.m_weights[i], 0.0f);
                    continue;
                }
                EXPECT_GE(view.m_weights[i], 0.0f);
                sum += view.m_weights[i];
                start += double(view.m_weights[i]) * position(step.m_cloth.m_positions, std::uint32_t(view.m_nodes[i]));
                end += double(view.m_weights[i]) * position(step.m_end, std::uint32_t(view.m_nodes[i]));
            }
            EXPECT_NEAR(sum, 1.0, 1e-6);
            EXPECT_NEAR(length(normal), 1.0, 1e-6);
            EXPECT_NEAR(dot(normal, start - point), view.m_gap0, 2e-6) << describe(contact);
            EXPECT_NEAR(dot(normal, end - point), view.m_gap1, 2e-6) << describe(contact);
            EXPECT_TRUE(view.m_time >= 0 && view.m_time <= 1);
        }
    }
}

TEST_P(PipelineTest, ContactsComeInCanonicalOrderAndOnce)
{
    const std::unique_ptr<Pipeline> pipeline = make();
    ASSERT_TRUE(pipeline);
    const StepCase step = fallingCase("torus", 24, 0.03f, 702);
    SCOPED_TRACE(step.trace());
    const std::vector<Contact> contacts = runCase(*pipeline, step);
    ASSERT_GT(contacts.size(), 100u);
    for (std::size_t i = 1; i < contacts.size(); ++i)
    {
        const Contact &a = contacts[i - 1], &b = contacts[i];
        ASSERT_TRUE(a.m_featureIndex < b.m_featureIndex ||
                    (a.m_featureIndex == b.m_featureIndex && a.m_obstacleFeature < b.m_obstacleFeature));
        ASSERT_LE(a.m_kind, b.m_kind);
    }
    EXPECT_EQ(pipeline->statistics().m_contacts, contacts.size());
    EXPECT_GE(pipeline->statistics().m_candidates, contacts.size() / 15);
    EXPECT_EQ(pipeline->statistics().m_status, std::uint32_t(kStepGood));
}

namespace
{
// Numbers differ by what stands before in the joined arrays; all else must be the same.
std::vector<Contact> withoutNumbers(std::vector<Contact> contacts)
{
    for (Contact& contact : contacts)
        contact.m_featureIndex = contact.m_clothFeature = contact.m_obstacleFeature = 0;
    return contacts;
}

std::vector<Contact> contactsOfPair(const Pipeline& pipeline, const std::vector<Contact>& all, MeshId cloth,
                                    MeshId obstacle, float thickness)
{
    std::vector<Contact> found;
    for (const Contact& contact : all)
    {
        const ContactView view = pipeline.view(contact);
        if (view.m_cloth != cloth || view.m_obstacle != obstacle) continue;
        EXPECT_EQ(view.m_thickness, thickness);
        found.push_back(contact);
    }
    return found;
}
}  // namespace

// Each pair of several alone gives what it gives among the others. The last cloth has no pair, the first has two.
// Contacts stand until the next step: what they name, too, when it has gone since, or something has come.
TEST_P(PipelineTest, ContactsOfTheLastStepOutliveTheirMeshes)
{
    const StepCase step = fallingCase("bowl", 24, 0.03f, 703);
    SCOPED_TRACE(step.trace());
    const std::unique_ptr<Pipeline> pipeline = make();
    ASSERT_TRUE(pipeline);
    const MeshId obstacle = addObstacle(*pipeline, step.m_obstacle);
    const MeshId cloths[] = {addCloth(*pipeline, makeSphere(0.1f, 4)), addCloth(*pipeline, step.m_cloth),
                             addCloth(*pipeline, step.m_cloth)};
    for (int i = 1; i < 3; ++i)
    {
        setMotion(*pipeline, cloths[i], step.m_cloth.m_positions, step.m_end);
        pipeline->addPair(cloths[i], obstacle, step.m_thickness);
    }
    const std::vector<Contact> contacts = runStep(*pipeline);
    EXPECT_GT(contacts.size(), 200u);
    const auto views = [&]
    {
        std::vector<std::uint64_t> named;
        for (const Contact& contact : contacts)
        {
            const ContactView view = pipeline->view(contact);
            named.insert(named.end(), {view.m_cloth, view.m_obstacle, std::uint64_t(view.m_triangle),
                                       std::uint64_t(view.m_nodes[0]), std::uint64_t(view.m_nodes[2])});
            EXPECT_EQ(view.m_thickness, step.m_thickness);
        }
        return named;
    };
    const std::vector<std::uint64_t> before = views();
    pipeline->remove(cloths[0]);
    EXPECT_EQ(views(), before);
    pipeline->remove(cloths[2]);
    addCloth(*pipeline, step.m_cloth);
    EXPECT_EQ(views(), before);
    pipeline->remove(cloths[1]);
    pipeline->remove(obstacle);
    EXPECT_EQ(views(), before);
}

TEST_P(PipelineTest, PairsAreIndependent)
{
    const std::unique_ptr<Pipeline> together = make();
    ASSERT_TRUE(together);
    const std::vector<StepCase> cases = {fallingCase("sphere", 12, 0.03f, 710), fallingCase("torus", 14, 0.02f, 711),
                                         fallingCase("box", 10, 0.04f, 712)};
    std::vector<MeshId> cloths, obstacles;
    for (const StepCase& step : cases)
    {
        cloths.push_back(addCloth(*together, step.m_cloth));
        obstacles.push_back(addObstacle(*together, step.m_obstacle));
    }
    for (std::size_t i = 0; i < cases.size(); ++i)
    {
        setMotion(*together, cloths[i], cases[i].m_cloth.m_positions, cases[i].m_end);
    }
    const struct
    {
        std::size_t m_cloth, m_obstacle;
        float m_thickness;
    } pairs[] = {{0, 0, 0.01f}, {0, 1, 0.02f}, {1, 1, 0.03f}};
    for (const auto& pair : pairs)
        together->addPair(cloths[pair.m_cloth], obstacles[pair.m_obstacle], pair.m_thickness);
    const std::vector<Contact> all = runStep(*together);
    std::size_t matched = 0;
    for (const auto& pair : pairs)
    {
        StepCase alone = cases[pair.m_cloth];
        SCOPED_TRACE(alone.trace() + ", with the obstacle of: " + cases[pair.m_obstacle].trace());
        alone.m_obstacle = cases[pair.m_obstacle].m_obstacle;
        alone.m_thickness = pair.m_thickness;
        const std::unique_ptr<Pipeline> single = make();
        ASSERT_TRUE(single);
        const std::vector<Contact> expected = withoutNumbers(runCase(*single, alone));
        const std::vector<Contact> found = withoutNumbers(
            contactsOfPair(*together, all, cloths[pair.m_cloth], obstacles[pair.m_obstacle], pair.m_thickness));
        EXPECT_FALSE(expected.empty());
        EXPECT_TRUE(sameBytes(found, expected)) << difference(found, expected);
        matched += found.size();
    }
    EXPECT_EQ(matched, all.size());
}

// A hierarchy that was built long ago and refitted gives the contacts of a new one.
TEST_P(PipelineTest, RefitEqualsRebuild)
{
    const std::unique_ptr<Pipeline> old = make();
    ASSERT_TRUE(old);
    const StepCase first = fallingCase("sphere", 16, 0.03f, 720);
    const MeshId cloth = addCloth(*old, first.m_cloth), obstacle = addObstacle(*old, first.m_obstacle);
    Random random(721);
    for (int step = 0; step < 5; ++step)
    {
        StepCase now = first;
        now.m_seed = std::uint32_t(721 + step);
        SCOPED_TRACE(now.trace());
        translate(now.m_obstacle.m_positions, random.uniform(-0.2f, 0.2f), random.uniform(-0.05f, 0.05f),
                  random.uniform(-0.2f, 0.2f));
        disturb(now.m_obstacle.m_positions, 0.01f, random);
        disturb(now.m_cloth.m_positions, 0.05f, random);
        disturb(now.m_end, 0.05f, random);
        old->moveObstacle(obstacle, now.m_obstacle.m_positions.data());
        setMotion(*old, cloth, now.m_cloth.m_positions, now.m_end);
        old->addPair(cloth, obstacle, now.m_thickness);
        const std::vector<Contact> refitted = runStep(*old);
        const std::unique_ptr<Pipeline> fresh = make();
        ASSERT_TRUE(fresh);
        const std::vector<Contact> rebuilt = runCase(*fresh, now);
        EXPECT_TRUE(sameBytes(refitted, rebuilt)) << difference(refitted, rebuilt);
        EXPECT_GT(rebuilt.size(), 50u);
    }
}

namespace
{
// Two equal cloths over a bowl, with more nodes than go to a device together.
class TwoCloths
{
public:
    using Tell = std::function<void(MeshId, std::size_t)>;

    explicit TwoCloths(Pipeline& pipeline)
        : m_pipeline(pipeline),
          m_step(fallingCase("bowl", onHost() ? 40 : 370, 0.01f, 703)),
          m_nodes(m_step.m_end.size() / 3),
          m_first(addCloth(pipeline, m_step.m_cloth)),
          m_second(addCloth(pipeline, m_step.m_cloth)),
          m_obstacle(addObstacle(pipeline, m_step.m_obstacle))
    {
    }

    bool onHost() const { return m_pipeline.deviceReport().m_onHost; }  // has nowhere to send them, and would take long
    const std::vector<float>& start() const { return m_step.m_cloth.m_positions; }
    const std::vector<float>& end() const { return m_step.m_end; }

    // Fills nodes that are still to be written with a wrong value.
    void spoil(float* nodes) { std::fill_n(nodes, 3 * m_nodes, 1e3f); }
    void addPair(MeshId cloth) { m_pipeline.addPair(cloth, m_obstacle, m_step.m_thickness); }

    // Runs a step whose nodes are written a seventh at a time, with a notice each time.
    std::vector<Contact> run(const std::vector<MeshId>& cloths, const Tell& written)
    {
        for (const MeshId cloth : cloths)
        {
            spoil(m_pipeline.clothStart(cloth));
            spoil(m_pipeline.clothEnd(cloth));
        }
        for (const MeshId cloth : cloths)
        {
            for (std::size_t from = 0, to; from < m_nodes; from = to)
            {
                to = std::min(from + m_nodes / 7, m_nodes);
                std::copy(&start()[3 * from], &start()[0] + 3 * to, m_pipeline.clothStart(cloth) + 3 * from);
                std::copy(&end()[3 * from], &end()[0] + 3 * to, m_pipeline.clothEnd(cloth) + 3 * from);
                written(cloth, to);
            }
            addPair(cloth);
        }
        return runStep(m_pipeline);
    }
    std::vector<Contact> runSilently(const std::vector<MeshId>& cloths)
    {
        return run(cloths, [](MeshId, std::size_t) {});
    }

    Pipeline& m_pipeline;
    const StepCase m_step;
    const std::size_t m_nodes;
    const MeshId m_first, m_second, m_obstacle;
};

void expectSame(const std::vector<Contact>& found, const std::vector<Contact>& expected)
{
    EXPECT_TRUE(sameBytes(found, expected)) << difference(found, expected);
}
}  // namespace

// Two cloths whose contacts are known from nodes that were written without a notice.
class PipelineNodesTest : public PipelineTest
{
protected:
    void SetUp() override
    {
        m_pipeline = make();
        ASSERT_TRUE(m_pipeline);
        m_two = std::make_unique<TwoCloths>(*m_pipeline);
        ASSERT_TRUE(m_two->onHost() || m_two->m_nodes > std::size_t(1) << 17);
        m_expected = m_two->runSilently({m_two->m_first, m_two->m_second});
        ASSERT_GT(m_expected.size(), 500u);
    }

    std::unique_ptr<Pipeline> m_pipeline;
    std::unique_ptr<TwoCloths> m_two;
    std::vector<Contact> m_expected;
};

// The notices come in parts, for a part, in the wrong order or not at all.
TEST_P(PipelineNodesTest, NodesMayGoBeforeAllAreWritten)
{
    TwoCloths& two = *m_two;
    const MeshId first = two.m_first, second = two.m_second;
    const auto told = [&](MeshId cloth, std::size_t count) { m_pipeline->nodesWritten(cloth, count); };
    const auto halfTold = [&](MeshId cloth, std::size_t count) { told(cloth, count / 2); };
    expectSame(two.run({first, second}, told), m_expected);
    expectSame(two.run({second, first}, told), m_expected);
    expectSame(two.run({first, second}, halfTold), m_expected);
    // The notice comes before the cloth is removed.
    m_pipeline->nodesWritten(first, two.m_nodes);
    m_pipeline->remove(second);
    expectSame(two.run({first}, told), two.runSilently({first}));
}

// The position of a removed cloth stays, and nobody writes its nodes.
TEST_P(PipelineNodesTest, NodesBehindAClothThatHasGoneMayGo)
{
    const auto told = [&](MeshId cloth, std::size_t count) { m_pipeline->nodesWritten(cloth, count); };
    m_pipeline->remove(m_two->m_first);
    const std::vector<Contact> expected = m_two->runSilently({m_two->m_second});
    ASSERT_GT(expected.size(), 500u);
    expectSame(m_two->run({m_two->m_second}, told), expected);
}

// The cloths are written one after the other, or both at once.
TEST_P(PipelineNodesTest, NodesThatAreCopiedAreThoseThatAreWritten)
{
    TwoCloths& two = *m_two;
    const MeshId first = two.m_first, second = two.m_second;
    for (const MeshId cloth : {first, second})
    {
        two.spoil(m_pipeline->clothStart(cloth));
        two.spoil(m_pipeline->clothEnd(cloth));
        m_pipeline->copyNodes({cloth}, two.start().data(), two.end().data());
        two.addPair(cloth);
    }
    expectSame(runStep(*m_pipeline), m_expected);
    std::vector<float> bothStart = two.start(), bothEnd = two.end();
    bothStart.insert(bothStart.end(), two.start().begin(), two.start().end());
    bothEnd.insert(bothEnd.end(), two.end().begin(), two.end().end());
    for (const MeshId cloth : {first, second})
        two.addPair(cloth);
    two.spoil(m_pipeline->clothStart(second));
    two.spoil(m_pipeline->clothEnd(first));
    m_pipeline->copyNodes({first, second}, bothStart.data(), bothEnd.data());
    expectSame(runStep(*m_pipeline), m_expected);
}

// A device runs few tests with another kernel once a step has shown that they are few.
TEST_P(PipelineTest, FewTestsGiveTheSameContacts)
{
    std::size_t swept = 0, contacts = 0;
    for (std::uint32_t seed = 740; seed < 784; ++seed)
    {
        const std::unique_ptr<Pipeline> pipeline = make();
        ASSERT_TRUE(pipeline);
        const StepCase step = seed % 2 ? soupCase(10, 40, true, seed) : fallingCase("box", 5, 0.03f, seed);
        SCOPED_TRACE(step.trace());
        const MeshId cloth = addCloth(*pipeline, step.m_cloth), obstacle = addObstacle(*pipeline, step.m_obstacle);
        const auto run = [&]
        {
            pipeline->copyNodes({cloth}, step.m_cloth.m_positions.data(), step.m_end.data());
            pipeline->addPair(cloth, obstacle, step.m_thickness);
            return runStep(*pipeline);
        };
        const std::vector<Contact> first = run();
        const std::size_t sweptFirst = pipeline->statistics().m_sweptTests;
        const std::vector<Contact> second = run();
        EXPECT_TRUE(sameBytes(second, first)) << difference(second, first);
        EXPECT_EQ(pipeline->statistics().m_sweptTests, sweptFirst);
        if (!pipeline->deviceReport().m_onHost)
        {
            EXPECT_LE(pipeline->statistics().m_candidates, 256u) << "few, with two compute units";
        }
        swept += sweptFirst;
        contacts += second.size();
    }
    EXPECT_GT(swept, 500u);
    EXPECT_GT(contacts, 300u);
}

TEST_P(PipelineTest, StepsWithoutPairsAreSkipped)
{
    const std::unique_ptr<Pipeline> pipeline = make();
    ASSERT_TRUE(pipeline);
    EXPECT_TRUE(runStep(*pipeline).empty());
    EXPECT_TRUE(pipeline->statistics().m_skipped);
    const StepCase step = fallingCase("box", 12, 0.03f, 730);
    SCOPED_TRACE(step.trace());
    EXPECT_FALSE(runCase(*pipeline, step).empty());
    EXPECT_FALSE(pipeline->statistics().m_skipped);
    EXPECT_TRUE(runStep(*pipeline).empty()) << "pairs are named anew for each step";
    EXPECT_TRUE(pipeline->statistics().m_skipped);
}

TEST_P(PipelineTest, SourceTrianglesSurviveDroppedOnes)
{
    const std::unique_ptr<Pipeline> pipeline = make();
    ASSERT_TRUE(pipeline);
    StepCase step = fallingCase("box", 12, 0.03f, 740);
    SCOPED_TRACE(step.trace());
    // Triangles that repeat an index, in front and between: they are ignored, and the numbers given stay those given.
    std::vector<std::int32_t> triangles = {0, 0, 1};
    for (std::size_t i = 0; i < step.m_cloth.m_triangles.size(); i += 3)
    {
        triangles.insert(triangles.end(), &step.m_cloth.m_triangles[i], &step.m_cloth.m_triangles[i] + 3);
        if (i % 9 == 0) triangles.insert(triangles.end(), {3, 4, 3});
    }
    step.m_cloth.m_triangles = triangles;
    const std::vector<Contact> contacts = runCase(*pipeline, step);
    ASSERT_FALSE(contacts.empty());
    for (const Contact& contact : contacts)
    {
        const ContactView view = pipeline->view(contact);
        ASSERT_TRUE(view.m_triangle >= 0 && std::size_t(view.m_triangle) < step.m_cloth.triangleCount());
        const std::int32_t* corners = &triangles[3 * std::size_t(view.m_triangle)];
        for (std::int32_t node : view.m_nodes)
        {
            EXPECT_TRUE(node < 0 || std::find(corners, corners + 3, node) != corners + 3) << describe(contact);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, PipelineTest, testing::ValuesIn(allBackends()), backendName);
INSTANTIATE_TEST_SUITE_P(Backends, PipelineNodesTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
