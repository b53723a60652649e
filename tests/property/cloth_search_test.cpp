// Searches of a set of cloths on a device: the host's contacts and pairs, bit for bit, in motion and with lists that
// are too short at first.
#include "bullet_plugin/core/cloth_cloth/cloth_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "bullet_plugin/core/backends/device_cloth_search.h"
#include "bullet_plugin/core/scene/patch_width.h"
#include "scenes/cloth_grid.h"
#include "scenes/random.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr float kThickness = 0.03f, kReach = 0.006f;
constexpr std::uint64_t kNoLimit = 1u << 24;

// Sheets above one another, as two sets with the same nodes: one on the host, one on a device.
struct TwoSets
{
    TwoSets(int count, int nodes, const std::shared_ptr<Device>& device, const std::string& cacheFolder)
    {
        m_device.useDevice({device, std::make_shared<ProgramSet>(*device, cacheFolder, std::vector<ProgramSet::Names>(),
                                                                 patchDefines(*device))});
        assign(count, nodes);
    }

    void assign(int count, int nodes)
    {
        const TriangleMesh sheet = makeClothGrid(nodes, nodes, 1, 0).m_mesh;
        m_positions.clear();
        for (int k = 0; k < count; ++k)
            for (std::size_t i = 0; i < sheet.m_positions.size(); ++i)
                m_positions.push_back(sheet.m_positions[i] + (i % 3 == 1 ? 0.02f * float(k) : 0));
        const std::vector<SetMember> members(
            std::size_t(count), {sheet.m_triangles.data(), sheet.triangleCount(), nullptr, 0, sheet.m_positions.data(),
                                 sheet.vertexCount(), kThickness});
        for (ClothSet* set : {&m_host, &m_device})
            set->assign(members, m_threads);
    }

    // Moves the nodes over waves of this height, m, with as much noise at both ends of the way.
    void move(float height, float phase, float noise, Random& random)
    {
        for (std::size_t i = 0; i < m_positions.size(); ++i)
        {
            const std::size_t x = i - i % 3;
            const float wave = i % 3 == 1 ? height * std::sin(9 * m_positions[x] + phase) : 0;
            const float start = m_positions[i] + wave + float(random.within(-noise, noise));
            const float end = m_positions[i] - wave + float(random.within(-noise, noise));
            for (ClothSet* set : {&m_host, &m_device})
            {
                set->start()[i] = start;
                set->end()[i] = end;
            }
        }
    }

    // Compares both sets' contacts and pairs. Returns the number of contacts.
    std::size_t compare()
    {
        std::vector<Contact> expected, contacts;
        EXPECT_TRUE(m_host.findContacts(1.5f, kNoLimit, kNoLimit, m_threads, expected));
        EXPECT_TRUE(m_device.findContacts(1.5f, kNoLimit, kNoLimit, m_threads, contacts));
        EXPECT_EQ(contacts.size(), expected.size());
        EXPECT_TRUE(contacts.size() == expected.size() &&
                    std::memcmp(contacts.data(), expected.data(), contacts.size() * sizeof(Contact)) == 0);
        std::vector<FeatureTest> listed, pairs;
        EXPECT_TRUE(m_host.findPairs(kReach, kNoLimit, m_threads, listed));
        EXPECT_TRUE(m_device.findPairs(kReach, kNoLimit, m_threads, pairs));
        EXPECT_EQ(m_device.smoothPairs(), m_host.smoothPairs());
        EXPECT_EQ(pairs.size(), listed.size());
        m_pairs += pairs.size();
        EXPECT_TRUE(pairs.size() == listed.size() &&
                    std::memcmp(pairs.data(), listed.data(), pairs.size() * sizeof(FeatureTest)) == 0);
        return contacts.size();
    }

    ThreadTeam m_threads{2};
    std::vector<float> m_positions;
    ClothSet m_host, m_device;
    std::size_t m_pairs = 0;  // compared so far
};
}  // namespace

class ClothSearch : public DeviceTest
{
protected:
    void SetUp() override
    {
        DeviceTest::SetUp();
        m_shared = std::move(m_device);
    }
    void TearDown() override
    {
        if (!m_shared) return;
        EXPECT_FALSE(m_shared->failed()) << m_shared->error().text();
    }
    TwoSets makeSets(int count, int nodes) const
    {
        return TwoSets(count, nodes, m_shared, GetParam().m_settings.m_cacheFolder);
    }

    std::shared_ptr<Device> m_shared;
};

TEST_P(ClothSearch, FewTriangles)
{
    TwoSets sets = makeSets(2, 3);
    Random random(70);
    sets.move(0.01f, 0, 0.005f, random);
    EXPECT_GT(sets.compare(), 0u);
}

TEST_P(ClothSearch, FindsWhatTheHostFinds)
{
    TwoSets sets = makeSets(3, 25);
    Random random(71);
    for (const float height : {0.0f, 0.01f, 0.05f})
        for (const float noise : {0.0f, 0.001f, 0.01f})
        {
            SCOPED_TRACE("seed 71, height " + std::to_string(height) + ", noise " + std::to_string(noise));
            sets.move(height, 1 + height, noise, random);
            EXPECT_GT(sets.compare(), 8192u);  // more than the lists have room for at first
        }
    EXPECT_GT(sets.m_pairs, 8192u);
    EXPECT_GT(m_shared->waits(), 2u * 9u);  // it has searched
    // Other cloths, and then the host.
    sets.assign(1, 20);
    sets.move(0.1f, 0, 0.001f, random);
    sets.compare();
    sets.m_device.useDevice({});
    const std::size_t waits = m_shared->waits();
    sets.move(0.1f, 1, 0.001f, random);
    sets.compare();
    EXPECT_EQ(m_shared->waits(), waits);
}

// A device lists pairs that the host leaves out. Beyond a limit the host counts.
TEST_P(ClothSearch, TheHostDecidesAboutLimits)
{
    TwoSets sets = makeSets(2, 17);
    Random random(72);
    sets.move(0.01f, 0, 0.001f, random);
    for (std::uint64_t limit = 1; limit < kNoLimit; limit *= 4)
    {
        std::vector<Contact> expected, contacts;
        EXPECT_EQ(sets.m_device.findContacts(1.5f, limit, kNoLimit, sets.m_threads, contacts),
                  sets.m_host.findContacts(1.5f, limit, kNoLimit, sets.m_threads, expected))
            << limit;
        EXPECT_EQ(contacts.size(), expected.size()) << limit;
        EXPECT_EQ(sets.m_device.findContacts(1.5f, kNoLimit, limit, sets.m_threads, contacts),
                  sets.m_host.findContacts(1.5f, kNoLimit, limit, sets.m_threads, expected))
            << limit;
        EXPECT_EQ(contacts.size(), expected.size()) << limit;
        std::vector<FeatureTest> listed, pairs;
        EXPECT_EQ(sets.m_device.findPairs(kReach, limit, sets.m_threads, pairs),
                  sets.m_host.findPairs(kReach, limit, sets.m_threads, listed))
            << limit;
        EXPECT_EQ(pairs.size(), listed.size()) << limit;
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, ClothSearch, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
