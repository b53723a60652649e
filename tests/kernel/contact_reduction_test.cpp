// What is left of each slot after reduction is written in order, each contact once, by work-items alone or together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "bullet_plugin/core/device/program.h"
#include "kernels/shared/patch.h"
#include "scenes/cloth_grid.h"
#include "tests/support/cases.h"
#include "tests/support/device_side.h"
#include "tests/support/side.h"
#include "tests/support/slot_sums.h"

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

constexpr float kThickness = 0.02f;  // m

// Hits of a cloth that lies on a floor, by slots of its nodes, faces and edges and of its contacts with itself, up to
// `most` each and some of none; members are in order, or shuffled.
struct SlotHits
{
    SlotHits(const Side& cloth, std::uint32_t most, Random& random)
    {
        const std::uint32_t nodes = std::uint32_t(cloth.m_pool.vertexCount());
        const std::uint32_t faces = std::uint32_t(cloth.m_pool.triangles().size());
        const std::uint32_t edges = std::uint32_t(cloth.m_pool.edges().size());
        addSlots(DRAPE_NODE_FACE, nodes, most, random);
        addSlots(DRAPE_FACE_VERTEX, faces, most, random);
        addSlots(DRAPE_EDGE_EDGE, edges, most, random);
        m_reducible = m_hits.size();
        addSlots(DRAPE_SELF_NODE_FACE, nodes, most, random);
    }

    void addSlots(std::uint32_t kind, std::uint32_t features, std::uint32_t most, Random& random)
    {
        for (std::uint32_t feature = 0; feature < features; ++feature)
        {
            const std::uint32_t slot = std::uint32_t(m_slotFirst.size());
            m_slotFirst.push_back(cl_uint(m_hits.size()));
            const std::uint32_t few = slot % 7 == 0 ? most : 6;
            const std::uint32_t count = slot % 3 == 0 ? 0 : random.below(few + 1);
            for (std::uint32_t i = 0; i < count; ++i)
                add(kind, slot, feature, i, random);
        }
    }

    void add(std::uint32_t kind, std::uint32_t slot, std::uint32_t feature, std::uint32_t obstacle, Random& random)
    {
        Contact hit = {};
        hit.m_kind = kind;
        hit.m_slot = slot;
        hit.m_clothFeature = feature;
        hit.m_obstacleFeature = obstacle;
        const float s = random.uniform(0.0f, 1.0f), t = random.uniform(0.0f, 1.0f - s);
        hit.m_weights[0] = kind == DRAPE_NODE_FACE ? 1.0f : kind == DRAPE_EDGE_EDGE ? 1.0f - s : 1.0f - s - t;
        hit.m_weights[1] = kind == DRAPE_NODE_FACE ? 0.0f : s;
        hit.m_weights[2] = kind == DRAPE_FACE_VERTEX ? t : 0.0f;
        const float lean = random.below(2) == 0 ? 0.0f : random.uniform(-0.2f, 0.2f);
        const Vec3 normal = vec3Direction(vec3(lean, 1.0f, 0.5f * lean), vec3Length(vec3(lean, 1.0f, 0.5f * lean)));
        hit.m_normal[0] = normal.x;
        hit.m_normal[1] = normal.y;
        hit.m_normal[2] = normal.z;
        // Several as deep as each other.
        hit.m_gap1 = kThickness * (0.5f + 0.125f * float(random.below(9)));
        hit.m_gap0 = kThickness * random.uniform(0.8f, 1.6f);
        hit.m_time = random.below(9) == 0 ? 0.5f : 1.0f;
        m_members.push_back(cl_uint(m_hits.size()));
        m_hits.push_back(hit);
    }

    void shuffleMembers(Random& random)
    {
        for (std::size_t slot = 0; slot < m_slotFirst.size(); ++slot)
            for (std::size_t i = end(slot); i > m_slotFirst[slot] + 1; --i)
                std::swap(m_members[i - 1],
                          m_members[m_slotFirst[slot] + random.below(cl_uint(i - m_slotFirst[slot]))]);
    }

    std::size_t end(std::size_t slot) const
    {
        return slot + 1 < m_slotFirst.size() ? m_slotFirst[slot + 1] : m_hits.size();
    }
    std::size_t largest() const
    {
        std::size_t most = 0;
        for (std::size_t slot = 0; slot < m_slotFirst.size(); ++slot)
            most = std::max(most, end(slot) - m_slotFirst[slot]);
        return most;
    }

    std::vector<Contact> m_hits;
    std::size_t m_reducible = 0;  // the first so many hits, which are not a cloth's with itself
    std::vector<cl_uint> m_slotFirst, m_members;
};

// What stays of each slot: members, and how many.
struct Kept
{
    std::vector<cl_uint> m_members, m_counts;
};

// Both sides of a step and its hits on a device.
class KeptBuffers
{
public:
    // tube: m, negative where all hits stay.
    KeptBuffers(Device& device, const Side& cloth, const SlotHits& input, float tube)
        : m_device(device), m_slots(input.m_slotFirst.size()), m_count(input.m_hits.size())
    {
        std::vector<StepCounters> counters(1);
        counters[0].m_listed = counters[0].m_hits = cl_uint(m_count);
        guardCopy(device, m_hits, input.m_hits);
        guardCopy(device, m_slotFirst, input.m_slotFirst);
        guardCopy(device, m_members, input.m_members);
        guardCopy(device, m_counters, counters);
        guardCopy(device, m_start, cloth.m_start);
        guardCopy(device, m_end, cloth.m_end);
        guardCopy(device, m_thickness, std::vector<float>{kThickness});
        guardCopy(device, m_tube, std::vector<float>{tube});
        guardCopy(device, m_triangles, cloth.m_pool.triangles());
        guardCopy(device, m_edges, cloth.m_pool.edges());
        guardCopy(device, m_firsts, std::vector<MeshFirsts>(1));
    }

    // By work-items that take slots.
    Kept runSlots(Kernel& keep, std::size_t share) { return run(keep, (m_slots + share - 1) / share, 1, share); }

    // By groups that take the slots of so many members, in one turn, two or many.
    Kept runHits(Kernel& keep, std::size_t share)
    {
        Buffer<cl_uint> sums;
        guardCopy(m_device, sums, std::vector<cl_uint>(DRAPE_SLOT_SUMS, 0));
        const Kept found = run(keep, std::max<std::size_t>(1, m_count / share), 128, share, sums.handle());
        EXPECT_EQ(contents(m_device, sums, DRAPE_SLOT_SUMS), slotSumsOf(found.m_counts));
        EXPECT_TRUE(intact(m_device, sums));
        for (const std::size_t groups : {m_count, std::size_t(3), std::size_t(1)})
        {
            const Kept withoutSums = run(keep, groups, 128, share, cl::Buffer());
            EXPECT_EQ(withoutSums.m_members, found.m_members) << groups << " groups";
            EXPECT_EQ(withoutSums.m_counts, found.m_counts) << groups << " groups";
        }
        return found;
    }

private:
    template <typename... Sums>
    Kept run(Kernel& keep, std::size_t groups, std::size_t group, std::size_t share, const Sums&... sums)
    {
        Buffer<cl_uint> kept, slotKept;
        guard(m_device, kept, m_count);
        guardCopy(m_device, slotKept, std::vector<cl_uint>(m_slots, 0));
        keep.launch(m_device, groups * group, group, m_hits.handle(), cl_uint(m_count), m_slotFirst.handle(),
                    cl_uint(m_slots), cl_uint(share), m_members.handle(), kept.handle(), slotKept.handle(),
                    m_counters.handle(), m_start.handle(), m_end.handle(), m_triangles.handle(), m_edges.handle(),
                    m_firsts.handle(), m_firsts.handle(), cl_uint(1), cl_uint(1), m_thickness.handle(), m_tube.handle(),
                    sums...);
        const Kept found = {contents(m_device, kept, m_count), contents(m_device, slotKept, m_slots)};
        EXPECT_TRUE(intact(m_device, kept));
        EXPECT_TRUE(intact(m_device, slotKept));
        return found;
    }

    Device& m_device;
    std::size_t m_slots, m_count;
    Buffer<Contact> m_hits;
    Buffer<cl_uint> m_slotFirst, m_members;
    Buffer<StepCounters> m_counters;
    Buffer<float> m_start, m_end, m_thickness, m_tube;
    Buffer<Triangle> m_triangles;
    Buffer<Edge> m_edges;
    Buffer<MeshFirsts> m_firsts;
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

// A GPU's work-items take hits, and a crowded slot together; a CPU's take slots, whose members have any order. More
// than 256 hits are a crowded slot there, and more than 128 are sorted in another way here.
TEST_P(ContactReductionTest, WorkItemsOfAHitOrASlotKeepTheSame)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    Kernel keepSlots, keepHits, keepListed;
    keepSlots.create(*device, programOf(*device, "contact_reduction_slots"), "reductionKeep");
    keepHits.create(*device, programOf(*device, "contact_reduction_hits"), "reductionKeepWide");
    // Lists that are full after a few pairs.
    keepListed.create(*device, programOf(*device, "contact_reduction_hits", "#define DRAPE_LIKELY 5u\n"),
                      "reductionKeepWide");
    Random random(96);
    Side cloth = makeSide({makeClothGrid(9, 9, 0.4f, 0.0f).m_mesh});
    for (std::size_t i = 1; i < cloth.m_end.size(); i += 3)
        cloth.m_end[i] -= random.uniform(0.0f, 0.002f);
    std::size_t largest = 0, mostKept = 0;
    for (const float tube : {0.5f * kThickness, -1.0f})
        for (const std::uint32_t most : {1u, 12u, 70u, 300u})
        {
            SCOPED_TRACE("seed 96, up to " + std::to_string(most) + " hits a slot, tube " + std::to_string(tube));
            SlotHits input(cloth, most, random);
            const Kept byHit = KeptBuffers(*device, cloth, input, tube).runHits(keepHits, 1 + 7 * most % 64);
            const Kept byListed = KeptBuffers(*device, cloth, input, tube).runHits(keepListed, 64);
            EXPECT_EQ(byListed.m_counts, byHit.m_counts);
            EXPECT_EQ(byListed.m_members, byHit.m_members);
            input.shuffleMembers(random);
            const Kept bySlot = KeptBuffers(*device, cloth, input, tube).runSlots(keepSlots, 100);
            EXPECT_EQ(byHit.m_counts, bySlot.m_counts);
            EXPECT_EQ(byHit.m_members, bySlot.m_members);
            const std::size_t gone =
                std::size_t(std::count(bySlot.m_members.begin(), bySlot.m_members.end(), DRAPE_NO_FEATURE));
            EXPECT_LT(gone, input.m_reducible);
            if (tube < 0.0f)
                EXPECT_EQ(gone, 0u);
            else
                EXPECT_GT(gone, input.m_reducible / 20);
            largest = std::max(largest, input.largest());
            mostKept =
                std::max<std::size_t>(mostKept, *std::max_element(bySlot.m_counts.begin(), bySlot.m_counts.end()));
        }
    EXPECT_GT(largest, 256u);
    EXPECT_GT(mostKept, 128u);
    EXPECT_FALSE(device->failed()) << device->error().text();
}

INSTANTIATE_TEST_SUITE_P(Devices, ContactReductionTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
