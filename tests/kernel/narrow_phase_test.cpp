// Narrow phase and compaction on a device: the host's contacts bit for bit, demands counted, cloth features' counts
// left clean for the next step.
#include "bullet_plugin/core/narrow_phase/narrow_phase.h"

#include <gtest/gtest.h>

#include "bullet_plugin/core/compaction/canonical_order.h"
#include "bullet_plugin/core/compaction/compaction.h"
#include "tests/support/cases.h"
#include "tests/support/device_side.h"

namespace drape::test
{
namespace
{
// One device with both stages and the buffers of one case; every pair of triangles is a candidate.
class DeviceNarrowPhase
{
public:
    DeviceNarrowPhase(Device& device, const StepCase& step)
        : m_device(device), m_cloth(makeSide({step.m_cloth})), m_obstacle(makeSide({step.m_obstacle}))
    {
        m_cloth.m_end = step.m_end;
        const ProgramLoader load = [&](const char* name) { return programOf(device, name); };
        m_stage.create(device, load, false);
        m_compaction.create(device, load);
        m_thickness = {step.m_thickness};
        m_pairs = allPairs(m_cloth, m_obstacle);
        m_compaction.resizeSlots(
            device, m_cloth.m_pool.vertexCount() + m_cloth.m_pool.triangles().size() + m_cloth.m_pool.edges().size());
        m_clothBuffers.upload(device, m_cloth);
        m_obstacleBuffers.upload(device, m_obstacle);
        guardCopy(device, m_thicknessBuffer, m_thickness);
    }

    // Runs with the first `count` candidates. Contacts that fit are read back.
    std::vector<Contact> run(std::size_t count, StepCounters& counters)
    {
        guardCopy(m_device, m_candidates, m_pairs);
        std::vector<StepCounters> start(1);
        start[0].m_candidates = cl_uint(count);
        Buffer<StepCounters> counterBuffer, next;
        guardCopy(m_device, counterBuffer, start);
        guardCopy(m_device, next, start);
        guard(m_device, m_compaction.contacts(), DRAPE_CONTACT_HEAD + m_compaction.hitCapacity());
        m_stage.enqueue(m_device, sides(), m_cloth.m_pool.vertexCount(), m_cloth.m_pool.triangles().size(), settings(),
                        m_candidates, m_compaction.hits(), counterBuffer);
        m_compaction.enqueue(m_device, {counterBuffer, next});
        counters = readCounters(m_device, counterBuffer);
        const std::size_t fitting = std::min<std::size_t>(counters.m_hits, m_compaction.hitCapacity());
        std::vector<Contact> contacts = contents(m_device, m_compaction.contacts(), DRAPE_CONTACT_HEAD + fitting);
        EXPECT_EQ(std::memcmp(contacts.data(), &counters, sizeof(counters)), 0) << "the head";
        contacts.erase(contacts.begin(), contacts.begin() + DRAPE_CONTACT_HEAD);
        EXPECT_TRUE(intact(m_device, m_compaction.contacts()) && intact(m_device, counterBuffer) &&
                    intact(m_device, m_candidates));
        EXPECT_TRUE(intact(m_device, next) && sameBytes(contents(m_device, next, 1), std::vector<StepCounters>(1)));
        EXPECT_TRUE(m_clothBuffers.allIntact(m_device) && m_obstacleBuffers.allIntact(m_device));
        EXPECT_FALSE(m_device.failed()) << m_device.error().text();
        return contacts;
    }

    std::vector<Contact> host(std::size_t count) const
    {
        std::vector<Contact> contacts;
        const std::vector<Candidate> some(m_pairs.begin(), m_pairs.begin() + std::ptrdiff_t(count));
        narrowPhaseOnHost(some, m_cloth.cloth(), m_obstacle.obstacle(), settings(), contacts);
        return contacts;
    }

    std::vector<Candidate> intersections(std::size_t capacity, std::size_t& demand)
    {
        m_stage.reserveIntersections(m_device, 1);
        guard(m_device, m_stage.intersections(), capacity);
        guardCopy(m_device, m_candidates, m_pairs);
        std::vector<StepCounters> start(1);
        start[0].m_candidates = cl_uint(m_pairs.size());
        Buffer<StepCounters> counterBuffer;
        guardCopy(m_device, counterBuffer, start);
        m_stage.enqueueIntersect(m_device, sides(), m_candidates, counterBuffer);
        demand = readCounters(m_device, counterBuffer).m_intersections;
        std::vector<Candidate> found =
            contents(m_device, m_stage.intersections(), std::min(demand, m_stage.intersections().capacity()));
        EXPECT_TRUE(intact(m_device, m_stage.intersections()));
        sortCandidates(found);
        return found;
    }

    NarrowPhaseSettings settings() const { return {m_thickness, 1, 1.5f}; }
    NarrowPhaseBuffers sides()
    {
        return {m_clothBuffers.m_start,
                m_clothBuffers.m_end,
                m_clothBuffers.m_triangles,
                m_clothBuffers.m_edges,
                m_obstacleBuffers.m_start,
                m_obstacleBuffers.m_triangles,
                m_obstacleBuffers.m_vertexCones,
                m_obstacleBuffers.m_edgeCones,
                m_thicknessBuffer,
                m_motions};
    }

    Device& m_device;
    Side m_cloth, m_obstacle;
    NarrowPhaseStage m_stage;
    CompactionStage m_compaction;
    DeviceSide m_clothBuffers, m_obstacleBuffers;
    std::vector<float> m_thickness;
    std::vector<Candidate> m_pairs;
    Buffer<float> m_thicknessBuffer;
    Buffer<ObstacleMotion> m_motions;  // none
    Buffer<Candidate> m_candidates;
};
}  // namespace

class NarrowPhaseTest : public DeviceTest
{
};

TEST_P(NarrowPhaseTest, ContactsAreTheHostsAtEverySize)
{
    DeviceNarrowPhase stage(*m_device, soupCase(161, 183, true, 80));
    const std::size_t all = stage.m_pairs.size();
    stage.m_compaction.reserveHits(*m_device, stage.host(all).size() + 1);
    for (std::size_t count :
         {std::size_t(0), std::size_t(1), std::size_t(63), std::size_t(64), std::size_t(65), std::size_t(1023), all})
    {
        SCOPED_TRACE("seed 80, candidates " + std::to_string(count));
        StepCounters counters;
        const std::vector<Contact> host = stage.host(count), device = stage.run(count, counters);
        EXPECT_EQ(counters.m_hits, host.size());
        EXPECT_TRUE(sameBytes(device, host)) << difference(device, host);
    }
    EXPECT_GT(stage.host(all).size(), 100u);
}

TEST_P(NarrowPhaseTest, ContactsAreTheHostsOnShapes)
{
    for (const char* shape : {"sphere", "stairs"})
    {
        const StepCase step = fallingCase(shape, 12, 0.03f, 81);
        SCOPED_TRACE(step.trace());
        DeviceNarrowPhase stage(*m_device, step);
        const std::vector<Contact> host = stage.host(stage.m_pairs.size());
        stage.m_compaction.reserveHits(*m_device, host.size());
        StepCounters counters;
        const std::vector<Contact> device = stage.run(stage.m_pairs.size(), counters);
        EXPECT_TRUE(sameBytes(device, host)) << difference(device, host);
        EXPECT_GT(host.size(), 100u);
    }
}

TEST_P(NarrowPhaseTest, FullListsCountOnAndTheNextStepIsClean)
{
    DeviceNarrowPhase stage(*m_device, soupCase(120, 150, true, 82));
    const std::size_t all = stage.m_pairs.size();
    const std::vector<Contact> host = stage.host(all);
    ASSERT_GT(host.size(), 60u);
    for (std::size_t capacity : {std::size_t(1), std::size_t(13), host.size() / 2, host.size() - 1})
    {
        SCOPED_TRACE("seed 82, capacity " + std::to_string(capacity));
        stage.m_compaction.reserveHits(*m_device, capacity);
        StepCounters counters;
        stage.run(all, counters);
        EXPECT_EQ(counters.m_listed, host.size());
    }
    stage.m_compaction.reserveHits(*m_device, host.size());
    for (int step = 0; step < 3; ++step)
    {
        StepCounters counters;
        stage.run(0, counters);
        EXPECT_EQ(counters.m_hits, 0u);
        const std::vector<Contact> device = stage.run(all, counters);
        EXPECT_TRUE(sameBytes(device, host)) << difference(device, host);
    }
}

TEST_P(NarrowPhaseTest, IntersectionsAreTheHosts)
{
    DeviceNarrowPhase stage(*m_device, soupCase(60, 70, false, 83));
    SCOPED_TRACE("seed 83");
    std::vector<Candidate> host;
    intersectOnHost(stage.m_pairs, stage.m_cloth.cloth(), stage.m_obstacle.obstacle(), {}, host);
    ASSERT_GT(host.size(), 5u);
    std::size_t demand = 0;
    EXPECT_TRUE(sameBytes(stage.intersections(host.size(), demand), host));
    EXPECT_EQ(demand, host.size());
    EXPECT_EQ(stage.intersections(2, demand).size(), 2u);
    EXPECT_EQ(demand, host.size());
}

INSTANTIATE_TEST_SUITE_P(Devices, NarrowPhaseTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
