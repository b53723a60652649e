// Row 9 of the stress table: the host flushes denormals to zero, as an app's audio or physics code may have set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"

#ifdef __x86_64__
#include <immintrin.h>

namespace drape::test
{
namespace
{
// Has this thread, and those that it starts, flush results (FTZ) and inputs (DAZ), if so wanted.
class FlushDenormals
{
public:
    explicit FlushDenormals(bool flush) : m_before(_mm_getcsr())
    {
        if (flush) _mm_setcsr(m_before | 0x8040u);
    }
    ~FlushDenormals() { _mm_setcsr(m_before); }

private:
    unsigned int m_before;
};

// Moves each coordinate by 10^-44 to 10^-20 m: those that are not zero stay.
void addTiny(std::vector<float>& positions, Random& random)
{
    for (float& coordinate : positions)
        coordinate += float(std::pow(10.0, random.uniform(-44, -20))) * (random.below(2) ? 1.0f : -1.0f);
}

// Makes a cloth at rest on the shape, or falling through it. The shape is moved by so little that only zeros change.
StepCase tinyCase(const char* shape, float lift, bool moving, std::uint32_t seed)
{
    Random random(seed);
    StepCase step = moving ? fallingCase(shape, 14, 0.03f, seed) : drapedCase(shape, 14, 0.03f, seed);
    translate(step.m_obstacle.m_positions, 0, lift, 0);
    for (std::vector<float>* positions : {&step.m_cloth.m_positions, &step.m_end})
        translate(*positions, 0, lift, 0);
    addTiny(step.m_obstacle.m_positions, random);
    return step;
}
}  // namespace

TEST(FlushedDenormals, TheHostFindsTheSameContacts)
{
    Settings settings;
    settings.m_backend = Backend::Host;
    std::size_t contacts = 0;
    for (const char* shape : {"box", "stairs", "sphere", "terrain"})
    {
        for (const bool moving : {false, true})
        {
            // The box's faces in planes through the origin.
            const StepCase step = tinyCase(shape, -0.3f, moving, 560);
            SCOPED_TRACE(step.trace());
            const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
            ASSERT_TRUE(pipeline);
            const std::vector<Contact> expected = runCase(*pipeline, step);
            std::vector<Contact> flushed;
            {
                const FlushDenormals flush(true);
                volatile float smallest = 1e-40f;
                ASSERT_EQ(smallest * 1.0f, 0.0f);
                const std::unique_ptr<Pipeline> other = makePipeline(settings);
                ASSERT_TRUE(other);
                flushed = runCase(*other, step);
            }
            ASSERT_EQ(flushed.size(), expected.size());
            contacts += expected.size();
            for (std::size_t i = 0; i < expected.size(); ++i)
            {
                EXPECT_EQ(flushed[i].m_kind, expected[i].m_kind);
                EXPECT_EQ(flushed[i].m_clothFeature, expected[i].m_clothFeature);
                EXPECT_EQ(flushed[i].m_obstacleFeature, expected[i].m_obstacleFeature);
                EXPECT_NEAR(flushed[i].m_gap1, expected[i].m_gap1, 1e-19f);
            }
        }
    }
    EXPECT_GT(contacts, 1000u);
}

// A whole sphere below that size is a point for the cloth over it, and the cloth touches it all the same.
TEST(FlushedDenormals, TinyObstaclesAreMet)
{
    Settings settings;
    settings.m_backend = Backend::Host;
    constexpr float kHeight = 0.01f;
    for (const float scale : {1e-19f, 1e-22f, 1e-26f, 1e-30f, 1e-38f, 1e-42f})
    {
        for (const bool flush : {false, true})
        {
            SCOPED_TRACE(std::to_string(std::log10(scale)) + (flush ? ", flushed" : ""));
            StepCase step = {"cloth over a point", 0,  makeClothGrid(4, 4, 0.2f, kHeight).m_mesh,
                             makeSphere(1.0f, 1),  {}, 0.02f};
            for (float& coordinate : step.m_obstacle.m_positions)
                coordinate *= scale;
            step.m_end = step.m_cloth.m_positions;
            std::vector<Contact> contacts;
            {
                const FlushDenormals flushed(flush);
                const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
                ASSERT_TRUE(pipeline);
                contacts = runCase(*pipeline, step);
            }
            EXPECT_FALSE(contacts.empty());
            float nearest = 1;
            for (const Contact& contact : contacts)
            {
                ASSERT_TRUE(std::isfinite(contact.m_gap1)) << describe(contact);
                EXPECT_GT(contact.m_normal[1], 0.0f) << describe(contact);
                nearest = std::min(nearest, contact.m_gap1);
            }
            EXPECT_NEAR(nearest, kHeight, 1e-6f);
        }
    }
}
}  // namespace drape::test
#endif
