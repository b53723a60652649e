// Invariances: the numbering of triangles, the order of their corners, a power of two as unit, the position in space.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/support/backends.h"
#include "tests/support/cases.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
std::map<FeatureKey, Contact> keyedContacts(const StepCase& step)
{
    Side cloth = makeSide({step.m_cloth});
    const Side obstacle = makeSide({step.m_obstacle});
    cloth.m_end = step.m_end;
    std::map<FeatureKey, Contact> keyed;
    for (const Contact& contact : contactsOfAllPairs(cloth, obstacle, step.m_thickness))
    {
        EXPECT_TRUE(keyed.emplace(featureKey(contact, cloth, obstacle), contact).second)
            << "twice: " << describe(contact);
    }
    return keyed;
}

// Compares contacts under another numbering, which moves the local frame and so the rounding. At seams one neighbour or
// the other reports, and a distance at the reach falls to either side. All other contacts agree.
void expectSameUpToNumbering(const StepCase& a, const StepCase& b)
{
    const std::map<FeatureKey, Contact> first = keyedContacts(a), second = keyedContacts(b);
    EXPECT_GT(first.size(), 100u);
    std::size_t alone = 0;
    for (const auto& one : first)
    {
        const auto other = second.find(one.first);
        if (other == second.end())
        {
            ++alone;
            continue;
        }
        EXPECT_NEAR(one.second.m_gap1, other->second.m_gap1, 1e-5f) << describe(one.second) << '\n'
                                                                    << describe(other->second);
        float cosine = 0;
        for (int k = 0; k < 3; ++k)
            cosine += one.second.m_normal[k] * other->second.m_normal[k];
        EXPECT_GT(cosine, 0.999f) << describe(one.second) << '\n' << describe(other->second);
    }
    alone += second.size() - (first.size() - alone);
    EXPECT_LE(alone, (first.size() + second.size()) / 200);
}

void shuffleTriangles(TriangleMesh& mesh, Random& random, bool flip)
{
    const std::size_t count = mesh.triangleCount();
    for (std::size_t i = count; i > 1; --i)
    {
        const std::size_t j = random.below(std::uint32_t(i));
        if (i - 1 == j) continue;
        std::swap_ranges(&mesh.m_triangles[3 * (i - 1)], &mesh.m_triangles[3 * (i - 1)] + 3, &mesh.m_triangles[3 * j]);
    }
    for (std::size_t i = 0; i < count; ++i)
    {
        std::int32_t* t = &mesh.m_triangles[3 * i];
        std::rotate(t, t + random.below(3), t + 3);
        if (flip) std::swap(t[1], t[2]);
    }
}
}  // namespace

TEST(Symmetry, NumberingAndWindingDoNotMatter)
{
    for (const char* shape : {"sphere", "torus", "stairs", "terrain"})
    {
        for (bool moving : {false, true})
        {
            for (bool flip : {false, true})
            {
                const StepCase step = moving ? fallingCase(shape, 16, 0.03f, 600) : drapedCase(shape, 16, 0.03f, 601);
                SCOPED_TRACE(step.trace() + (flip ? ", flipped" : ""));
                Random random(602);
                StepCase shuffled = step;
                shuffleTriangles(shuffled.m_cloth, random, flip);
                shuffleTriangles(shuffled.m_obstacle, random, flip);
                expectSameUpToNumbering(step, shuffled);
            }
        }
    }
}

class SymmetryTest : public BackendTest
{
};

TEST_P(SymmetryTest, PowersOfTwoScaleEveryBit)
{
    for (const StepCase& step : {fallingCase("torus", 16, 0.03f, 610), soupCase(150, 150, true, 611)})
    {
        const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
        ASSERT_TRUE(pipeline);
        const std::vector<Contact> original = runCase(*pipeline, step);
        EXPECT_GT(original.size(), 50u);
        for (int exponent : {-20, -3, 1, 20})
        {
            SCOPED_TRACE(step.trace() + ", times 2^" + std::to_string(exponent));
            StepCase scaled = step;
            const float scale = std::ldexp(1.0f, exponent);
            for (std::vector<float>* positions :
                 {&scaled.m_cloth.m_positions, &scaled.m_end, &scaled.m_obstacle.m_positions})
            {
                for (float& coordinate : *positions)
                    coordinate *= scale;
            }
            scaled.m_thickness *= scale;
            const std::unique_ptr<Pipeline> other = makePipeline(GetParam().m_settings);
            ASSERT_TRUE(other);
            std::vector<Contact> found = runCase(*other, scaled);
            for (Contact& contact : found)
            {
                contact.m_gap0 /= scale;
                contact.m_gap1 /= scale;
                for (float& coordinate : contact.m_point)
                    coordinate /= scale;
            }
            EXPECT_TRUE(sameBytes(found, original)) << difference(found, original);
        }
    }
}

TEST_P(SymmetryTest, ExactTranslationChangesThePointsOnly)
{
    StepCase step = fallingCase("sphere", 16, 0.03f, 620);
    SCOPED_TRACE(step.trace());
    const std::vector<std::vector<float>*> all = {&step.m_cloth.m_positions, &step.m_end, &step.m_obstacle.m_positions};
    for (std::vector<float>* positions : all)
    {
        // Multiples of 2^-14: with offsets up to 100 they stay exact.
        for (float& coordinate : *positions)
            coordinate = std::round(coordinate * 16384.0f) / 16384.0f;
    }
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings),
                                    moved = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline && moved);
    std::vector<Contact> original = runCase(*pipeline, step);
    for (std::vector<float>* positions : all)
        translate(*positions, 64.0f, -32.0f, 100.0f);
    std::vector<Contact> found = runCase(*moved, step);
    EXPECT_GT(original.size(), 100u);
    for (std::vector<Contact>* contacts : {&original, &found})
    {
        for (Contact& contact : *contacts)
            std::fill(contact.m_point, contact.m_point + 3, 0.0f);
    }
    EXPECT_TRUE(sameBytes(found, original)) << difference(found, original);
}

INSTANTIATE_TEST_SUITE_P(Backends, SymmetryTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
