// Nodes of a step and their motion in substeps: where free nodes end, damping, and what corrections give to velocities.
#include "bullet_plugin/core/solver/host/substeps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bullet_plugin/core/solver/host/momentum.h"
#include "bullet_plugin/core/solver/topology/cloth_parts.h"
#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
Vec3 randomVector(float most, Random& random)
{
    const float x = random.uniform(-most, most), y = random.uniform(-most, most);
    return vec3(x, y, random.uniform(-most, most));
}

void expectNear(Vec3 is, Vec3 expected, float tolerance)
{
    EXPECT_NEAR(is.x, expected.x, tolerance);
    EXPECT_NEAR(is.y, expected.y, tolerance);
    EXPECT_NEAR(is.z, expected.z, tolerance);
}

void expectEqual(Vec3 is, Vec3 expected)
{
    EXPECT_EQ(is.x, expected.x);
    EXPECT_EQ(is.y, expected.y);
    EXPECT_EQ(is.z, expected.z);
}

// Links each node with the next ones, at a length of 0.01 m.
void linkNeighbours(const SolverNodes& nodes, const std::vector<Vec3>& places, LinkSweep& sweep)
{
    ClothParts parts;
    parts.cut(places);
    ASSERT_GT(parts.leafCount(), 8u);
    std::vector<LinkNodes> links;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
        for (std::size_t j = i + 1; j < std::min(i + 4, places.size()); ++j)
        {
            const int both[3] = {int(i), int(j), -1};
            links.push_back({{std::uint32_t(i), std::uint32_t(j)}, std::uint32_t(parts.groupOf(both))});
        }
    }
    sweep.build(places.size(), parts.leafCount(), links);
    for (std::size_t i = 0; i < links.size(); ++i)
    {
        const std::uint32_t a = links[i].m_nodes[0], b = links[i].m_nodes[1];
        const float mobility = nodes.inverseMass(a) + nodes.inverseMass(b);
        sweep.set(i, 1e-4f, mobility > 0 ? 1 / mobility : 0.0f);
    }
    sweep.start(nodes.paths(), nullptr);
}
}  // namespace

TEST(SolverNodes, ANodeIsAtTheEndOfItsPathUntilItIsMoved)
{
    const Vec3 start = vec3(1, 2, 3), way = vec3(0.5f, 0, -0.25f), shift = vec3(0, 0.125f, 0);
    SolverNodes nodes;
    nodes.resize(2);
    nodes.setPath(1, start, way, vec3(4, 5, 6), 0.5f);
    expectEqual(nodes.displacement(1), way);
    expectEqual(nodes.position(1), nodes.end(1));
    expectEqual(nodes.end(1), vec3(1.5f, 2, 2.75f));
    EXPECT_EQ(nodes.inverseMass(1), 0.5f);
    EXPECT_FALSE(nodes.isShifted(1));
    nodes.remember(1);
    nodes.shift(1, shift);
    EXPECT_TRUE(nodes.isShifted(1));
    expectEqual(nodes.position(1), vec3Add(nodes.end(1), shift));
    expectEqual(nodes.pathVector(1), way);
    nodes.addShift(1, 8);
    expectEqual(nodes.velocity(1), vec3(4, 6, 6));
    nodes.setEnd(1, nodes.displacement(1), vec3(0, 0, 0));
    EXPECT_FALSE(nodes.isShifted(1));
    expectEqual(nodes.start(1), start);
    expectEqual(nodes.pathVector(1), vec3Add(way, shift));
    nodes.addShift(1, 8);  // without effect: the node was not shifted
    expectEqual(nodes.velocity(1), vec3(0, 0, 0));
}

TEST(Substeps, AFreeNodeEndsAtTheEndOfItsPath)
{
    Random random(703);
    SCOPED_TRACE("seed 703");
    for (const int count : {1, 2, 5, 16})
    {
        SCOPED_TRACE(std::to_string(count) + " substeps");
        const Vec3 start = randomVector(100, random), way = randomVector(0.05f, random);
        const std::vector<Vec3> accelerations{randomVector(10, random)};
        SolverNodes nodes;
        nodes.resize(1);
        nodes.setPath(0, start, way, vec3(0, 0, 0), 1);
        Substeps substeps;
        substeps.links().build(1, 1, {});
        const std::vector<Vec3> unsupported(accelerations.size(), vec3(0, 0, 0));
        substeps.prepare(1.0f / 60, count, 0, accelerations, unsupported);
        substeps.run(nodes, nullptr);
        expectNear(nodes.displacement(0), way, 1e-7f);
        expectEqual(nodes.position(0), vec3Add(start, nodes.displacement(0)));
        // The mean velocity, and half of what the step adds; less by the share of a substep.
        const float share = 1 - Substeps::pathShare(count);
        expectNear(nodes.velocity(0), vec3AddScaled(vec3Scale(way, 60), accelerations[0], share / 60), 1e-5f);
    }
}

TEST(Substeps, DampingKeepsItsShareOfTheVelocity)
{
    for (const int count : {1, 4})
    {
        const std::vector<Vec3> none(1, vec3(0, 0, 0));
        SolverNodes nodes;
        nodes.resize(1);
        nodes.setPath(0, none[0], vec3(1, 0, 0), none[0], 1);
        Substeps substeps;
        substeps.links().build(1, 1, {});
        substeps.prepare(0.5f, count, 0.25f, none, none);
        substeps.run(nodes, nullptr);
        EXPECT_NEAR(nodes.velocity(0).x, 1.5f, 1e-6f) << count << " substeps";
    }
}

// A node's velocity follows what moved it between advance() and end().
TEST(Substeps, CorrectionsBecomeVelocity)
{
    const std::vector<Vec3> none(2, vec3(0, 0, 0));
    const Vec3 way = vec3(0, -1, 0);
    SolverNodes nodes;
    nodes.resize(2);
    for (std::size_t i = 0; i < 2; ++i)
        nodes.setPath(i, none[0], way, none[0], 1);
    Substeps substeps;
    substeps.links().build(2, 1, {});
    substeps.prepare(0.5f, 2, 0, none, none);
    substeps.begin(nodes, nullptr);
    substeps.advance(nodes, nullptr);
    expectEqual(nodes.displacement(0), vec3(0, -0.5f, 0));
    nodes.shift(0, vec3(0, 0.25f, 0));
    substeps.end(nodes, nullptr);
    expectEqual(nodes.velocity(0), vec3(0, -1, 0));
    expectEqual(nodes.velocity(1), vec3(0, -2, 0));  // exactly: nothing corrected it
    substeps.advance(nodes, nullptr);
    expectEqual(nodes.displacement(0), vec3(0, -0.5f, 0));
    expectEqual(nodes.displacement(1), way);
}

// Nodes without links, under forces of their own and damping, have the momentum that keepMomentum() expects.
TEST(Momentum, ForcesAndDampingChangeIt)
{
    Random random(706);
    SCOPED_TRACE("seed 706");
    for (const int count : {1, 2, 7})
    {
        SCOPED_TRACE(std::to_string(count) + " substeps");
        ClothContacts contacts;
        SolverNodes& nodes = contacts.m_nodes;
        nodes.resize(40);
        std::vector<Vec3> accelerations;
        for (std::size_t i = 0; i < nodes.count(); ++i)
        {
            nodes.setPath(i, randomVector(1, random), randomVector(0.05f, random), vec3(0, 0, 0),
                          random.uniform(0.5f, 2));
            accelerations.push_back(randomVector(30, random));
        }
        Substeps substeps;
        substeps.links().build(nodes.count(), 1, {});
        const std::vector<Vec3> unsupported(accelerations.size(), vec3(0, 0, 0));
        substeps.prepare(1.0f / 60, count, 0, accelerations, unsupported);
        substeps.run(nodes, nullptr);
        std::vector<Vec3> before;
        for (std::size_t i = 0; i < nodes.count(); ++i)
            before.push_back(nodes.velocity(i));
        const SolverCloth cloth = {&contacts, &substeps, nullptr, nullptr};
        ASSERT_TRUE(keepsMomentum(cloth));
        keepMomentum(cloth);
        for (std::size_t i = 0; i < nodes.count(); ++i)
            expectNear(nodes.velocity(i), before[i], 2e-6f);
    }
}

// Velocities that turn with the cloth replace spin and motion that were lost.
TEST(Momentum, LostMomentumComesBack)
{
    Random random(707);
    SCOPED_TRACE("seed 707");
    const std::vector<Vec3> none(30, vec3(0, 0, 0));
    ClothContacts contacts;
    SolverNodes& nodes = contacts.m_nodes;
    nodes.resize(none.size());
    for (std::size_t i = 0; i < nodes.count(); ++i)
        nodes.setPath(i, randomVector(1, random), randomVector(0.05f, random), none[i], random.uniform(0.5f, 2));
    Substeps substeps;
    substeps.links().build(nodes.count(), 1, {});
    substeps.prepare(1.0f / 60, 2, 0, none, none);
    substeps.run(nodes, nullptr);
    std::vector<Vec3> before;
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        before.push_back(nodes.velocity(i));
        const Vec3 lost = vec3AddScaled(vec3(0, 0.01f, 0), vec3Cross(vec3(0.02f, 0, 0.01f), nodes.position(i)), -1);
        nodes.addVelocity(i, lost);
    }
    const SolverCloth cloth = {&contacts, &substeps, nullptr, nullptr};
    keepMomentum(cloth);
    for (std::size_t i = 0; i < nodes.count(); ++i)
        expectNear(nodes.velocity(i), before[i], 1e-5f);
    const Vec3 fast = vec3Scale(nodes.velocity(0), 1.1f);
    nodes.setPath(3, none[3], none[3], none[3], 0);
    nodes.setVelocity(0, fast);
    keepMomentum(cloth);
    expectEqual(nodes.velocity(0), fast);  // a node is fixed
}

TEST(Substeps, GiveTheSameBitsOnAnyNumberOfThreads)
{
    constexpr std::size_t kNodes = 20000;
    std::vector<float> expected;
    for (const unsigned threads : {0u, 1u, 3u})
    {
        Random random(705);
        SCOPED_TRACE("seed 705");
        SolverNodes nodes;
        nodes.resize(kNodes);
        std::vector<Vec3> places, accelerations;
        for (std::size_t i = 0; i < kNodes; ++i)
        {
            places.push_back(vec3AddScaled(randomVector(0.01f, random), vec3(0.01f, 0, 0), float(i)));
            nodes.setPath(i, places[i], randomVector(0.05f, random), vec3(0, 0, 0),
                          random.below(10) == 0 ? 0.0f : 1.0f);
            accelerations.push_back(randomVector(10, random));
        }
        Substeps substeps;
        ASSERT_NO_FATAL_FAILURE(linkNeighbours(nodes, places, substeps.links()));
        const std::vector<Vec3> unsupported(accelerations.size(), vec3(0, 0, 0));
        substeps.prepare(1.0f / 60, 5, 0.1f, accelerations, unsupported);
        ThreadTeam team(std::max(1u, threads));
        substeps.run(nodes, threads == 0 ? nullptr : &team);
        std::vector<float> found;
        for (std::size_t i = 0; i < kNodes; ++i)
            for (const Vec3 v : {nodes.displacement(i), nodes.velocity(i)})
                found.insert(found.end(), {v.x, v.y, v.z});
        if (expected.empty()) expected = found;
        EXPECT_TRUE(found == expected) << threads << " threads";
    }
}
}  // namespace drape::test
