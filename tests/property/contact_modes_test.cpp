// The three modes of motion (Settings::m_mode). Automatic steps give the contacts of continuous ones and run the
// continuous test less often. Discrete steps use only the end positions.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "tests/support/backends.h"
#include "tests/support/oracle.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr float kHere[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

struct Outcome
{
    std::vector<Contact> m_contacts;
    std::size_t m_swept = 0;
};

// Returns the case with its motion scaled about the step's end.
StepCase faster(StepCase step, float factor)
{
    for (std::size_t i = 0; i < step.m_end.size(); ++i)
    {
        float& start = step.m_cloth.m_positions[i];
        start = step.m_end[i] + factor * (start - step.m_end[i]);
    }
    step.m_name += " times " + std::to_string(factor);
    return step;
}

std::vector<StepCase> movingCases()
{
    std::vector<StepCase> cases;
    std::uint32_t seed = 900;
    for (const char* shape : {"sphere", "torus", "bowl", "stairs", "box"})
        for (const float factor : {0.05f, -0.6f, 1.0f, 20.0f})
            cases.push_back(faster(fallingCase(shape, 20, 0.03f, ++seed), factor));
    for (const float factor : {0.02f, 1.0f, 5.0f})
        cases.push_back(faster(soupCase(120, 150, true, ++seed), factor));
    return cases;
}

// Makes a slope of a kilometre, of two triangles, and cloth beside it whose gap goes from one value to the other, m.
// The cloth is thin and the edges are long. Normal (1, 1, 0) / √2.
StepCase slopeCase(float gapBefore, float gapAfter)
{
    StepCase step;
    step.m_name = "slope, gap from " + std::to_string(gapBefore) + " to " + std::to_string(gapAfter);
    step.m_seed = 0;
    step.m_thickness = 0.001f;
    step.m_obstacle = looseTriangles({500, -500, -500, -500, 500, -500, -500, 500, 500,  //
                                      500, -500, -500, -500, 500, 500, 500, -500, 500});
    const float along = 0.70710678f;
    for (int column = 0; column < 6; ++column)
    {
        for (int row = 0; row < 6; ++row)
        {
            const float u = 0.02f * float(column) - 0.05f + 0.001f * float(row), v = 0.02f * float(row) - 0.05f;
            const auto at = [&](float gap) { return std::vector<float>{along * (gap + u), along * (gap - u), v}; };
            const std::vector<float> before = at(gapBefore), after = at(gapAfter);
            step.m_cloth.m_positions.insert(step.m_cloth.m_positions.end(), before.begin(), before.end());
            step.m_end.insert(step.m_end.end(), after.begin(), after.end());
            if (column == 5 || row == 5) continue;
            const int first = 6 * column + row;
            for (const int corner : {first, first + 6, first + 1, first + 1, first + 6, first + 7})
                step.m_cloth.m_triangles.push_back(corner);
        }
    }
    return step;
}

// Makes a pyramid whose apex, vertex 4, is the origin.
TriangleMesh pyramid()
{
    TriangleMesh mesh = looseTriangles({-1, -2, -1, 1, -2, -1, 1, -2, 1, -1, -2, 1, 0, 0, 0});
    mesh.m_triangles = {1, 0, 4, 2, 1, 4, 3, 2, 4, 0, 3, 4, 0, 1, 2, 0, 2, 3};
    return mesh;
}
std::array<std::uint32_t, 3> featuresOf(const Contact& contact)
{
    return {contact.m_kind, contact.m_clothFeature, contact.m_obstacleFeature};
}

// Returns true if the contact's normal points to the side that touching features came from.
bool hasDirection(const Contact& contact)
{
    return std::abs(contact.m_gap1) > 1e-4f;
}
}  // namespace

class ContactModesTest : public BackendTest
{
protected:
    // Runs the step. `startPose` is the obstacle's; it ends where the case has it. Null means that the obstacle rests.
    Outcome run(const StepCase& step, ContactMode mode, const float* startPose = nullptr)
    {
        Pipeline* const pipeline = pipelineOf(mode);
        if (!pipeline) return {};
        Outcome outcome;
        const MeshId cloth = addCloth(*pipeline, step.m_cloth), obstacle = addObstacle(*pipeline, step.m_obstacle);
        if (startPose) pipeline->placeObstacle(obstacle, startPose, kHere);
        setMotion(*pipeline, cloth, step.m_cloth.m_positions, step.m_end);
        pipeline->addPair(cloth, obstacle, step.m_thickness);
        outcome.m_contacts = runStep(*pipeline);
        outcome.m_swept = pipeline->statistics().m_sweptTests;
        pipeline->remove(cloth);
        pipeline->remove(obstacle);
        return outcome;
    }

private:
    // Returns one pipeline for all of a test's cases: making one takes PoCL a fifth of a second.
    Pipeline* pipelineOf(ContactMode mode)
    {
        std::unique_ptr<Pipeline>& pipeline = m_pipelines[mode];
        if (pipeline) return pipeline.get();
        Settings settings = GetParam().m_settings;
        settings.m_mode = mode;
        pipeline = makePipeline(settings);
        return pipeline.get();
    }

    std::map<ContactMode, std::unique_ptr<Pipeline>> m_pipelines;
};

TEST_P(ContactModesTest, AutomaticGivesTheContactsOfContinuousForLess)
{
    std::size_t contacts = 0, swept = 0, sweptAlways = 0;
    for (const StepCase& step : movingCases())
    {
        SCOPED_TRACE(step.trace());
        const Outcome automatic = run(step, ContactMode::Automatic), continuous = run(step, ContactMode::Continuous);
        EXPECT_TRUE(sameBytes(automatic.m_contacts, continuous.m_contacts))
            << automatic.m_contacts.size() << " and " << continuous.m_contacts.size();
        EXPECT_LE(automatic.m_swept, continuous.m_swept);
        contacts += continuous.m_contacts.size();
        swept += automatic.m_swept;
        sweptAlways += continuous.m_swept;
    }
    EXPECT_GT(contacts, 10000u);
    EXPECT_LT(2 * swept, sweptAlways);
}

// A feature that goes around another one, through its plane or line beside it, ends as near as it would without its
// path.
TEST_P(ContactModesTest, StepsEndDecidesForFeaturesThatDoNotMeet)
{
    std::size_t near = 0, missing = 0;
    for (const StepCase& step : movingCases())
    {
        SCOPED_TRACE(step.trace());
        std::map<std::array<std::uint32_t, 3>, Contact> found;
        for (const Contact& contact : run(step, ContactMode::Automatic).m_contacts)
            found[featuresOf(contact)] = contact;
        for (const Contact& atEnd : run(step, ContactMode::Discrete).m_contacts)
        {
            const auto at = found.find(featuresOf(atEnd));
            ++near;
            if (at == found.end())
            {
                ++missing;
                continue;
            }
            if (at->second.m_time < 1 || !hasDirection(atEnd)) continue;
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(at->second.m_normal[k], atEnd.m_normal[k], 1e-3f);
        }
    }
    EXPECT_GT(near, 10000u);
    EXPECT_EQ(missing, 0u);
}

// Ways shorter than the reach, towards an obstacle and away from it, where what counts as met depends on the obstacle's
// size.
TEST_P(ContactModesTest, AutomaticGivesTheContactsOfContinuousAtLongEdges)
{
    Settings onHost = allBackends()[0].m_settings;
    onHost.m_mode = ContactMode::Continuous;
    std::size_t contacts = 0;
    for (const float gap : {0.0001f, 0.0002f, 0.0005f, 0.001f, 0.0014f, 0.002f, 0.01f, 0.08f})
    {
        for (const float way : {0.1f, 0.3f, 0.6f, 0.87f, 0.89f, 0.91f, 1.2f, 70.0f})
        {
            for (const float sign : {-1.0f, 1.0f})
            {
                const StepCase step = slopeCase(gap, gap + sign * way * 0.0015f);
                SCOPED_TRACE(step.trace());
                const Outcome automatic = run(step, ContactMode::Automatic);
                const Outcome continuous = run(step, ContactMode::Continuous);
                EXPECT_TRUE(sameBytes(automatic.m_contacts, continuous.m_contacts))
                    << automatic.m_contacts.size() << " and " << continuous.m_contacts.size();
                const std::unique_ptr<Pipeline> host = makePipeline(onHost);
                EXPECT_TRUE(sameBytes(automatic.m_contacts, runCase(*host, step)));
                contacts += automatic.m_contacts.size();
            }
        }
    }
    EXPECT_GT(contacts, 1000u);
}

TEST_P(ContactModesTest, AutomaticGivesTheContactsOfContinuousWhereObstaclesMove)
{
    // The obstacle rotates by 0.1 about z, and shifts slowly or fast.
    for (const float shift : {0.01f, 0.5f})
    {
        const float before[12] = {0.995004f, -0.099833f, 0, shift, 0.099833f, 0.995004f, 0, -shift, 0, 0, 1, 0};
        for (const StepCase& step : movingCases())
        {
            SCOPED_TRACE(step.trace());
            const Outcome automatic = run(step, ContactMode::Automatic, before);
            EXPECT_TRUE(sameBytes(automatic.m_contacts, run(step, ContactMode::Continuous, before).m_contacts));
            EXPECT_GT(automatic.m_contacts.size(), 0u);
        }
    }
}

TEST_P(ContactModesTest, DiscreteSeesTheEndOnly)
{
    for (StepCase step : movingCases())
    {
        SCOPED_TRACE(step.trace());
        const Outcome moving = run(step, ContactMode::Discrete);
        EXPECT_EQ(moving.m_swept, 0u);
        for (const Contact& contact : moving.m_contacts)
            EXPECT_EQ(contact.m_time, 1.0f);
        // The cloth at rest in its end positions gives the same contacts, apart from the nodes' start.
        step.m_cloth.m_positions = step.m_end;
        std::vector<Contact> resting = run(step, ContactMode::Discrete).m_contacts;
        ASSERT_EQ(resting.size(), moving.m_contacts.size());
        for (std::size_t i = 0; i < resting.size(); ++i)
            resting[i].m_gap0 = moving.m_contacts[i].m_gap0;
        EXPECT_TRUE(sameBytes(resting, moving.m_contacts));
    }
}

TEST_P(ContactModesTest, RestingClothNeedsNoContinuousTest)
{
    for (const char* shape : {"sphere", "stairs", "torus"})
    {
        const StepCase step = drapedCase(shape, 20, 0.03f, 950);
        SCOPED_TRACE(step.trace());
        const Outcome automatic = run(step, ContactMode::Automatic), continuous = run(step, ContactMode::Continuous);
        EXPECT_TRUE(sameBytes(automatic.m_contacts, continuous.m_contacts));
        EXPECT_GT(continuous.m_swept, 100u);
        EXPECT_LT(20 * automatic.m_swept, continuous.m_swept);
    }
}

// The face's plane crosses the apex twice, once within the face and once outside of it. The signs of the volumes at the
// step's two ends are equal, and yet the face went past.
TEST_P(ContactModesTest, FaceThatPassesAndTiltsBackIsFound)
{
    StepCase step = {"tilting face", 0, looseTriangles({-1, 0.1f, -1, 1, 0.1f, -1, 0, 0.1f, 1}), pyramid(), {}, 0.02f};
    step.m_end = {-3, -1, -1, -1, -0.2f, -1, -2, -0.6f, 1};
    for (const ContactMode mode : {ContactMode::Automatic, ContactMode::Continuous})
    {
        int found = 0;
        for (const Contact& contact : run(step, mode).m_contacts)
        {
            if (contact.m_kind != DRAPE_FACE_VERTEX || contact.m_obstacleFeature != 4) continue;
            ++found;
            // 0.1 - 0.7 t + 0.8 t² = 0; see kernels/lib/narrow_phase/feature_meeting.h for how early a time may be.
            EXPECT_LE(contact.m_time, 0.179844f + 1e-5f);
            EXPECT_GT(contact.m_time, 0.179844f - 2.05f * 0.01f * 0.03f / 2);
            EXPECT_GT(contact.m_normal[1], 0.9f);
            EXPECT_GT(contact.m_gap0, 0.05f);  // along the tilted normal
            EXPECT_LT(contact.m_gap1, -0.1f);
        }
        EXPECT_EQ(found, 1);
    }
}

// Runs the motion backwards: the plane crosses the apex outside of the face first, and then within it. The volume's
// sign at the start does not determine the side that the face came from.
TEST_P(ContactModesTest, FaceThatTiltsAndThenPassesIsFound)
{
    StepCase step = {"tilted face", 0, looseTriangles({-3, -1, -1, -1, -0.2f, -1, -2, -0.6f, 1}), pyramid(), {}, 0.02f};
    step.m_end = {-1, 0.1f, -1, 1, 0.1f, -1, 0, 0.1f, 1};
    for (const ContactMode mode : {ContactMode::Automatic, ContactMode::Continuous})
    {
        int found = 0;
        for (const Contact& contact : run(step, mode).m_contacts)
        {
            if (contact.m_kind != DRAPE_FACE_VERTEX || contact.m_obstacleFeature != 4) continue;
            ++found;
            EXPECT_NEAR(contact.m_time, 1 - 0.179844f, 2e-4f);
            EXPECT_LT(contact.m_normal[1], -0.9f);  // it came from below
            EXPECT_GT(contact.m_gap0, 0.0f);
            EXPECT_LT(contact.m_gap1, -0.01f);
        }
        EXPECT_EQ(found, 1);
    }
}

// The edge turns past the direction of the obstacle's edge before it goes through it. Its volume has the same sign at
// the start and at the end.
TEST_P(ContactModesTest, EdgeThatTurnsAndThenPassesIsFound)
{
    StepCase step = {"turning edge",
                     0,
                     looseTriangles({-0.5f, -0.01f, 0.7f, 0.5f, 0.01f, 0.7f, 0, 0, 1.7f}),
                     looseTriangles({-1, 0, 0, 1, 0, 0, 0, -1, -1}),
                     {},
                     0.02f};
    step.m_end = {-0.5f, 0.01f, -0.3f, 0.5f, -0.01f, -0.3f, 0, 0, 0.7f};
    for (const ContactMode mode : {ContactMode::Automatic, ContactMode::Continuous})
    {
        int found = 0;
        for (const Contact& contact : run(step, mode).m_contacts)
        {
            if (contact.m_kind != DRAPE_EDGE_EDGE || !(contact.m_time < 1) || contact.m_weights[0] < 0.3f ||
                contact.m_weights[0] > 0.7f)
                continue;
            ++found;
            EXPECT_NEAR(contact.m_time, 0.7f, 2e-3f);
            EXPECT_GT(contact.m_normal[2], 0.9f);
            EXPECT_NEAR(contact.m_gap0, 0.7f, 0.02f);
            EXPECT_NEAR(contact.m_gap1, -0.3f, 0.02f);
        }
        EXPECT_EQ(found, 1);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, ContactModesTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
