// What is left of each slot after reduction is written in order, each contact once, by work-items alone or together.
#include <gtest/gtest.h>

#include <cstring>

#include "bullet_plugin/core/device/program.h"
#include "kernels/shared/patch.h"
#include "tests/support/cases.h"
#include "tests/support/device_side.h"

namespace drape::test
{
namespace
{
constexpr std::size_t kGroup = 64;

// Slots of up to four hits each, of which some stay: at the front of the slot's places, nothing behind.
struct KeptHits
{
    KeptHits(std::uint32_t slots, Random& random)
    {
        for (std::uint32_t slot = 0; slot < slots; ++slot)
        {
            const std::uint32_t count = random.below(5), stay = random.below(count + 1);
            m_slotFirst.push_back(cl_uint(m_kept.size()));
            m_keptFirst.push_back(cl_uint(m_expected.size()));
            for (std::uint32_t i = 0; i < count; ++i)
            {
                Contact hit = {};
                hit.m_slot = slot;
                hit.m_obstacleFeature = i;
                hit.m_gap1 = float(m_hits.size());
                hit.m_time = random.uniform(0.0f, 1.0f);
                m_kept.push_back(i < stay ? cl_uint(m_hits.size()) : DRAPE_NO_FEATURE);
                if (i < stay) m_expected.push_back(hit);
                m_hits.push_back(hit);
            }
        }
    }

    std::vector<Contact> m_hits, m_expected;
    std::vector<cl_uint> m_kept, m_slotFirst, m_keptFirst;
};
}  // namespace

class ContactReductionTest : public BackendTest
{
};

TEST_P(ContactReductionTest, WritesWhatStays)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    Kernel write;
    write.create(*device, programOf(*device, "contact_reduction"), "reductionWrite");
    Random random(95);
    for (const std::uint32_t slots : {1u, 63u, 65u, 1025u})
    {
        const KeptHits input(slots, random);
        std::vector<StepCounters> counters(1);
        counters[0].m_listed = cl_uint(input.m_hits.size());
        counters[0].m_hits = cl_uint(input.m_expected.size());
        for (const cl_uint parts : {1u, 2u, 4u})
        {
            SCOPED_TRACE("seed 95, " + std::to_string(slots) + " slots, " + std::to_string(parts) + " parts");
            const std::size_t places = DRAPE_CONTACT_HEAD + input.m_expected.size();
            Buffer<Contact> hits, contacts;
            Buffer<cl_uint> slotFirst, kept, keptFirst;
            Buffer<StepCounters> count;
            guardCopy(*device, hits, input.m_hits);
            guardCopy(*device, slotFirst, input.m_slotFirst);
            guardCopy(*device, kept, input.m_kept);
            guardCopy(*device, keptFirst, input.m_keptFirst);
            guardCopy(*device, count, counters);
            guard(*device, contacts, places);
            write.launch(*device, 4 * kGroup, kGroup, hits.handle(), cl_uint(input.m_hits.size()), slotFirst.handle(),
                         parts, kept.handle(), keptFirst.handle(), contacts.handle(), count.handle());
            std::vector<Contact> found = contents(*device, contacts, places);
            EXPECT_EQ(std::memcmp(found.data(), counters.data(), sizeof(StepCounters)), 0) << "the head";
            found.erase(found.begin(), found.begin() + DRAPE_CONTACT_HEAD);
            EXPECT_TRUE(sameBytes(found, input.m_expected)) << difference(found, input.m_expected);
            EXPECT_TRUE(intact(*device, contacts));
        }
    }
    EXPECT_FALSE(device->failed()) << device->error().text();
}

INSTANTIATE_TEST_SUITE_P(Devices, ContactReductionTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
