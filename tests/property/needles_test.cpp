// Thin triangles: the contacts of all pairs of triangles on every back end.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/backends.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
// Makes upright slivers and fat triangles beside them, within reach and a little beyond. A coordinate that is otherwise
// 0 keeps the slivers' heights, 1e-8 to 1e-38 m, in full. `swapped`: the slivers are the cloth.
StepCase flatCase(bool swapped, std::uint32_t seed)
{
    Random random(seed);
    StepCase step = {"flat slivers", seed, {}, {}, {}, 0.1f};
    std::vector<float> slivers, beside;
    for (int i = 0; i < 62; ++i)
    {
        const float x = float(i), height = std::pow(10.0f, -8.0f - 0.5f * float(i)),
                    away = random.uniform(0.02f, 0.12f);
        slivers.insert(slivers.end(), {x, 0, -0.5f, x, height, random.uniform(-0.4f, 0.4f), x, 0, 0.5f});
        beside.insert(beside.end(), {x + away, -0.2f, random.uniform(-0.3f, 0.3f), x + away, 0.3f, -0.2f});
        beside.insert(beside.end(), {x + away + 0.1f, random.uniform(-0.2f, 0.2f), 0.3f});
    }
    step.m_cloth = looseTriangles(swapped ? slivers : beside);
    step.m_obstacle = looseTriangles(swapped ? beside : slivers);
    step.m_end = step.m_cloth.m_positions;
    return step;
}
}  // namespace

class NeedlesOnBackends : public BackendTest
{
protected:
    // Expects the contacts of all pairs of triangles.
    void expectSame(const StepCase& step, ContactMode mode)
    {
        SCOPED_TRACE(step.trace() + ", mode " + std::to_string(int(mode)));
        Settings settings = GetParam().m_settings;
        settings.m_mode = mode;
        Side cloth = makeSide({step.m_cloth});
        const Side obstacle = makeSide({step.m_obstacle});
        cloth.m_end = step.m_end;
        const float reach = step.m_thickness * (1 + settings.m_activation);
        const std::vector<Contact> expected = contactsOfAllPairs(cloth, obstacle, reach, std::uint32_t(mode));
        EXPECT_GT(expected.size(), 100u);
        const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
        ASSERT_TRUE(pipeline);
        const std::vector<Contact> contacts = runCase(*pipeline, step);
        EXPECT_TRUE(sameBytes(contacts, expected)) << difference(contacts, expected);
    }
};

TEST_P(NeedlesOnBackends, ContactsOfAllPairs)
{
    for (const ContactMode mode : {ContactMode::Discrete, ContactMode::Continuous, ContactMode::Automatic})
    {
        for (std::uint32_t seed = 550; seed < 556; ++seed)
            expectSame(needleCase(Thin(seed % 3), 60, 1.0f, seed % 2 == 0, seed), mode);
    }
}

// The planes' normals are too short for a float. Such a plane proves nothing about points beside it.
TEST_P(NeedlesOnBackends, SameContactsWhereAreasHaveNoLength)
{
    for (const ContactMode mode : {ContactMode::Discrete, ContactMode::Continuous})
    {
        for (const bool swapped : {false, true})
            expectSame(flatCase(swapped, 556), mode);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, NeedlesOnBackends, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
