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

// Hits of a cloth that lies on a floor, by slots of its nodes, faces and edges, up to `most` each and some of none;
// members are in order.
struct SlotHits
{
    SlotHits(const Side& cloth, std::uint32_t most, Random& random)
    {
        const std::uint32_t nodes = std::uint32_t(cloth.m_pool.vertexCount());
        const std::uint32_t faces = std::uint32_t(cloth.m_pool.triangles().size());
        const std::uint32_t edges = std::uint32_t(cloth.m_pool.edges().size());
        for (std::uint32_t slot = 0; slot < nodes + faces + edges; ++slot)
        {
            m_slotFirst.push_back(cl_uint(m_hits.size()));
            const std::uint32_t kind = slot < nodes           ? DRAPE_NODE_FACE
                                       : slot < nodes + faces ? DRAPE_FACE_VERTEX
                                                              : DRAPE_EDGE_EDGE;
            const std::uint32_t first = slot < nodes ? 0 : slot < nodes + faces ? nodes : nodes + faces;
            const std::uint32_t few = slot % 7 == 0 ? most : 6;
            const std::uint32_t count = slot % 3 == 0 ? 0 : random.below(few + 1);
            for (std::uint32_t i = 0; i < count; ++i)
                add(kind, slot, slot - first, i, random);
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

    std::vector<Contact> m_hits;
    std::vector<cl_uint> m_slotFirst, m_members;
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

// A GPU's work-items take hits, a CPU's slots; crowded slots are a group's on both.
TEST_P(ContactReductionTest, WorkItemsOfAHitOrASlotKeepTheSame)
{
    const std::unique_ptr<Device> device = openDevice(GetParam());
    ASSERT_TRUE(device);
    const cl::Program program = programOf(*device, "contact_reduction");
    Kernel keepSlots, keepHits;
    keepSlots.create(*device, program, "reductionKeep");
    keepHits.create(*device, program, "reductionKeepWide");
    Random random(96);
    Side cloth = makeSide({makeClothGrid(9, 9, 0.4f, 0.0f).m_mesh});
    for (std::size_t i = 1; i < cloth.m_end.size(); i += 3)
        cloth.m_end[i] -= random.uniform(0.0f, 0.002f);
    for (const std::uint32_t most : {1u, 12u, 70u, 300u})
    {
        SCOPED_TRACE("seed 96, up to " + std::to_string(most) + " hits a slot");
        const SlotHits input(cloth, most, random);
        const std::size_t slots = input.m_slotFirst.size(), count = input.m_hits.size();
        std::vector<StepCounters> counters(1);
        counters[0].m_listed = counters[0].m_hits = cl_uint(count);
        Buffer<Contact> hits;
        Buffer<cl_uint> slotFirst, members, kept[2], slotKept[2];
        Buffer<StepCounters> counted;
        Buffer<float> start, end, thickness, tube;
        Buffer<Triangle> triangles;
        Buffer<Edge> edges;
        Buffer<MeshFirsts> firsts;
        guardCopy(*device, hits, input.m_hits);
        guardCopy(*device, slotFirst, input.m_slotFirst);
        guardCopy(*device, members, input.m_members);
        guardCopy(*device, counted, counters);
        guardCopy(*device, start, cloth.m_start);
        guardCopy(*device, end, cloth.m_end);
        guardCopy(*device, thickness, std::vector<float>{kThickness});
        guardCopy(*device, tube, std::vector<float>{0.5f * kThickness});
        guardCopy(*device, triangles, cloth.m_pool.triangles());
        guardCopy(*device, edges, cloth.m_pool.edges());
        guardCopy(*device, firsts, std::vector<MeshFirsts>(1));
        std::vector<cl_uint> foundKept[2], foundCounts[2];
        for (const int wide : {0, 1})
        {
            guard(*device, kept[wide], count);
            guard(*device, slotKept[wide], slots);
            const std::size_t group = wide ? 128 : 64, block = wide ? 5 : 100;
            Kernel& keep = wide ? keepHits : keepSlots;
            keep.launch(*device, (slots + block - 1) / block * group, group, hits.handle(), cl_uint(count),
                        slotFirst.handle(), cl_uint(slots), cl_uint(block), members.handle(), kept[wide].handle(),
                        slotKept[wide].handle(), counted.handle(), start.handle(), end.handle(), triangles.handle(),
                        edges.handle(), firsts.handle(), firsts.handle(), cl_uint(1), cl_uint(1), thickness.handle(),
                        tube.handle());
            foundKept[wide] = contents(*device, kept[wide], count);
            foundCounts[wide] = contents(*device, slotKept[wide], slots);
            EXPECT_TRUE(intact(*device, kept[wide]));
            EXPECT_TRUE(intact(*device, slotKept[wide]));
        }
        EXPECT_EQ(foundCounts[1], foundCounts[0]);
        EXPECT_EQ(foundKept[1], foundKept[0]);
        const std::size_t gone = std::size_t(std::count(foundKept[0].begin(), foundKept[0].end(), DRAPE_NO_FEATURE));
        EXPECT_GT(gone, count / 20);
        EXPECT_LT(gone, count);
    }
    EXPECT_FALSE(device->failed()) << device->error().text();
}

INSTANTIATE_TEST_SUITE_P(Devices, ContactReductionTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
