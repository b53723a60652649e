// Contacts of pairs of triangles and ordering on a device: the host's contacts bit for bit, demands counted, cloth
// features' counts left clean for the next step.
#include "study/step/pair_stage.h"

#include <gtest/gtest.h>

#include "bullet_plugin/core/ordering/ordering.h"
#include "reference/pair_contacts.h"
#include "study/kernel_programs.h"
#include "tests/support/cases.h"
#include "tests/support/device_side.h"

namespace drape::test
{
namespace
{
// One device with both stages and the buffers of one case; every pair of triangles is a candidate.
class DevicePairs
{
public:
    DevicePairs(Device& device, const StepCase& step)
        : m_device(device), m_cloth(makeSide({step.m_cloth})), m_obstacle(makeSide({step.m_obstacle}))
    {
        m_cloth.m_end = step.m_end;
        const ProgramLoader load = studyPrograms(device);
        m_stage.create(device, load);
        m_ordering.create(device, load);
        m_thickness = {step.m_thickness};
        m_pairs = allPairs(m_cloth, m_obstacle);
        const MeshPool& pool = m_cloth.m_pool;
        const std::size_t features = pool.vertexCount() + pool.triangles().size() + pool.edges().size();
        m_unsorted.resizeFeatures(device, features);
        m_ordering.resizeFeatures(device, features);
        m_clothNodes.upload(device, m_cloth);
        m_clothBuffers.upload(device, m_cloth);
        m_obstacleBuffers.upload(device, m_obstacle);
        guardCopy(device, m_thicknessBuffer, m_thickness);
    }

    void reserve(std::size_t contacts)
    {
        m_unsorted.reserve(m_device, contacts);
        m_ordering.reserve(m_device, contacts);
    }

    // Runs with the first `count` candidates. Contacts that fit are read back.
    std::vector<Contact> run(std::size_t count, StepCounters& counters)
    {
        guardCopy(m_device, m_candidates, m_pairs);
        const std::vector<StepCounters> start(1);
        std::vector<TraversalCounters> found(1);
        found[0].m_candidates = cl_uint(count);
        Buffer<TraversalCounters> foundBuffer;
        guardCopy(m_device, foundBuffer, found);
        Buffer<StepCounters> counterBuffer, next;
        guardCopy(m_device, counterBuffer, start);
        guardCopy(m_device, next, start);
        guard(m_device, m_ordering.contacts(), DRAPE_CONTACT_HEAD + m_unsorted.capacity());
        m_stage.enqueue(m_device, sides(), m_candidates, foundBuffer, m_unsorted, counterBuffer);
        m_ordering.enqueue(m_device, m_unsorted, {counterBuffer, next});
        counters = readCounters(m_device, counterBuffer);
        const std::size_t fitting = std::min<std::size_t>(counters.m_contactsStored, m_unsorted.capacity());
        std::vector<Contact> contacts = contents(m_device, m_ordering.contacts(), DRAPE_CONTACT_HEAD + fitting);
        EXPECT_EQ(std::memcmp(contacts.data(), &counters, sizeof(counters)), 0) << "the head";
        contacts.erase(contacts.begin(), contacts.begin() + DRAPE_CONTACT_HEAD);
        EXPECT_TRUE(intact(m_device, m_ordering.contacts()) && intact(m_device, counterBuffer) &&
                    intact(m_device, m_candidates));
        EXPECT_TRUE(intact(m_device, next) && sameBytes(contents(m_device, next, 1), std::vector<StepCounters>(1)));
        EXPECT_TRUE(m_clothNodes.allIntact(m_device) && m_clothBuffers.allIntact(m_device) &&
                    m_obstacleBuffers.allIntact(m_device));
        EXPECT_FALSE(m_device.failed()) << m_device.error().text();
        return contacts;
    }

    std::vector<Contact> host(std::size_t count) const
    {
        std::vector<Contact> contacts;
        const std::vector<Candidate> some(m_pairs.begin(), m_pairs.begin() + std::ptrdiff_t(count));
        contactsOfPairs(some, m_cloth.cloth(), m_obstacle.obstacle(), settings(), contacts);
        return contacts;
    }

    PairSettings settings() const { return {m_thickness, 1, 1.5f}; }
    PairSides sides()
    {
        const ClothBuffers cloths = m_clothBuffers.buffers();
        return {m_clothNodes.m_start,
                m_clothNodes.m_end,
                cloths.m_topology,
                cloths.m_layout,
                m_obstacleBuffers.buffers(),
                m_thicknessBuffer,
                1,
                settings().m_reachScale,
                settings().m_mode};
    }

    Device& m_device;
    Side m_cloth, m_obstacle;
    PairStage m_stage;
    OrderingStage m_ordering;
    UnsortedContacts m_unsorted;
    DeviceSide m_clothNodes;
    DeviceCloths m_clothBuffers;
    DeviceObstacles m_obstacleBuffers;
    std::vector<float> m_thickness;
    std::vector<Candidate> m_pairs;
    Buffer<float> m_thicknessBuffer;
    Buffer<Candidate> m_candidates;
};
}  // namespace

class PairStageTest : public DeviceTest
{
};

TEST_P(PairStageTest, ContactsAreTheHostsAtEverySize)
{
    DevicePairs stage(*m_device, soupCase(161, 183, true, 80));
    const std::size_t all = stage.m_pairs.size();
    stage.reserve(stage.host(all).size() + 1);
    for (std::size_t count :
         {std::size_t(0), std::size_t(1), std::size_t(63), std::size_t(64), std::size_t(65), std::size_t(1023), all})
    {
        SCOPED_TRACE("seed 80, candidates " + std::to_string(count));
        StepCounters counters;
        const std::vector<Contact> host = stage.host(count), device = stage.run(count, counters);
        EXPECT_EQ(counters.m_contactsStored, host.size());
        EXPECT_TRUE(sameBytes(device, host)) << difference(device, host);
    }
    EXPECT_GT(stage.host(all).size(), 100u);
}

TEST_P(PairStageTest, ContactsAreTheHostsOnShapes)
{
    for (const char* shape : {"sphere", "stairs"})
    {
        const StepCase step = fallingCase(shape, 12, 0.03f, 81);
        SCOPED_TRACE(step.trace());
        DevicePairs stage(*m_device, step);
        const std::vector<Contact> host = stage.host(stage.m_pairs.size());
        stage.reserve(host.size());
        StepCounters counters;
        const std::vector<Contact> device = stage.run(stage.m_pairs.size(), counters);
        EXPECT_TRUE(sameBytes(device, host)) << difference(device, host);
        EXPECT_GT(host.size(), 100u);
    }
}

TEST_P(PairStageTest, FullListsCountOnAndTheNextStepIsClean)
{
    DevicePairs stage(*m_device, soupCase(120, 150, true, 82));
    const std::size_t all = stage.m_pairs.size();
    const std::vector<Contact> host = stage.host(all);
    ASSERT_GT(host.size(), 60u);
    for (std::size_t capacity : {std::size_t(1), std::size_t(13), host.size() / 2, host.size() - 1})
    {
        SCOPED_TRACE("seed 82, capacity " + std::to_string(capacity));
        stage.reserve(capacity);
        StepCounters counters;
        stage.run(all, counters);
        EXPECT_EQ(counters.m_contactsFound, host.size());
    }
    stage.reserve(host.size());
    for (int step = 0; step < 3; ++step)
    {
        StepCounters counters;
        stage.run(0, counters);
        EXPECT_EQ(counters.m_contactsStored, 0u);
        const std::vector<Contact> device = stage.run(all, counters);
        EXPECT_TRUE(sameBytes(device, host)) << difference(device, host);
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, PairStageTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
