// The guard of cloth against cloth, on random motion: no two triangles meet on the way, by the exact check; what
// nothing threatens moves freely.
#include "bullet_plugin/core/cloth_cloth/cloth_guard.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oracle/self_intersections.h"
#include "scenes/cloth_grid.h"
#include "scenes/random.h"

namespace drape::test
{
namespace
{
constexpr float kThickness = 0.02f;

// Sheets above one another, one mesh each; as a set, and joined for the check.
struct Sheets
{
    Sheets(int count, int nodes, float size, float distance)
    {
        m_grid = makeClothGrid(nodes, nodes, size, 0);
        const TriangleMesh& sheet = m_grid.m_mesh;
        for (int k = 0; k < count; ++k)
        {
            for (std::size_t i = 0; i < sheet.m_positions.size(); ++i)
                m_joined.m_positions.push_back(sheet.m_positions[i] + (i % 3 == 1 ? distance * float(k) : 0));
            for (const std::int32_t node : sheet.m_triangles)
                m_joined.m_triangles.push_back(node + std::int32_t(k) * std::int32_t(sheet.vertexCount()));
        }
        const std::vector<SetMember> members(
            std::size_t(count), {sheet.m_triangles.data(), sheet.triangleCount(), nullptr, 0, sheet.m_positions.data(),
                                 sheet.vertexCount(), kThickness});
        ThreadTeam threads(1);
        m_set.assign(members, threads);
        m_held.assign(m_set.nodeCount(), 0);
        m_now = m_joined.m_positions;
    }

    // Holds the first sheet. Returns its number of nodes.
    std::size_t holdFirst()
    {
        const std::size_t nodes = m_set.firstNode(1);
        std::fill(m_held.begin(), m_held.begin() + std::ptrdiff_t(nodes), 1);
        return nodes;
    }
    // Moves the nodes from where they are towards `ends`.
    GuardResult moveTo(const std::vector<float>& ends, ClothGuard& guard, ThreadTeam& threads)
    {
        std::copy(m_now.begin(), m_now.end(), m_set.start());
        std::copy(ends.begin(), ends.end(), m_set.end());
        const GuardResult result = guard.apply(m_set, m_held, nullptr, 1u << 24, threads);
        m_before = m_now;
        m_now.assign(m_set.end(), m_set.end() + m_now.size());
        return result;
    }
    // Counts intersecting pairs after a share of the last way.
    std::size_t meetingAt(SelfIntersections& check, float share) const
    {
        std::vector<float> there = m_now;
        for (std::size_t i = 0; share < 1 && i < there.size(); ++i)
            there[i] = float(double(m_before[i]) + double(share) * (double(m_now[i]) - double(m_before[i])));
        return check.find(there).size();
    }

    ClothGrid m_grid;
    TriangleMesh m_joined;
    ClothSet m_set;
    std::vector<unsigned char> m_held;
    std::vector<float> m_now, m_before;
};
}  // namespace

TEST(ClothGuard, RandomMotionNeverEndsInAnIntersection)
{
    ThreadTeam threads(2);
    for (const float reach : {0.003f, 0.05f, 1.0f})
    {
        Sheets sheets(3, 9, 1, 0.03f);
        SelfIntersections check(sheets.m_joined);
        ClothGuard guard;
        Random random(17);
        std::size_t shortened = 0, moved = 0;
        for (int step = 0; step < 30; ++step)
        {
            std::vector<float> ends = sheets.m_now;
            for (float& coordinate : ends)
                coordinate += float(random.within(-reach, reach));
            const GuardResult result = sheets.moveTo(ends, guard, threads);
            shortened += result.m_shortened;
            for (const double share : guard.shares())
                moved += share > 0;
            ASSERT_EQ(result.m_startMeeting, 0u) << reach << " " << step;
            for (const float share : {0.5f, 1.0f})
                ASSERT_EQ(sheets.meetingAt(check, share), 0u) << reach << " " << step << " " << share;
        }
        EXPECT_GT(shortened, 0u);
        EXPECT_GT(moved, 30u * 20u);
    }
}

TEST(ClothGuard, SheetsThatMoveTogetherAreNotHeld)
{
    ThreadTeam threads(2);
    Sheets sheets(2, 9, 1, 0.002f);
    ClothGuard guard;
    std::vector<float> ends = sheets.m_now;
    for (std::size_t i = 1; i < ends.size(); i += 3)
        ends[i] -= 0.5f;
    const GuardResult result = sheets.moveTo(ends, guard, threads);
    EXPECT_EQ(result.m_shortened, 0u);
    EXPECT_EQ(sheets.m_now, ends);
    // One slides along the other.
    for (std::size_t i = 0; i < ends.size() / 2; i += 3)
        ends[i] += 0.05f;
    EXPECT_EQ(sheets.moveTo(ends, guard, threads).m_shortened, 0u);
    EXPECT_EQ(sheets.m_now, ends);
}

TEST(ClothGuard, AFoldedClothDoesNotCloseThroughItself)
{
    ThreadTeam threads(2);
    Sheets sheets(1, 17, 1, 0);
    SelfIntersections check(sheets.m_joined);
    ClothGuard guard;
    // Turns one half about the middle, over the other and through it.
    for (int step = 1; step <= 40; ++step)
    {
        std::vector<float> ends = sheets.m_joined.m_positions;
        const float angle = 0.1f * float(step);
        for (std::size_t i = 0; i < ends.size(); i += 3)
            if (const float x = ends[i]; x > 0.01f)
            {
                ends[i] = x * std::cos(angle);
                ends[i + 1] = x * std::sin(angle);
            }
        sheets.moveTo(ends, guard, threads);
        ASSERT_EQ(sheets.meetingAt(check, 1), 0u) << step;
    }
}

// A sheet that falls onto a smaller held one: its middle stops, and what was smooth on whole paths is a bell.
TEST(ClothGuard, PairsThatShortenedPathsBendAreListed)
{
    ThreadTeam threads(2);
    Sheets sheets(2, 17, 1, 0.05f);
    SelfIntersections check(sheets.m_joined);
    ClothGuard guard;
    const std::size_t nodes = sheets.holdFirst();
    for (std::size_t i = 0; i < 3 * nodes; i += 3)
    {
        sheets.m_now[i] *= 0.3f;
        sheets.m_now[i + 2] *= 0.3f;
    }
    std::vector<float> ends = sheets.m_now;
    for (std::size_t i = 3 * nodes + 1; i < ends.size(); i += 3)
        ends[i] -= 1.0f;
    const GuardResult result = sheets.moveTo(ends, guard, threads);
    EXPECT_GT(result.m_shortened, 0u);
    EXPECT_LT(result.m_shortened, nodes);
    EXPECT_EQ(sheets.m_set.findLost(std::vector<unsigned char>(sheets.m_set.nodeCount(), 1), threads), 0u);
    EXPECT_GT(sheets.m_set.smoothPairs(), 0u);
    EXPECT_EQ(sheets.meetingAt(check, 1), 0u);
}

TEST(ClothGuard, AHeldSheetPushesTheOtherAside)
{
    ThreadTeam threads(2);
    Sheets sheets(2, 9, 1, 0.03f);
    SelfIntersections check(sheets.m_joined);
    ClothGuard guard;
    const std::size_t nodes = sheets.holdFirst();
    // The held sheet rises to the other one, which does not move by itself: it stops the way that the held one leaves.
    std::vector<float> ends = sheets.m_now;
    for (std::size_t i = 1; i < 3 * nodes; i += 3)
        ends[i] += 0.025f;
    for (std::size_t i = 3 * nodes + 1; i < ends.size(); i += 3)
        ends[i] -= 0.02f;
    const GuardResult result = sheets.moveTo(ends, guard, threads);
    EXPECT_EQ(result.m_forced, 0u);
    for (std::size_t i = 0; i < 3 * nodes; ++i)
        EXPECT_EQ(sheets.m_now[i], ends[i]);
    EXPECT_EQ(sheets.meetingAt(check, 1), 0u);
    // It goes on beyond where the other one was, and carries it along.
    for (std::size_t i = 1; i < 3 * nodes; i += 3)
        ends[i] += 0.05f;
    EXPECT_EQ(sheets.moveTo(ends, guard, threads).m_forced, 0u);
    for (std::size_t i = 0; i < 3 * nodes; ++i)
        EXPECT_EQ(sheets.m_now[i], ends[i]);
    for (std::size_t i = 3 * nodes + 1; i < ends.size(); i += 3)
        EXPECT_GT(sheets.m_now[i], ends[1]);
    for (std::size_t node = nodes; node < 2 * nodes; ++node)
        EXPECT_TRUE(guard.isCarried(node)) << node;
    EXPECT_EQ(sheets.meetingAt(check, 0.5f), 0u);
    EXPECT_EQ(sheets.meetingAt(check, 1), 0u);
}

// Nodes that a held sheet carries count as held for those behind them.
TEST(ClothGuard, AHeldSheetPushesAStackAside)
{
    ThreadTeam threads(2);
    constexpr int kSheets = 5;
    Sheets sheets(kSheets, 9, 1, 0.03f);
    SelfIntersections check(sheets.m_joined);
    ClothGuard guard;
    const std::size_t nodes = sheets.holdFirst();
    std::vector<float> ends = sheets.m_now;
    for (std::size_t i = 1; i < 3 * nodes; i += 3)
        ends[i] += 0.2f;
    const GuardResult result = sheets.moveTo(ends, guard, threads);
    EXPECT_EQ(result.m_forced, 0u);
    for (std::size_t node = nodes; node < kSheets * nodes; ++node)
        EXPECT_TRUE(guard.isCarried(node)) << node;
    EXPECT_EQ(sheets.meetingAt(check, 0.5f), 0u);
    EXPECT_EQ(sheets.meetingAt(check, 1), 0u);
}

TEST(ClothGuard, ASheetThatHeldOnesCloseInOnIsCounted)
{
    ThreadTeam threads(2);
    Sheets sheets(3, 9, 1, 0.03f);
    ClothGuard guard;
    const std::size_t nodes = sheets.holdFirst();
    std::fill(sheets.m_held.begin() + std::ptrdiff_t(2 * nodes), sheets.m_held.end(), 1);
    std::vector<float> ends = sheets.m_now;
    for (std::size_t i = 1; i < 3 * nodes; i += 3)
        ends[i] += 0.0605f;
    EXPECT_GT(sheets.moveTo(ends, guard, threads).m_forced, 0u);
}

TEST(ClothGuard, AnyNumberOfThreadsGivesTheSameEnds)
{
    std::vector<std::vector<float>> ends;
    for (const unsigned count : {1u, 2u, 7u})
    {
        ThreadTeam threads(count);
        Sheets sheets(4, 17, 1, 0.01f);
        ClothGuard guard;
        Random random(3);
        for (int step = 0; step < 10; ++step)
        {
            std::vector<float> next = sheets.m_now;
            for (float& coordinate : next)
                coordinate += float(random.within(-0.03, 0.03));
            sheets.moveTo(next, guard, threads);
        }
        ends.push_back(sheets.m_now);
    }
    EXPECT_EQ(ends[0], ends[1]);
    EXPECT_EQ(ends[0], ends[2]);
}
}  // namespace drape::test
