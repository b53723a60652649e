// Ordering by itself: contacts in any order come out by feature and obstacle feature, whatever the sizes and the
// crowding.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <tuple>

#include "bullet_plugin/core/device/bound_kernel.h"
#include "kernels/ordering/ordering_bindings.h"
#include "tests/support/cases.h"
#include "tests/support/device_side.h"
#include "tests/support/feature_sums.h"

namespace drape::test
{
namespace
{
constexpr std::size_t kGroup = 64;
constexpr std::size_t kBlock = 1024;  // equals the value in kernels/ordering/ordering.cl
constexpr cl_uint kRankedGpu = 512;   // equals the value in ordering.cpp

// Contacts with distinct obstacle features per feature, in random order. crowded: most of them in one feature.
std::vector<Contact> randomContacts(std::size_t count, std::uint32_t features, bool crowded, Random& random)
{
    std::vector<Contact> contacts(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        contacts[i].m_featureIndex = crowded && i % 8 ? features / 2 : random.below(features);
        contacts[i].m_obstacleFeature = std::uint32_t(i) * 2654435761u;
        contacts[i].m_gap1 = float(i);
    }
    for (std::size_t i = count; i > 1; --i)
        std::swap(contacts[i - 1], contacts[random.below(std::uint32_t(i))]);
    return contacts;
}

bool inOrder(const Contact& a, const Contact& b)
{
    return std::tie(a.m_featureIndex, a.m_obstacleFeature) < std::tie(b.m_featureIndex, b.m_obstacleFeature);
}

class Ordering
{
public:
    explicit Ordering(Device& device) : m_device(device)
    {
        const cl::Program program = programOf(device, "ordering/ordering");
        m_count.create(device, program);
        m_place.create(device, program);
        m_gather.create(device, program);
        m_sort.create(device, program);
        m_write.create(device, program);
        m_gatherSmall.create(device, programOf(device, "ordering/ordering_small"));
    }

    std::vector<Contact> run(const std::vector<Contact>& contacts, std::uint32_t features)
    {
        std::vector<cl_uint> featureCounts(features, 0);
        for (const Contact& contact : contacts)
            ++featureCounts[contact.m_featureIndex];
        const std::size_t blocks = (features + kBlock - 1) / kBlock;
        const cl_uint capacity = prepare(contacts, featureCounts, 0);
        guard(m_device, m_blockCount, blocks);
        const OrderingValues values = {capacity, features, m_ranked, 0, 1, m_parts};
        m_count.launch(m_device, blocks * kGroup, kGroup, values, m_featureCounts, m_blockCount, kGroup);
        m_place.launch(m_device, blocks * kGroup, kGroup, values, m_featureCounts, m_blockCount, m_featureFirsts,
                       m_counters, kGroup);
        const auto isCrowded = [&](cl_uint count) { return count > m_ranked; };
        EXPECT_EQ(contents(m_device, m_counters, 1)[0].m_crowded,
                  cl_uint(std::count_if(featureCounts.begin(), featureCounts.end(), isCrowded)));
        expectFirstsWithoutSums(features);
        m_gather.launch(m_device, 4 * kGroup, kGroup, values, m_unsorted, m_featureCounts, m_featureFirsts, m_members,
                        m_keys, m_counters, m_next);
        enqueueOrderAndWrite(features, capacity, 0);
        expectClean(m_featureCounts, features);
        EXPECT_TRUE(intact(m_device, m_unsorted) && intact(m_device, m_featureCounts) &&
                    intact(m_device, m_featureFirsts) && intact(m_device, m_blockCount) &&
                    intact(m_device, m_members) && intact(m_device, m_keys) && intact(m_device, m_contacts));
        EXPECT_TRUE(sameBytes(contents(m_device, m_next, 1), std::vector<StepCounters>(1)))
            << "counters are clean after";
        EXPECT_TRUE(intact(m_device, m_next));
        const std::size_t count = contents(m_device, m_counters, 1)[0].m_contactsStored;
        std::vector<Contact> found =
            contents(m_device, m_contacts, DRAPE_CONTACT_HEAD + std::min(count, contacts.size()));
        found.erase(found.begin(), found.begin() + DRAPE_CONTACT_HEAD);
        return found;
    }

    // Runs the variant in which every work-item sums for itself.
    std::vector<Contact> runSmall(const std::vector<Contact>& contacts, std::uint32_t features)
    {
        const cl_uint capacity = enqueueSmall(contacts, features);
        enqueueOrderAndWrite(features, capacity, sumsBehind(features));
        const cl_uint sums = sumsBehind(features);
        std::vector<cl_uint> left = contents(m_device, m_featureCounts, sums + DRAPE_FEATURE_SUMS);
        left.erase(left.begin() + std::ptrdiff_t(features), left.begin() + std::ptrdiff_t(sums));  // not in use
        EXPECT_EQ(std::count(left.begin(), left.end(), 0u), std::ptrdiff_t(left.size())) << "clean after";
        expectIntact();
        return written(contacts.size());
    }

    // Features that one group sorts; contacts of a feature from which on it does; work-items that copy a contact.
    cl_uint m_sortBlock = kBlock, m_ranked = DRAPE_RANKED, m_parts = 1;
    // Contacts that a list had no room for, where work-items sum for themselves.
    cl_uint m_unlisted = 0;

    // Expects run() to order the contacts on a CPU and on a GPU, and with work-items in pairs.
    void expectOrdered(const std::vector<Contact>& contacts, std::uint32_t features)
    {
        std::vector<Contact> ordered = contacts;
        std::sort(ordered.begin(), ordered.end(), inOrder);
        for (const cl_uint parts : {1u, 2u, 4u})
        {
            m_parts = parts;
            m_ranked = parts == 1 ? DRAPE_RANKED : kRankedGpu;
            const std::vector<Contact> found = run(contacts, features);
            ASSERT_TRUE(sameBytes(found, ordered)) << parts << " parts: " << difference(found, ordered);
            if (features > DRAPE_MOST_SUMMED) continue;
            const std::vector<Contact> few = runSmall(contacts, features);
            ASSERT_TRUE(sameBytes(few, ordered)) << parts << " parts, few features: " << difference(few, ordered);
        }
    }

    // Returns the time of the kernels for contacts of one feature. The device must be opened with profiling.
    double orderMs(const std::vector<Contact>& contacts)
    {
        m_device.profiler()->take();
        run(contacts, 1);
        return totalMs(m_device.profiler()->take());
    }

private:
    // Makes the buffers of a step whose list has these contacts and had no room for `unlisted` others. Returns the
    // list's room.
    cl_uint prepare(const std::vector<Contact>& contacts, const std::vector<cl_uint>& featureCounts, cl_uint unlisted)
    {
        const cl_uint capacity = cl_uint(std::max<std::size_t>(1, contacts.size()));
        std::vector<StepCounters> start(1);
        start[0].m_contactsFound = cl_uint(contacts.size()) + unlisted;
        guardCopy(m_device, m_unsorted, contacts);
        guardCopy(m_device, m_featureCounts, featureCounts);
        guardCopy(m_device, m_counters, start);
        guardCopy(m_device, m_next, start);
        guard(m_device, m_featureFirsts, featureCounts.size());
        guard(m_device, m_members, capacity);
        guard(m_device, m_keys, capacity);
        guard(m_device, m_contacts, DRAPE_CONTACT_HEAD + capacity);
        return capacity;
    }

    // Runs the stage up to the members' list. Returns the room of the contacts' list.
    cl_uint enqueueSmall(const std::vector<Contact>& contacts, std::uint32_t features)
    {
        std::vector<cl_uint> featureCounts(features, 0), ranks;
        for (const Contact& contact : contacts)
            ranks.push_back(featureCounts[contact.m_featureIndex]++);
        const cl_uint capacity = prepare(contacts, featureCounts, m_unlisted);
        ranks.resize(capacity);
        guardCopy(m_device, m_ranks, ranks);
        const std::vector<cl_uint> sums = featureSumsOf(featureCounts);
        std::vector<cl_uint> numbers = featureCounts;
        numbers.resize(sumsBehind(features), 0);
        numbers.insert(numbers.end(), sums.begin(), sums.end());
        guardCopy(m_device, m_featureCounts, numbers);
        const OrderingValues values = {capacity, features, m_ranked, sumsBehind(features), 0, m_parts};
        m_gatherSmall.launch(m_device, 4 * kGroup, kGroup, values, m_unsorted, m_ranks, m_featureCounts,
                             m_featureFirsts, m_members, m_keys, m_counters, m_next);
        const auto isCrowded = [&](cl_uint count) { return count > m_ranked; };
        EXPECT_EQ(contents(m_device, m_counters, 1)[0].m_crowded,
                  cl_uint(std::count_if(featureCounts.begin(), featureCounts.end(), isCrowded)));
        EXPECT_TRUE(sameBytes(contents(m_device, m_next, 1), std::vector<StepCounters>(1)))
            << "counters are clean after";
        return capacity;
    }

    // Returns the position of the sums behind the numbers of so many features, in whole rows.
    static cl_uint sumsBehind(std::uint32_t features)
    {
        return (features + DRAPE_SUMMED - 1) / DRAPE_SUMMED * DRAPE_SUMMED;
    }

    void enqueueOrderAndWrite(std::uint32_t features, cl_uint capacity, cl_uint sums)
    {
        const OrderingValues values = {capacity, features, m_ranked, sums, m_sortBlock, m_parts};
        m_sort.launch(m_device, (features + m_sortBlock - 1) / m_sortBlock * kGroup, kGroup, values, m_featureFirsts,
                      m_members, m_keys, m_counters);
        m_write.launch(m_device, 4 * kGroup, kGroup, values, m_unsorted, m_featureFirsts, m_members, m_keys, m_contacts,
                       m_counters, m_featureCounts);
    }

    void expectClean(Buffer<cl_uint>& numbers, std::size_t count)
    {
        const std::vector<cl_uint> left = contents(m_device, numbers, count);
        EXPECT_EQ(std::count(left.begin(), left.end(), 0u), std::ptrdiff_t(count)) << "clean after";
    }

    void expectIntact()
    {
        for (Buffer<cl_uint>* numbers : {&m_members, &m_keys, &m_featureFirsts, &m_featureCounts, &m_ranks})
            EXPECT_TRUE(intact(m_device, *numbers));
        EXPECT_TRUE(intact(m_device, m_contacts) && intact(m_device, m_next));
    }

    // Returns the contacts; their head must contain `count`.
    std::vector<Contact> written(std::size_t count)
    {
        std::vector<Contact> found = contents(m_device, m_contacts, DRAPE_CONTACT_HEAD + count);
        StepCounters head;
        std::memcpy(&head, found.data(), sizeof(head));
        EXPECT_EQ(head.m_contactsStored, cl_uint(count));
        found.erase(found.begin(), found.begin() + DRAPE_CONTACT_HEAD);
        return found;
    }

    // Expects equal positions from sums over the features and from sums over blocks.
    void expectFirstsWithoutSums(std::uint32_t features)
    {
        const cl_uint contacts = contents(m_device, m_counters, 1)[0].m_contactsStored;
        guard(m_device, m_firsts, features);
        const std::size_t blocks = (features + kBlock - 1) / kBlock;
        const OrderingValues values = {0, features, m_ranked, 0, cl_uint(kBlock), m_parts};
        m_place.launch(m_device, blocks * kGroup, kGroup, values, m_featureCounts, m_featureCounts, m_firsts,
                       m_counters, kGroup);
        EXPECT_EQ(contents(m_device, m_firsts, features), contents(m_device, m_featureFirsts, features));
        EXPECT_EQ(contents(m_device, m_counters, 1)[0].m_contactsStored, contacts);
        EXPECT_TRUE(intact(m_device, m_firsts) && intact(m_device, m_counters));
    }

    Device& m_device;
    BoundKernel<kernels::orderingCount> m_count;
    BoundKernel<kernels::orderingPlace> m_place;
    BoundKernel<kernels::orderingGather> m_gather;
    BoundKernel<kernels::orderingGatherSmall> m_gatherSmall;
    BoundKernel<kernels::orderingSort> m_sort;
    BoundKernel<kernels::orderingWrite> m_write;
    Buffer<Contact> m_unsorted, m_contacts;
    Buffer<cl_uint> m_featureCounts, m_featureFirsts, m_blockCount, m_members, m_keys, m_firsts, m_ranks;
    Buffer<StepCounters> m_counters, m_next;
};
}  // namespace

class OrderingTest : public BackendTest
{
};

TEST_P(OrderingTest, OrdersByFeatureAndObstacleFeature)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    Ordering ordering(*device);
    Random random(90);
    for (std::uint32_t features : {1u, 63u, 64u, 65u, 1023u, 1024u, 1025u, 3001u, 70001u})
    {
        for (std::size_t count : {0u, 1u, 63u, 65u, 2999u})
        {
            for (bool crowded : {false, true})
            {
                SCOPED_TRACE("seed 90, " + std::to_string(features) + " features, " + std::to_string(count) +
                             " contacts");
                const std::vector<Contact> contacts = randomContacts(count, features, crowded, random);
                ASSERT_NO_FATAL_FAILURE(ordering.expectOrdered(contacts, features));
            }
        }
    }
    EXPECT_FALSE(device->failed()) << device->error().text();
}

// Simulates thousands of coincident obstacle triangles over one cloth triangle. The lengths are those around the
// counted limit and around powers of two, where the sorting network is cut off.
TEST_P(OrderingTest, OrdersCrowdedFeatures)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    Ordering ordering(*device);
    Random random(92);
    for (std::uint32_t each : {63u, 64u, 65u, 66u, 127u, 128u, 129u, 511u, 512u, 513u, 1000u, 4097u})
    {
        constexpr std::uint32_t kFeatures = 1027;  // the last block has three
        SCOPED_TRACE("seed 92, " + std::to_string(each) + " contacts a crowded feature");
        std::vector<Contact> contacts = randomContacts(700, kFeatures, false, random);
        for (const std::uint32_t feature : {0u, 1u, 500u, 1023u, 1024u, 1026u})
        {
            for (std::uint32_t i = 0; i < each; ++i)
            {
                contacts.emplace_back(contacts.front());
                contacts.back().m_featureIndex = feature;
                contacts.back().m_obstacleFeature = (700 + i) * 2654435761u;
            }
        }
        for (std::size_t i = contacts.size(); i > 1; --i)
            std::swap(contacts[i - 1], contacts[random.below(std::uint32_t(i))]);
        ordering.m_sortBlock = each % 2 == 0 ? 32 : kBlock;
        ASSERT_NO_FATAL_FAILURE(ordering.expectOrdered(contacts, kFeatures));
    }
    EXPECT_FALSE(device->failed()) << device->error().text();
}

// Simulates a step that must run again with more room: the listed part comes out in order.
TEST_P(OrderingTest, TakesWhatAFullListHas)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    Ordering ordering(*device);
    Random random(94);
    SCOPED_TRACE("seed 94");
    const std::vector<Contact> contacts = randomContacts(500, 300, false, random);
    ordering.m_unlisted = 77;
    ASSERT_NO_FATAL_FAILURE(ordering.expectOrdered(contacts, 300));
    EXPECT_FALSE(device->failed()) << device->error().text();
}

// Eight times the contacts in one feature would take 64 times as long by counting; the sort takes 12 times as long.
TEST_P(OrderingTest, GrowsLittleMoreThanTheContactsOfAFeature)
{
    const std::unique_ptr<Device> device = openDevice(GetParam(), true);
    ASSERT_TRUE(device);
    Ordering ordering(*device);
    Random random(93);
    SCOPED_TRACE("seed 93");
    const std::vector<Contact> few = randomContacts(16384, 1, true, random),
                               many = randomContacts(131072, 1, true, random);
    ordering.run(few, 1);  // compiles the kernels
    double fewMs = 1e9, manyMs = 1e9;
    for (int run = 0; run < 3; ++run)  // the least of three: what else runs on the machine only adds
    {
        fewMs = std::min(fewMs, ordering.orderMs(few));
        manyMs = std::min(manyMs, ordering.orderMs(many));
    }
    EXPECT_LT(manyMs, 20 * fewMs) << fewMs << " ms for 16384 contacts, " << manyMs << " for 131072";
    EXPECT_FALSE(device->failed()) << device->error().text();
}

INSTANTIATE_TEST_SUITE_P(Devices, OrderingTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
