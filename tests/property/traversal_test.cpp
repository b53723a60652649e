// The traversal is a choice of time: contacts are the same, bit for bit, with every one and with a front kept from step
// to step, under random motion, teleports and meshes that come and go.
#include <gtest/gtest.h>

#include <set>

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

    // Steps in which the cloth moves on a straight way to `end`, with rebuilds and without: the same contacts, and
    // fewer volume tests with rebuilds where there are to be any.
    void expectRebuilds(const StepCase& step, const std::vector<float>& end, Traversal traversal, bool expected)
    {
        constexpr int kSteps = 60;
        std::vector<std::unique_ptr<Pipeline>> pipelines;
        std::vector<MeshId> cloths, obstacles;
        for (const float decay : {Methods().m_rebuildDecay, 0.0f})
        {
            Settings settings = GetParam().m_settings;
            settings.m_methods.m_traversal = traversal;
            settings.m_methods.m_rebuildDecay = decay;
            settings.m_methods.m_countTests = true;
            pipelines.push_back(makePipeline(settings));
            ASSERT_TRUE(pipelines.back());
            cloths.push_back(addCloth(*pipelines.back(), step.m_cloth));
            obstacles.push_back(addObstacle(*pipelines.back(), step.m_obstacle));
        }
        std::size_t rebuilds[2] = {0, 0}, tests[2] = {0, 0};
        for (int i = 0; i < kSteps; ++i)
        {
            SCOPED_TRACE("step " + std::to_string(i));
            std::vector<float> positions = step.m_cloth.m_positions;
            for (std::size_t k = 0; k < positions.size(); ++k)
                positions[k] += float(i) / kSteps * (end[k] - positions[k]);
            std::vector<Contact> contacts[2];
            for (std::size_t p = 0; p < 2; ++p)
            {
                setMotion(*pipelines[p], cloths[p], positions, positions);
                pipelines[p]->addPair(cloths[p], obstacles[p], step.m_thickness);
                contacts[p] = runStep(*pipelines[p]);
                pipelines[p]->waitForRebuild();  // or the machine's load would decide which steps use it
                rebuilds[p] += pipelines[p]->statistics().m_rebuilds;
                tests[p] += pipelines[p]->statistics().m_volumeTests;
            }
            ASSERT_TRUE(sameBytes(contacts[0], contacts[1])) << difference(contacts[0], contacts[1]);
            EXPECT_FALSE(contacts[0].empty());
        }
        EXPECT_EQ(rebuilds[0] > 0, expected);
        EXPECT_EQ(rebuilds[1], 0u) << "never";
        EXPECT_EQ(tests[0] < tests[1], expected);
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

// The builder and its settings are a choice of time, too: the same contacts from the same candidates with every one, by
// other volume tests.
TEST_P(TraversalTest, ContactsAreTheSameInTreesOfEveryBuilder)
{
    std::vector<TreeMethods> trees;
    const auto add = [&](TreeBuilder builder) -> TreeMethods&
    {
        trees.emplace_back().m_builder = builder;
        return trees.back();
    };
    for (TreeBuilder builder : {TreeBuilder::Balanced, TreeBuilder::Radix, TreeBuilder::TopDown, TreeBuilder::Ploc})
        add(builder);
    add(TreeBuilder::TopDown).m_topDown.m_medianSplit = true;
    TreeMethods& largeLeaves = add(TreeBuilder::TopDown);
    largeLeaves.m_topDown.m_medianSplit = true;
    largeLeaves.m_topDown.m_leafSize = 1000;
    add(TreeBuilder::Ploc).m_plocRadius = 1;
    add(TreeBuilder::Balanced).m_mortonBits = 63;
    std::size_t contacts = 0;
    for (const Traversal traversal : allTraversals())
    {
        std::vector<std::unique_ptr<Pipeline>> owned;
        std::vector<Pipeline*> pipelines;
        for (const TreeMethods& tree : trees)
        {
            Settings settings = GetParam().m_settings;
            settings.m_methods.m_traversal = traversal;
            settings.m_methods.m_tree = tree;
            settings.m_methods.m_rebuildDecay = 1.05f;
            settings.m_methods.m_countTests = true;
            owned.push_back(makePipeline(settings));
            ASSERT_TRUE(owned.back());
            pipelines.push_back(owned.back().get());
        }
        std::vector<std::size_t> tests(pipelines.size(), 0);
        const std::uint32_t seed = 960 + std::uint32_t(traversal);
        LiveScene scene(pipelines, seed, true);
        for (int step = 0; step < 60; ++step)
        {
            scene.nextStep();
            std::vector<Contact> first;
            for (std::size_t i = 0; i < pipelines.size(); ++i)
            {
                SCOPED_TRACE("seed " + std::to_string(seed) + ", " + traversalName(traversal) + ", step " +
                             std::to_string(step) + ", builder " + std::to_string(i));
                const std::vector<Contact> found = runStep(*pipelines[i]);
                tests[i] += pipelines[i]->statistics().m_volumeTests;
                if (i == 0) first = found;
                ASSERT_TRUE(sameBytes(found, first)) << difference(found, first);
                EXPECT_EQ(pipelines[i]->statistics().m_candidates, pipelines[0]->statistics().m_candidates);
                EXPECT_EQ(pipelines[i]->statistics().m_status, pipelines[0]->statistics().m_status);
            }
            contacts += first.size();
        }
        if (traversal != Traversal::Pairs) continue;
        const std::set<std::size_t> different(tests.begin(), tests.end());
        EXPECT_EQ(different.size(), tests.size()) << "settings that do not reach the builder";
    }
    EXPECT_GT(contacts, 10000u);
}

// A cloth of loose triangles that fly to each other's places, and the same at rest: with a traversal that walks its
// hierarchy, and with the default, which does not.
TEST_P(TraversalTest, DecayedTreesAreBuiltAnew)
{
    StepCase step = soupCase(2000, 600, false, 930);
    SCOPED_TRACE(step.trace());
    for (float& coordinate : step.m_cloth.m_positions)
        coordinate *= 3.0f;
    std::vector<float> strewn = step.m_cloth.m_positions;
    Random random(931);
    for (std::size_t i = strewn.size() / 9; i-- > 1;)
        std::swap_ranges(&strewn[9 * i], &strewn[9 * i] + 9, &strewn[9 * random.below(std::uint32_t(i))]);
    for (const Traversal traversal : {Traversal::Pairs, Traversal::Auto})
    {
        const bool walksIt = traversal == Traversal::Pairs;
        for (const bool strews : {true, false})
        {
            SCOPED_TRACE(std::string(traversalName(traversal)) + (strews ? ", strewn" : ", at rest"));
            expectRebuilds(step, strews ? strewn : step.m_cloth.m_positions, traversal, strews && walksIt);
        }
    }
}

// Codes of 30 bits put what is close together in a large scene in no order, those of 63 do; so they must when meshes
// come, and not only in a tree that is built anew.
TEST_P(TraversalTest, LongCodesOrderABalancedTree)
{
    StepCase step = soupCase(600, 900, false, 940);
    // A triangle far away, so that the rest lies in one cell of 30 bits.
    for (std::vector<float>* positions : {&step.m_cloth.m_positions, &step.m_end, &step.m_obstacle.m_positions})
    {
        for (std::size_t i = 0; i < 9; ++i)
            (*positions)[i] += 1e4f;
    }
    std::size_t tests[2];
    std::vector<Contact> contacts[2];
    for (const std::uint32_t bits : {30u, 63u})
    {
        Settings settings = GetParam().m_settings;
        settings.m_methods.m_traversal = Traversal::Single;  // from the roots: no pairs to begin with
        settings.m_methods.m_countTests = true;
        settings.m_methods.m_rebuildDecay = 0.0f;
        settings.m_methods.m_tree.m_builder = TreeBuilder::Balanced;
        settings.m_methods.m_tree.m_mortonBits = bits;
        const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
        ASSERT_TRUE(pipeline);
        const std::size_t i = bits == 30 ? 0 : 1;
        contacts[i] = runCase(*pipeline, step);
        tests[i] = pipeline->statistics().m_volumeTests;
    }
    EXPECT_TRUE(sameBytes(contacts[0], contacts[1])) << difference(contacts[0], contacts[1]);
    EXPECT_GT(contacts[0].size(), 100u);
    EXPECT_LT(2 * tests[1], tests[0]);
}

// A front in a pipeline: it is used from the second step on, and drops with a mesh that comes.
TEST_P(TraversalTest, FrontIsKeptUntilMeshesChange)
{
    const std::unique_ptr<Pipeline> pipeline = make(Traversal::Front, true);
    ASSERT_TRUE(pipeline);
    const StepCase step = drapedCase("torus", 33, 0.02f, 910);
    SCOPED_TRACE(step.trace());
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
