// The host's kernels of every available instruction set give the contacts of a test of all pairs of triangles.
// Self-collision is compared with a walk over trees. Contacts are equal bit for bit, with any number of threads. Lists
// that are too short grow, and limits are kept.
#include "bullet_plugin/core/cpu/cpu_kernels.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "bullet_plugin/core/broad_phase/host_patch_cull.h"
#include "bullet_plugin/core/ordering/canonical_order.h"
#include "bullet_plugin/core/cloth_cloth/host_self_patches.h"
#include "scenes/shapes.h"
#include "reference/self_pairs.h"
#include "tests/support/cases.h"
#include "tests/support/self_cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr float kReachScale = 1.5f;

// Runs a step's cull and narrow phase with one set of kernels.
class HostStep
{
public:
    HostStep(const CpuKernels& kernels, const StepCase& step, std::uint32_t mode)
        : m_kernels(kernels),
          m_cull(kernels),
          m_cloth(makeSide({step.m_cloth})),
          m_obstacle(makeSide({step.m_obstacle})),
          m_thickness(step.m_thickness),
          m_radius(step.m_thickness * kReachScale * 1.001f)
    {
        m_cloth.m_end = step.m_end;
        m_view = m_cloth.cloth();
        m_view.m_mode = mode;
        clusterMeshes(m_cloth.m_pool, 0, DRAPE_PATCH_WIDTH, m_order);
        m_cull.setTopology(m_obstacle.m_pool, 0);
        m_cull.pack({0, 1}, m_obstacle.obstacle());
    }

    std::size_t cull(ThreadTeam& threads, std::size_t limit = 1u << 28)
    {
        m_counters = {};
        const StepCloths cloths = {
            m_view, m_order.data(), std::uint32_t(m_order.size()), &m_radius, &m_thickness, 1, kReachScale, nullptr, 0};
        return m_cull.run(cloths, limit, threads, m_counters);
    }

    // Returns the contacts of the last cull.
    std::vector<Contact> contacts(ThreadTeam& threads)
    {
        const MeshPool& pool = m_cloth.m_pool;
        std::vector<Contact> unsorted(m_counters.m_candidates), contacts;
        std::vector<std::uint32_t> featureCounts(pool.vertexCount() + pool.triangles().size() + pool.edges().size(), 0);
        std::vector<std::uint32_t> swept(m_counters.m_candidates);
        const FeatureInput input = {m_cull.tests().data(), m_counters.m_candidates, m_view,
                                    m_obstacle.obstacle(), m_cull.packed(),         nullptr};
        const ContactSink sink = {unsorted.data(), std::uint32_t(unsorted.size()), nullptr, featureCounts.data(),
                                  nullptr,         &m_counters.m_contactsFound};
        const auto run = [&](auto kernel, std::size_t items)
        {
            threads.run(items, [&](std::size_t item)
                        { kernel(std::uint32_t(item), std::uint32_t(items), input, sink, swept.data(), &m_counters); });
        };
        run(m_kernels.m_findContacts, 1 + m_counters.m_candidates / 100);
        run(m_kernels.m_findSwept, 6);
        orderContacts(unsorted.data(), m_counters.m_contactsFound, featureCounts, contacts, threads);
        return contacts;
    }

    std::vector<Contact> expected() const
    {
        std::vector<Contact> contacts;
        contactsOfPairs(allPairs(m_cloth, m_obstacle), m_view, m_obstacle.obstacle(),
                        {{m_thickness}, 1, kReachScale, m_view.m_mode}, contacts);
        return contacts;
    }

    const StepCounters& counters() const { return m_counters; }

private:
    const CpuKernels& m_kernels;
    HostPatchCull m_cull;
    Side m_cloth, m_obstacle;
    float m_thickness, m_radius;
    ClothView m_view;
    std::vector<std::uint32_t> m_order;
    StepCounters m_counters = {};
};

std::vector<TriangleMesh> meshesOf(const std::vector<SelfStepCase>& steps)
{
    std::vector<TriangleMesh> meshes;
    for (const SelfStepCase& step : steps)
        meshes.push_back(step.m_motion.m_mesh);
    return meshes;
}

// Runs a host step of cloths with themselves.
class HostSelfStep
{
public:
    HostSelfStep(const CpuKernels& kernels, const std::vector<SelfStepCase>& steps, std::uint32_t mode)
        : m_side(makeSide(meshesOf(steps))), m_obstacleRadius(steps.size(), -1.0f), m_patches(kernels)
    {
        m_side.m_end.clear();
        for (const SelfStepCase& step : steps)
        {
            m_side.m_end.insert(m_side.m_end.end(), step.m_motion.m_end.begin(), step.m_motion.m_end.end());
            m_rest.insert(m_rest.end(), step.m_rest.begin(), step.m_rest.end());
            m_reach.m_thickness.push_back(step.m_thickness);
            m_reach.m_radius.push_back(selfGrowth(step.m_thickness * kReachScale));
        }
        ClothView cloth = m_side.cloth();
        cloth.m_mode = mode;
        m_view = selfView(cloth, m_rest.data(), kReachScale);
        m_patches.update(m_side.m_pool, m_rest.data());
    }

    // Takes a cloth out of the step, or has obstacles looked for, too, of that one.
    void leaveOut(std::size_t cloth) { m_reach.leaveOut(cloth); }
    void meetObstacles(std::size_t cloth) { m_obstacleRadius[cloth] = 0.1f; }

    // Returns the contacts, appended to `others`.
    std::vector<Contact> contacts(ThreadTeam& threads, SelfStepLimits limits = {}, std::vector<Contact> others = {})
    {
        m_patches.cull(step(), limits.m_candidates, threads);
        m_patches.findContacts(step(), limits, threads, others);
        return others;
    }
    // Returns the counts of the last step.
    SelfCounts counts() const { return m_patches.counts(); }

    std::vector<Contact> expected(SelfCounts& counts) const
    {
        std::vector<Contact> contacts;
        counts = HostSelfTrees().run(step(), {}, contacts);
        return contacts;
    }

private:
    SelfStep step() const { return {m_side.m_pool, m_view, m_reach, m_obstacleRadius}; }

    Side m_side;
    std::vector<float> m_rest;
    SelfReach m_reach;
    std::vector<float> m_obstacleRadius;
    SelfView m_view;
    HostSelfPatches m_patches;
};

// Returns the numbers of the machine's sets, the best first.
std::vector<std::size_t> sets()
{
    std::size_t count = 0;
    allCpuKernels(count);
    std::vector<std::size_t> numbers(count);
    for (std::size_t i = 0; i < count; ++i)
        numbers[i] = i;
    return numbers;
}

std::string setName(const testing::TestParamInfo<std::size_t>& info)
{
    std::size_t count = 0;
    std::string name = allCpuKernels(count)[info.param]->m_instructions;
    for (char& letter : name)
        letter = std::isalnum(static_cast<unsigned char>(letter)) ? letter : '_';
    return name;
}

class CpuKernelsTest : public testing::TestWithParam<std::size_t>
{
protected:
    static const CpuKernels& kernels()
    {
        std::size_t count = 0;
        return *allCpuKernels(count)[GetParam()];
    }

    // Expects the host to find the pairs of the trees, with one and with more threads. Returns the counts.
    static SelfCounts expectSame(HostSelfStep& host)
    {
        ThreadTeam alone(1), team(3);
        SelfCounts counts;
        const std::vector<Contact> expected = host.expected(counts);
        for (ThreadTeam* threads : {&alone, &team, &team})
        {
            const std::vector<Contact> found = host.contacts(*threads);
            EXPECT_TRUE(sameBytes(found, expected)) << difference(found, expected);
            EXPECT_EQ(host.counts().m_candidates, counts.m_candidates);
            EXPECT_EQ(host.counts().m_invalidNodes, counts.m_invalidNodes);
        }
        return counts;
    }
};

TEST_P(CpuKernelsTest, ContactsAreThoseOfAllPairs)
{
    ThreadTeam alone(1), team(3);
    std::size_t contacts = 0, swept = 0;
    for (const StepCase& step :
         {fallingCase("sphere", 17, 0.03f, 1500), fallingCase("terrain", 17, 0.05f, 1501),
          soupCase(200, 400, true, 1502), soupCase(3, 5, false, 1503), drapedCase("torus", 21, 0.02f, 1504)})
    {
        for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
        {
            SCOPED_TRACE(step.trace() + ", mode " + std::to_string(mode));
            HostStep host(kernels(), step, mode);
            const std::vector<Contact> expected = host.expected();
            for (ThreadTeam* threads : {&alone, &team, &team})
            {
                host.cull(*threads);
                const std::vector<Contact> found = host.contacts(*threads);
                EXPECT_TRUE(sameBytes(found, expected)) << difference(found, expected);
            }
            contacts += expected.size();
            swept += host.counters().m_swept;
        }
    }
    EXPECT_GT(contacts, 5000u);
    EXPECT_GT(swept, 100u);
}

TEST_P(CpuKernelsTest, ListsGrowAndLimitsAreKept)
{
    ThreadTeam team(2);
    HostStep host(kernels(), soupCase(500, 900, true, 1510), DRAPE_AUTOMATIC);
    EXPECT_GT(host.cull(team), 0u) << "the list was too short";
    const std::size_t tests = host.counters().m_candidates;
    EXPECT_EQ(host.cull(team), 0u) << "now it is long enough";
    EXPECT_EQ(host.counters().m_candidates, tests);
    host.cull(team, tests / 2);
    EXPECT_GT(host.counters().m_candidates, tests / 2);
    host.cull(team, tests);
    EXPECT_EQ(host.counters().m_candidates, tests);
    const std::vector<Contact> found = host.contacts(team), expected = host.expected();
    EXPECT_TRUE(sameBytes(found, expected)) << difference(found, expected);
}

TEST_P(CpuKernelsTest, SelfContactsAreThoseOfAWalkOverTrees)
{
    SelfCounts all;
    std::vector<SelfStepCase> steps = selfStepCases();
    steps.push_back(foldedCase(41, 8, 0.02f, 1520));  // enough triangles for threads
    for (const SelfStepCase& step : steps)
    {
        for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
        {
            SCOPED_TRACE(step.m_motion.m_name + ", mode " + std::to_string(mode));
            HostSelfStep host(kernels(), {step}, mode);
            const SelfCounts counts = expectSame(host);
            all.m_contacts += counts.m_contacts;
            all.m_swept += counts.m_swept;
            all.m_invalidNodes += counts.m_invalidNodes;
        }
    }
    EXPECT_GT(all.m_contacts, 5000u);
    EXPECT_GT(all.m_swept, 100u);
    EXPECT_GT(all.m_invalidNodes, 0u);
}

// Several cloths run at once. One of them is not in the step, and one also meets obstacles, whose search counts its bad
// nodes.
TEST_P(CpuKernelsTest, ClothsMeetThemselvesAlone)
{
    SelfStepCase spoilt = foldedCase(17, 4, 0.003f, 1523);
    spoilt.m_motion.m_end[40] = std::numeric_limits<float>::quiet_NaN();
    const std::vector<SelfStepCase> steps = {foldedCase(25, 4, 0.003f, 1522), spoilt, spoilt,
                                             foldedCase(13, 3, 0.03f, 1524), spoilt};
    for (const std::uint32_t mode : {DRAPE_DISCRETE, DRAPE_CONTINUOUS, DRAPE_AUTOMATIC})
    {
        SCOPED_TRACE(mode);
        HostSelfStep host(kernels(), steps, mode);
        const SelfCounts all = expectSame(host);
        host.leaveOut(1);
        const SelfCounts without = expectSame(host);
        host.meetObstacles(4);
        const SelfCounts beside = expectSame(host);
        EXPECT_LT(without.m_contacts + 500, all.m_contacts);
        EXPECT_GT(without.m_contacts, 2000u);
        EXPECT_EQ(beside.m_contacts, without.m_contacts);
        EXPECT_EQ(all.m_invalidNodes, 3u);
        EXPECT_EQ(without.m_invalidNodes, 2u);
        EXPECT_EQ(beside.m_invalidNodes, 1u);
    }
}

TEST_P(CpuKernelsTest, ListsOfSelfContactsGrowAndLimitsAreKept)
{
    ThreadTeam team(2);
    HostSelfStep host(kernels(), {foldedCase(41, 8, 0.003f, 1521)}, DRAPE_AUTOMATIC);
    SelfCounts counts;
    const std::vector<Contact> expected = host.expected(counts), one = {expected[0]};
    EXPECT_EQ(host.contacts(team).size(), expected.size());
    EXPECT_GT(host.counts().m_retries, 0u) << "the lists were too short";
    EXPECT_EQ(host.contacts(team, {}, one).size(), 1 + expected.size()) << "others stay";
    EXPECT_EQ(host.counts().m_retries, 0u) << "now they are long enough";

    EXPECT_TRUE(host.contacts(team, {counts.m_candidates - 1, UINT64_MAX}).empty());
    EXPECT_GE(host.counts().m_candidates, counts.m_candidates);
    EXPECT_EQ(host.contacts(team, {UINT64_MAX, expected.size() - 1}, one).size(), 1u) << "none of too many";
    EXPECT_EQ(host.counts().m_contacts, expected.size());
    const std::vector<Contact> found = host.contacts(team, {counts.m_candidates, expected.size()});
    EXPECT_TRUE(sameBytes(found, expected)) << difference(found, expected);
}

INSTANTIATE_TEST_SUITE_P(Sets, CpuKernelsTest, testing::ValuesIn(sets()), setName);

TEST(CpuKernels, TheMachinesBestIsUsed)
{
    std::size_t count = 0;
    const CpuKernels* const* all = allCpuKernels(count);
    ASSERT_GT(count, 0u);
    EXPECT_EQ(&cpuKernels(), all[0]);
    EXPECT_STREQ(all[count - 1]->m_instructions, "any CPU") << "a machine without any has these";
}
}  // namespace
}  // namespace drape::test
