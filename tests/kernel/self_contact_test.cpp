// The kernels of self-collision, one after the other. They list the host's pairs, each once. The demand past a full
// list is the true one, and nothing is written behind a buffer.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "bullet_plugin/core/ordering/canonical_order.h"
#include "bullet_plugin/core/cloth_cloth/self_contacts.h"
#include "bullet_plugin/core/scene/patch_width.h"
#include "reference/self_pairs.h"
#include "tests/support/device_side.h"
#include "tests/support/self_cases.h"
#include "tests/support/feature_sums.h"

namespace drape::test
{
namespace
{
constexpr float kReachScale = 1.5f;

using Key = std::tuple<cl_uint, cl_uint, cl_uint>;

std::vector<Key> keysOf(const std::vector<FeatureTest>& tests)
{
    std::vector<Key> keys;
    for (const FeatureTest& test : tests)
        keys.emplace_back(test.m_motion, test.m_cloth, test.m_lane);
    std::sort(keys.begin(), keys.end());
    return keys;
}

class DeviceSelf
{
public:
    DeviceSelf(Device& device, const SelfStepCase& step)
        : m_device(device), m_side(makeSide({step.m_motion.m_mesh})), m_rest(step.m_rest)
    {
        m_side.m_end = step.m_motion.m_end;
        m_reach = {{step.m_thickness}, {selfGrowth(step.m_thickness * kReachScale)}};
        m_stage.create(device, [&](const char* name) { return programOf(device, name, patchDefines(device)); });
        m_buffers.upload(device, m_side);
        guardCopy(device, m_obstacleRadius, std::vector<float>{-1.0f});
        m_stage.setTopology(device, m_side.m_pool, m_rest);
        m_stage.setReach(device, m_reach);
        device.wait();
    }

    SelfContactStage::Input input() const
    {
        return {m_buffers.buffers(), m_obstacleRadius, DRAPE_AUTOMATIC, kReachScale, std::size_t(1) << 30};
    }

    std::vector<FeatureTest> cull(std::size_t capacity)
    {
        clearCounters(m_device, m_counters);
        guard(m_device, m_stage.tests().m_tests, capacity);
        if (m_pairCapacity > 0) guard(m_device, m_stage.pairs(), m_pairCapacity);
        m_stage.enqueueCull(m_device, input(), m_counters);
        m_read = readCounters(m_device, m_counters);
        EXPECT_TRUE(intact(m_device, m_stage.tests().m_tests) && intact(m_device, m_counters));
        EXPECT_TRUE(m_pairCapacity == 0 || intact(m_device, m_stage.pairs()));
        EXPECT_TRUE(m_buffers.allIntact(m_device) && intact(m_device, m_obstacleRadius));
        return contents(m_device, m_stage.tests().m_tests,
                        std::min<std::size_t>(m_read.m_selfTests, m_stage.tests().capacity()));
    }

    // Contacts from the tests of the last cull, in no order, behind `behind` others; with room for `room`, as many as
    // fit.
    std::vector<Contact> contacts(std::size_t behind, std::size_t room = SIZE_MAX)
    {
        const MeshPool& pool = m_side.m_pool;
        const std::size_t tests = std::min<std::size_t>(m_read.m_selfTests, m_stage.tests().capacity());
        const std::size_t features = 2 * (pool.vertexCount() + pool.triangles().size() + pool.edges().size());
        UnsortedContacts list;
        EXPECT_LE(features, DRAPE_MOST_SUMMED);
        m_read.m_contactsFound = cl_uint(behind);
        guardCopy(m_device, m_counters, std::vector<StepCounters>{m_read});
        list.resizeFeatures(m_device, features);
        guard(m_device, list.m_contacts, behind + std::min(tests, room));
        const std::size_t sums = list.sums();
        if (sums > 0) guard(m_device, list.m_ranks, behind + std::min(tests, room));
        guardCopy(m_device, list.m_featureCounts, std::vector<cl_uint>(list.m_featureCounts.capacity(), 0));
        m_stage.enqueueContacts(m_device, input(), list, m_counters);
        m_read = readCounters(m_device, m_counters);
        EXPECT_TRUE(intact(m_device, list.m_contacts) && intact(m_device, list.m_featureCounts) &&
                    intact(m_device, m_counters));
        const std::size_t listed = std::min<std::size_t>(m_read.m_contactsFound, behind + std::min(tests, room));
        std::vector<Contact> all = contents(m_device, list.m_contacts, listed);
        all.erase(all.begin(), all.begin() + std::ptrdiff_t(behind));
        std::vector<cl_uint> expected(features, 0);
        for (const Contact& contact : all)
            ++expected[contact.m_featureIndex];
        EXPECT_EQ(sums > 0, m_device.isGpu());  // elsewhere nobody asks for them
        std::vector<cl_uint> counts = contents(m_device, list.m_featureCounts, list.m_featureCounts.capacity());
        if (sums > 0)
        {
            expectRanks(all, contents(m_device, list.m_ranks, behind + all.size()), behind);
            EXPECT_EQ(std::vector<cl_uint>(counts.begin() + std::ptrdiff_t(sums), counts.end()),
                      featureSumsOf(expected));
            EXPECT_TRUE(intact(m_device, list.m_ranks));
        }
        counts.resize(features);
        EXPECT_EQ(counts, expected);
        return all;
    }

    std::vector<Contact> onHost()
    {
        const MeshPool& pool = m_side.m_pool;
        const ClothView cloth = clothView(m_side.m_start.data(), m_side.m_end.data(), pool.triangles().data(),
                                          pool.edges().data(), std::uint32_t(pool.vertexCount()),
                                          std::uint32_t(pool.triangles().size()), DRAPE_AUTOMATIC, nullptr);
        const SelfStep step = {pool, selfView(cloth, m_rest.data(), kReachScale), m_reach, m_reach.m_radius};
        std::vector<Contact> contacts;
        m_candidates = HostSelfTrees().run(step, {}, contacts).m_candidates;
        return contacts;
    }

    // Room for pairs of patches; 0 keeps the stage's own.
    std::size_t m_pairCapacity = 0;
    StepCounters m_read = {};
    std::uint64_t m_candidates = 0;

private:
    // Expects that each contact has its own rank among those of its feature.
    static void expectRanks(const std::vector<Contact>& contacts, const std::vector<cl_uint>& ranks, std::size_t behind)
    {
        std::map<cl_uint, std::set<cl_uint>> ofFeature;
        for (std::size_t i = 0; i < contacts.size(); ++i)
            EXPECT_TRUE(ofFeature[contacts[i].m_featureIndex].insert(ranks[behind + i]).second)
                << "feature " << contacts[i].m_featureIndex;
        for (const auto& [feature, taken] : ofFeature)
            EXPECT_EQ(*taken.rbegin() + 1, taken.size()) << "feature " << feature;
    }

    Device& m_device;
    Side m_side;
    std::vector<float> m_rest;
    SelfReach m_reach;
    SelfContactStage m_stage;
    DeviceCloths m_buffers;
    Buffer<float> m_obstacleRadius;
    Buffer<StepCounters> m_counters;
};
}  // namespace

class SelfContactTest : public DeviceTest
{
};

TEST_P(SelfContactTest, ListsEachPairOnceAndFindsTheHostsContacts)
{
    for (const SelfStepCase& step : selfStepCases())
    {
        if (step.m_motion.m_mesh.m_triangles.empty()) continue;
        SCOPED_TRACE(step.m_motion.m_name);
        DeviceSelf self(*m_device, step);
        std::vector<Contact> expected = self.onHost();
        std::vector<Key> keys = keysOf(self.cull(std::max<std::size_t>(1, self.m_candidates)));
        EXPECT_EQ(self.m_read.m_selfTests, self.m_candidates);
        EXPECT_TRUE(std::adjacent_find(keys.begin(), keys.end()) == keys.end());
        std::vector<Contact> found = self.contacts(5);
        sortContacts(found);
        EXPECT_TRUE(sameBytes(found, expected)) << difference(found, expected);
    }
}

TEST_P(SelfContactTest, FullListsSayWhatThereIs)
{
    DeviceSelf self(*m_device, foldedCase(25, 4, 0.003f, 130));
    self.onHost();
    const std::vector<Key> all = keysOf(self.cull(self.m_candidates));
    for (const std::size_t capacity :
         {std::size_t(1), std::size_t(self.m_candidates / 3), std::size_t(self.m_candidates - 1)})
    {
        const std::vector<Key> some = keysOf(self.cull(capacity));
        EXPECT_EQ(self.m_read.m_selfTests, self.m_candidates);
        EXPECT_EQ(some.size(), capacity);
        EXPECT_TRUE(std::includes(all.begin(), all.end(), some.begin(), some.end()));
        self.contacts(0);
    }
}

TEST_P(SelfContactTest, FullListsOfHitsCountOn)
{
    DeviceSelf self(*m_device, foldedCase(25, 4, 0.003f, 130));
    std::vector<Contact> expected = self.onHost();
    ASSERT_GT(expected.size(), 60u);
    for (const std::size_t room : {std::size_t(1), expected.size() / 3, expected.size() - 1})
    {
        self.cull(self.m_candidates);
        const std::vector<Contact> some = self.contacts(2, room);
        EXPECT_EQ(some.size(), room);
        EXPECT_EQ(self.m_read.m_contactsFound, 2 + expected.size());
    }
}

// GPUs list pairs of patches.
TEST_P(SelfContactTest, FullListsOfPatchesCountOn)
{
    DeviceSelf self(*m_device, foldedCase(25, 4, 0.003f, 130));
    self.onHost();
    self.cull(self.m_candidates);
    const std::uint32_t pairs = self.m_read.m_selfPairs;
    EXPECT_EQ(pairs > 0, m_device->isGpu());
    for (const std::size_t capacity : {std::size_t(1), std::size_t(pairs / 2)})
    {
        if (pairs == 0) break;
        self.m_pairCapacity = capacity;
        const std::vector<Key> some = keysOf(self.cull(self.m_candidates));
        EXPECT_EQ(self.m_read.m_selfPairs, pairs);
        EXPECT_LT(some.size(), self.m_candidates);
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, SelfContactTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
