// Loads that break what is built for the usual: crowds of coincident triangles, extreme speed, many steps.
#include <gtest/gtest.h>

#include <set>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/memory.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"

namespace drape::test
{
class LoadTest : public BackendTest
{
};

// Every pair is a candidate. The numbers are exact, buffers grow in one repetition a kind, and the step ends.
TEST_P(LoadTest, CoincidentTriangles)
{
    constexpr int kClothTriangles = 600, kObstacleTriangles = 250;
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    StepCase step = {"coincident triangles",
                     0,
                     coincidentTriangles(kClothTriangles, 0.02f),
                     coincidentTriangles(kObstacleTriangles, 0.0f),
                     {},
                     0.1f};
    step.m_end = step.m_cloth.m_positions;
    const std::vector<Contact> contacts = runCase(*pipeline, step);
    const StepStatistics& statistics = pipeline->statistics();
    EXPECT_GE(statistics.m_candidates, std::size_t(kClothTriangles) * kObstacleTriangles);
    EXPECT_LE(statistics.m_retries, 3u);
    EXPECT_GT(statistics.m_retries, 0u);
    // At least three nodes of every cloth triangle touch every obstacle triangle.
    EXPECT_GE(contacts.size(), 3u * kClothTriangles * kObstacleTriangles);
    EXPECT_EQ(statistics.m_status, std::uint32_t(kStepGood));
    // The next step has room already and gives equal contacts.
    pipeline->addPair(0, 1, step.m_thickness);
    const std::vector<Contact> again = runStep(*pipeline);
    EXPECT_EQ(pipeline->statistics().m_retries, 0u);
    EXPECT_TRUE(sameBytes(again, contacts)) << difference(again, contacts);
}

// Features with so many contacts that a launch of their own puts them in order, long after the last step that had some:
// the step runs again for it. Lists have room from before.
TEST_P(LoadTest, CrowdsComeBackInOrder)
{
    constexpr int kObstacleTriangles = 1000, kStepsWithout = 200, kOtherTriangles = 6000;
    for (const bool manyFeatures : {false, true})
    {
        SCOPED_TRACE(manyFeatures ? "many features" : "few features");
        const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
        ASSERT_TRUE(pipeline);
        StepCase step = {"a crowd", 0,   coincidentTriangles(2, 0.02f), coincidentTriangles(kObstacleTriangles, 0.0f),
                         {},        0.1f};
        step.m_end = step.m_cloth.m_positions;
        runCase(*pipeline, step);
        const TriangleMesh other = coincidentTriangles(kOtherTriangles, 50.0f);
        const MeshId idle = manyFeatures ? addCloth(*pipeline, other) : 0;
        const auto run = [&](const std::vector<float>& positions)
        {
            setMotion(*pipeline, 0, positions, positions);
            if (manyFeatures) setMotion(*pipeline, idle, other.m_positions, other.m_positions);
            pipeline->addPair(0, 1, step.m_thickness);
            return runStep(*pipeline);
        };
        const std::vector<Contact> contacts = run(step.m_end);
        ASSERT_GE(contacts.size(), 3u * 2u * kObstacleTriangles);
        const std::vector<float> away = coincidentTriangles(2, 5.0f).m_positions;
        for (int i = 0; i < kStepsWithout; ++i)
            ASSERT_TRUE(run(away).empty());
        const std::vector<Contact> again = run(step.m_end);
        EXPECT_EQ(pipeline->statistics().m_retries, pipeline->deviceReport().m_onHost ? 0u : 1u);
        EXPECT_TRUE(sameBytes(again, contacts)) << difference(again, contacts);
    }
}

// Row 11 of the stress table. Five thousand million pairs, more than fit into memory or into 32 bits: the step says so,
// leaves that cloth out and does the rest as if it were alone. Bounded in memory and time.
TEST_P(LoadTest, HundredThousandCoincidentTriangles)
{
    constexpr int kClothTriangles = 100000, kObstacleTriangles = 50000;
    const StepCase sound = fallingCase("sphere", 20, 0.03f, 940);
    SCOPED_TRACE(sound.trace());
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    const std::vector<Contact> alone = runCase(*pipeline, sound);
    const std::size_t soundCandidates = pipeline->statistics().m_candidates;
    ASSERT_GT(alone.size(), 100u);

    const TriangleMesh crowd = coincidentTriangles(kClothTriangles, 5.02f);
    const MeshId cloth = addCloth(*pipeline, crowd);
    const MeshId obstacle = addObstacle(*pipeline, coincidentTriangles(kObstacleTriangles, 5.0f));
    const std::size_t before = peakResidentBytes();
    for (int repetition = 0; repetition < 2; ++repetition)
    {
        setMotion(*pipeline, 0, sound.m_cloth.m_positions, sound.m_end);
        setMotion(*pipeline, cloth, crowd.m_positions, crowd.m_positions);
        pipeline->addPair(0, 1, sound.m_thickness);
        pipeline->addPair(cloth, obstacle, 0.1f);
        const std::vector<Contact> contacts = runStep(*pipeline);
        const StepStatistics& statistics = pipeline->statistics();
        EXPECT_EQ(statistics.m_candidates, Settings().m_candidateLimit + 1 + soundCandidates);
        EXPECT_EQ(statistics.m_status, std::uint32_t(kStepClothsLeftOut)) << pipeline->lastError().text();
        EXPECT_EQ(statistics.m_clothsLeftOut, 1u);
        ASSERT_EQ(contacts.size(), alone.size());
        for (std::size_t i = 0; i < contacts.size(); ++i)
        {
            // Feature indices count over all cloths; those of the first one stay.
            EXPECT_EQ(contacts[i].m_obstacleFeature, alone[i].m_obstacleFeature);
            EXPECT_EQ(std::memcmp(contacts[i].m_normal, alone[i].m_normal, sizeof(Contact) - 4 * sizeof(std::uint32_t)),
                      0)
                << describe(contacts[i]) << "\n"
                << describe(alone[i]);
        }
    }
    // The step needs one list of candidates, and the memory of the meshes.
    EXPECT_LT(peakResidentBytes(), before + 12 * Settings().m_candidateLimit + kGrowthBytes);
    // The step is good again without the crowd's pair.
    pipeline->addPair(0, 1, sound.m_thickness);
    EXPECT_EQ(runStep(*pipeline).size(), alone.size());
    EXPECT_EQ(pipeline->statistics().m_status, std::uint32_t(kStepGood));
}

// The limits are settings: cloths are left out from the one with the most candidates down, the same on every back end,
// and what is left is as if the others were not there.
TEST_P(LoadTest, LimitsLeaveOutTheLargestCloths)
{
    const StepCase step = fallingCase("sphere", 20, 0.03f, 941);
    SCOPED_TRACE(step.trace());
    const std::unique_ptr<Pipeline> unlimited = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(unlimited);
    const std::vector<Contact> alone = runCase(*unlimited, step);
    const std::uint64_t candidates = unlimited->statistics().m_candidates;
    // The host counts the feature pairs of omitted cloths.
    Settings onHost;
    onHost.m_backend = Backend::Host;
    const std::unique_ptr<Pipeline> host = makePipeline(onHost);
    runCase(*host, step);
    const std::uint64_t counted = host->statistics().m_candidates;
    for (const bool byContacts : {false, true})
    {
        SCOPED_TRACE(byContacts ? "contacts" : "candidates");
        Settings settings = GetParam().m_settings;
        // The limit has room for one of three equal cloths, with some reserve.
        (byContacts ? settings.m_contactLimit : settings.m_candidateLimit) =
            byContacts ? alone.size() * 3 / 2 : std::size_t(candidates) * 3 / 2;
        const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
        ASSERT_TRUE(pipeline);
        const MeshId obstacle = addObstacle(*pipeline, step.m_obstacle);
        for (int i = 0; i < 3; ++i)
        {
            const MeshId cloth = addCloth(*pipeline, step.m_cloth);
            setMotion(*pipeline, cloth, step.m_cloth.m_positions, step.m_end);
            pipeline->addPair(cloth, obstacle, step.m_thickness);
        }
        for (std::uint32_t cloth = 0; cloth < 3; ++cloth)
            setMotion(*pipeline, cloth + 1, step.m_cloth.m_positions, step.m_end);
        const std::vector<Contact> contacts = runStep(*pipeline);
        EXPECT_EQ(pipeline->statistics().m_clothsLeftOut, 2u);
        EXPECT_EQ(pipeline->statistics().m_status, std::uint32_t(kStepClothsLeftOut));
        EXPECT_EQ(pipeline->statistics().m_candidates, candidates + 2 * counted);
        EXPECT_EQ(contacts.size(), alone.size());
        for (const Contact& contact : contacts)
            EXPECT_EQ(pipeline->view(contact).m_cloth, 1u) << "of equal cloths the first stays";
    }
}

// 1,000 m/s at 60 steps a second: 16.7 m in a step, through a sheet without thickness, from either side and at a slant.
TEST_P(LoadTest, ThousandMetresASecondThroughAThinSheet)
{
    const TriangleMesh sheet = makeClothGrid(21, 21, 40.0f, 0.0f).m_mesh;
    Random random(950);
    for (int direction = 0; direction < 12; ++direction)
    {
        SCOPED_TRACE("seed 950, direction " + std::to_string(direction));
        const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
        ASSERT_TRUE(pipeline);
        StepCase step = {"fast cloth", 950, makeClothGrid(15, 15, 1.0f, 0.0f).m_mesh, sheet, {}, 0.01f};
        const float side = direction % 2 ? -1.0f : 1.0f;
        const float above = side * random.uniform(0.5f, 12.0f), below = side * -random.uniform(0.5f, 12.0f);
        const float motion[3] = {random.uniform(-10, 10), below - above, random.uniform(-10, 10)};
        disturb(step.m_cloth.m_positions, 0.3f, random);
        step.m_end = step.m_cloth.m_positions;
        translate(step.m_cloth.m_positions, 0, above, 0);
        translate(step.m_end, motion[0], below, motion[2]);
        std::set<std::uint32_t> caught;
        for (const Contact& contact : runCase(*pipeline, step))
        {
            // The normal points against the motion; a contact of the sheet has the sheet's own normal.
            EXPECT_LT(
                contact.m_normal[0] * motion[0] + contact.m_normal[1] * motion[1] + contact.m_normal[2] * motion[2],
                0.0f)
                << describe(contact);
            EXPECT_TRUE(contact.m_gap0 > 0.0f && contact.m_gap1 < 0.0f) << describe(contact);
            if (contact.m_kind != DRAPE_NODE_FACE) continue;
            EXPECT_GT(side * contact.m_normal[1], 0.99f) << describe(contact);
            caught.insert(contact.m_clothFeature);
        }
        EXPECT_EQ(caught.size(), step.m_cloth.vertexCount()) << "every node crossed the sheet";
    }
}

// The cloth rests, the sheet's spikes are small: vertices that a fast cloth face passes are caught as well.
TEST_P(LoadTest, FastFacesOverLoneVertices)
{
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    Random random(960);
    // Needles that point up, each far smaller than a cloth face.
    std::vector<float> corners;
    for (int i = 0; i < 50; ++i)
    {
        const float x = random.uniform(-1.5f, 1.5f), z = random.uniform(-1.5f, 1.5f);
        corners.insert(corners.end(), {x, 0, z, x + 0.01f, -0.1f, z, x, -0.1f, z + 0.01f});
    }
    StepCase step = {"needles", 960, makeClothGrid(5, 5, 4.0f, 0.0f).m_mesh, looseTriangles(corners), {}, 0.01f};
    SCOPED_TRACE(step.trace());
    step.m_end = step.m_cloth.m_positions;
    translate(step.m_cloth.m_positions, 0, 8.0f, 0);
    translate(step.m_end, 0, -8.0f, 0);
    std::set<std::uint32_t> tips;
    for (const Contact& contact : runCase(*pipeline, step))
    {
        if (contact.m_kind != DRAPE_FACE_VERTEX) continue;
        EXPECT_GT(contact.m_normal[1], 0.99f) << describe(contact);
        if (contact.m_obstacleFeature % 3 == 0) tips.insert(contact.m_obstacleFeature);
    }
    EXPECT_EQ(tips.size(), 50u);
}

TEST_P(LoadTest, ManyStepsHoldTheirMemory)
{
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    const StepCase step = fallingCase("sphere", 24, 0.03f, 970);
    SCOPED_TRACE(step.trace());
    const MeshId obstacle = addObstacle(*pipeline, step.m_obstacle);
    MeshId cloth = addCloth(*pipeline, step.m_cloth);
    std::vector<Contact> first;
    std::size_t before = 0;
    constexpr int kWarmUp = 100, kSteps = 700;
    for (int i = 0; i < kSteps; ++i)
    {
        if (i == kWarmUp) before = residentBytes();
        if (i % 10 == 9)  // meshes come and go
        {
            pipeline->remove(cloth);
            cloth = addCloth(*pipeline, step.m_cloth);
        }
        if (i % 7 == 0) pipeline->moveObstacle(obstacle, step.m_obstacle.m_positions.data());
        setMotion(*pipeline, cloth, step.m_cloth.m_positions, step.m_end);
        pipeline->addPair(cloth, obstacle, step.m_thickness);
        const std::vector<Contact> contacts = runStep(*pipeline);
        if (i == 0) first = contacts;
        ASSERT_TRUE(sameBytes(contacts, first)) << "step " << i << ": " << difference(contacts, first);
    }
    EXPECT_LT(residentBytes(), before + kGrowthBytes);
}

INSTANTIATE_TEST_SUITE_P(Backends, LoadTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
