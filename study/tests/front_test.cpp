// The front: a traversal that starts where the last one stopped finds what a full one finds, whatever moves; and it,
// like the queue of the single group, grows out of a buffer that is too small.
#include "study/traversal/front_traversal.h"

#include <gtest/gtest.h>

#include "study/kernel_programs.h"
#include "study/traversal/single_traversal.h"
#include "tests/support/cases.h"
#include "study/tests/traversals.h"

namespace drape::test
{
namespace
{
Sides fallingSides(const char* shape, int nodes, std::uint32_t seed)
{
    const StepCase step = fallingCase(shape, nodes, 0.02f, seed);
    Sides sides = {makeSide({step.m_cloth}), makeSide({step.m_obstacle}), {step.m_thickness}, {}, {}};
    sides.m_cloth.m_end = step.m_end;
    refitSides(sides);
    return sides;
}

// Small motion mostly; sometimes far away or back at once, everything together, or nothing.
void moveCloth(Side& cloth, const std::vector<float>& home, Random& random)
{
    switch (random.below(8))
    {
        case 0:
            cloth.m_end = home;
            break;
        case 1:
            translate(cloth.m_end, random.uniform(-0.5f, 0.5f), random.uniform(-1.0f, 1.0f),
                      random.uniform(-0.5f, 0.5f));
            break;
        case 2:
            break;
        case 3:
            for (float& coordinate : cloth.m_end)
                coordinate *= 0.1f;
            break;
        default:
            translate(cloth.m_end, 0.0f, random.uniform(-0.03f, 0.03f), 0.0f);
            disturb(cloth.m_end, 0.01f, random);
    }
    cloth.m_start = random.below(3) == 0 ? home : cloth.m_end;
}
}  // namespace

class FrontTest : public DeviceTest
{
};

TEST_P(FrontTest, ExactUnderAnyMotion)
{
    std::size_t found = 0, empty = 0;
    for (std::uint32_t seed = 500; seed < 504; ++seed)
    {
        Random random(seed);
        Sides sides = fallingSides("torus", 13 + int(seed % 5), seed);
        const std::vector<float> home = sides.m_cloth.m_end;
        HostRun host(Traversal::Front);
        DeviceRun device(*m_device, Traversal::Front);
        host.setTopology(sides);
        device.setTopology(sides);
        for (int step = 0; step < 40; ++step)
        {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
            moveCloth(sides.m_cloth, home, random);
            if (random.below(6) == 0) disturb(sides.m_obstacle.m_start, 0.05f, random);
            sides.m_obstacle.m_end = sides.m_obstacle.m_start;
            refitSides(sides);
            const std::vector<Candidate> brute = bruteForce(sides);
            host.upload(sides);
            device.upload(sides);
            ASSERT_TRUE(sameBytes(host.run(sides), brute));
            ASSERT_TRUE(sameBytes(device.run(brute.size()), brute));
            found += brute.size();
            empty += brute.empty();
        }
    }
    EXPECT_GT(found, 50000u);
    EXPECT_LT(empty, 100u);
}

// A topology that changes in between: the front of the old one is gone.
TEST_P(FrontTest, NewTopologyStartsAnew)
{
    HostRun host(Traversal::Front);
    DeviceRun device(*m_device, Traversal::Front);
    for (int size : {400, 30, 1, 700, 3})
    {
        SCOPED_TRACE("seed 510, " + std::to_string(size) + " triangles");
        const StepCase step = soupCase(size, 900 - size, true, 510);
        Sides sides = {makeSide({step.m_cloth}), makeSide({step.m_obstacle}), {step.m_thickness}, {}, {}};
        refitSides(sides);
        host.setTopology(sides);
        device.setTopology(sides);
        for (int run = 0; run < 3; ++run)
        {
            const std::vector<Candidate> brute = bruteForce(sides);
            EXPECT_TRUE(sameBytes(host.run(sides), brute));
            EXPECT_TRUE(sameBytes(device.run(brute.size()), brute));
        }
    }
}

TEST_P(FrontTest, OutgrownFrontIsDroppedAndKeptLater)
{
    Sides sides = fallingSides("sphere", 25, 520);
    const std::vector<Candidate> brute = bruteForce(sides);
    ASSERT_GT(brute.size(), 500u);
    const cl::Program program = studyPrograms(*m_device)("broad_phase_front");
    FrontTraversal* front = new FrontTraversal(*m_device, program, true, 10);
    DeviceRun device(*m_device, std::unique_ptr<DeviceTraversal>(front));
    device.setTopology(sides);
    EXPECT_TRUE(sameBytes(device.run(brute.size()), brute));
    EXPECT_FALSE(front->hasFront());
    const std::size_t demand = device.counters().m_front;
    EXPECT_GT(demand, brute.size());
    for (int run = 0; run < 3; ++run)
    {
        EXPECT_TRUE(sameBytes(device.run(brute.size()), brute));
        EXPECT_TRUE(front->hasFront());
        EXPECT_EQ(device.counters().m_front, demand);
    }
}

// A step that runs again because the list of candidates was too small starts from the same front.
TEST_P(FrontTest, RepeatedStepStartsFromTheSameFront)
{
    Sides sides = fallingSides("sphere", 25, 530);
    const std::vector<Candidate> brute = bruteForce(sides);
    DeviceRun once(*m_device, Traversal::Front);
    once.setTopology(sides);
    for (std::size_t capacity : {brute.size(), std::size_t(5), brute.size()})
    {
        const std::vector<Candidate> found = once.run(capacity);
        EXPECT_EQ(found.size(), capacity);
        EXPECT_EQ(once.counters().m_candidates, brute.size());
    }
}

// A cloth that hardly moves: fewer volumes are tested than from the start, on the host and on the device.
TEST_P(FrontTest, TestsFewerVolumesWhenLittleMoves)
{
    Sides sides = fallingSides("torus", 41, 540);
    HostRun host(Traversal::Front), hostFull(Traversal::Full);
    DeviceRun device(*m_device, Traversal::Front, true), deviceFull(*m_device, Traversal::Full, true);
    host.setTopology(sides);
    hostFull.setTopology(sides);
    device.setTopology(sides);
    deviceFull.setTopology(sides);
    std::size_t tests[4] = {};
    for (int step = 0; step < 17; ++step)
    {
        translate(sides.m_cloth.m_start, 0.0f, -0.001f, 0.0f);
        sides.m_cloth.m_end = sides.m_cloth.m_start;
        refitSides(sides);
        device.upload(sides);
        deviceFull.upload(sides);
        host.run(sides);
        hostFull.run(sides);
        device.run(1);
        deviceFull.run(1);
        if (step == 0) continue;  // there is no front yet
        tests[0] += host.volumeTests();
        tests[1] += hostFull.volumeTests();
        tests[2] += device.counters().m_visits;
        tests[3] += deviceFull.counters().m_visits;
    }
    EXPECT_LT(tests[0], tests[1] * 3 / 4);
    // A GPU's thousands of groups begin with so many fixed pairs that a scene as small as this one has nothing to save.
    if (!m_device->isGpu())
    {
        EXPECT_LT(tests[2], tests[3] * 3 / 4);
    }
    EXPECT_GT(tests[2], 10000u);
}

// The queue of the single group spills, and runs again with room for what spilled.
TEST_P(FrontTest, SingleGroupLosesNothingWhenItsQueueIsFull)
{
    Sides sides = fallingSides("torus", 33, 550);
    sides.m_thickness[0] = 0.2f;
    refitSides(sides);
    const std::vector<Candidate> brute = bruteForce(sides);
    const cl::Program program = studyPrograms(*m_device)("broad_phase_single");
    DeviceRun device(*m_device, std::unique_ptr<DeviceTraversal>(new SingleTraversal(*m_device, program, 7)));
    device.setTopology(sides);
    EXPECT_TRUE(sameBytes(device.run(brute.size()), brute));
    EXPECT_GT(device.counters().m_spill, 7u);
    EXPECT_GT(device.retries(), 0u);
    const std::size_t retries = device.retries();
    EXPECT_TRUE(sameBytes(device.run(brute.size()), brute));
    // A GPU's work-items come in another order each time, and a little more may spill.
    EXPECT_LE(device.retries(), retries + (m_device->isGpu() ? 1 : 0));
}

INSTANTIATE_TEST_SUITE_P(Devices, FrontTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
