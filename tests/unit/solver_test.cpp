// Links by themselves: sweeps over them, and their strength.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "bullet_plugin/core/solver/host/link_sweep.h"
#include "bullet_plugin/core/solver/link_strength.h"
#include "kernels/lib/geometry/vec3.h"
#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
using Nodes = std::vector<SolverNode>;

// The nodes start at one position, so displacements are positions.
const Vec3 kTogether = vec3(0, 0, 0);

bool sameBits(const Nodes& a, const Nodes& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(SolverNode)) == 0;
}

Nodes randomNodes(std::size_t count, Random& random)
{
    Nodes nodes(count);
    for (SolverNode& node : nodes)
    {
        for (float* coordinate : {&node.m_displacement.x, &node.m_displacement.y, &node.m_displacement.z})
            *coordinate = random.uniform(-1, 1);
        node.m_inverseMass = random.below(10) == 0 ? 0.0f : random.uniform(0.5f, 2);
    }
    return nodes;
}

// Returns the smallest group of a heap with so many leaves that has both nodes; a leaf has a range of nodes.
std::uint32_t groupOf(std::size_t a, std::size_t b, std::size_t nodeCount, std::size_t leafCount)
{
    std::size_t groupA = leafCount + a * leafCount / nodeCount, groupB = leafCount + b * leafCount / nodeCount;
    while (groupA != groupB)
        (groupA > groupB ? groupA : groupB) /= 2;
    return std::uint32_t(groupA);
}

// Links of near nodes, some of distant ones.
std::vector<LinkNodes> randomLinks(std::size_t count, std::size_t nodeCount, std::size_t leafCount, Random& random)
{
    std::vector<LinkNodes> links;
    while (links.size() < count)
    {
        const std::uint32_t a = random.below(std::uint32_t(nodeCount)),
                            b = random.below(8) == 0 ? random.below(std::uint32_t(nodeCount))
                                                     : std::min(std::uint32_t(nodeCount - 1), a + 1 + random.below(40));
        if (a != b) links.push_back({{a, b}, groupOf(a, b, nodeCount, leafCount)});
    }
    return links;
}

// Moves both nodes as btSoftBody::PSolve_Links does, with kLST of 1.
void visitAlone(SolverNode& a, SolverNode& b, float restSquared)
{
    const float c0 = a.m_inverseMass + b.m_inverseMass;
    const Vec3 apart = vec3Add(kTogether, vec3Sub(b.m_displacement, a.m_displacement));
    const float length2 = vec3Dot(apart, apart);
    if (!(c0 > 0) || !(restSquared + length2 > 1.2e-7f)) return;
    const float k = 1 / c0 * (restSquared - length2) / (restSquared + length2);
    a.m_displacement = vec3Sub(a.m_displacement, vec3Scale(apart, k * a.m_inverseMass));
    b.m_displacement = vec3Add(b.m_displacement, vec3Scale(apart, k * b.m_inverseMass));
}

float strengthOf(const SolverNode& a, const SolverNode& b)
{
    const float c0 = a.m_inverseMass + b.m_inverseMass;
    return c0 > 0 ? 1 / c0 : 0.0f;
}

double distance(const SolverNode& a, const SolverNode& b)
{
    const Vec3 &p = a.m_displacement, &q = b.m_displacement;
    return std::hypot(double(p.x) - double(q.x), double(p.y) - double(q.y), double(p.z) - double(q.z));
}
}  // namespace

TEST(LinkSweep, GivesTheSameBitsOnAnyNumberOfThreads)
{
    constexpr std::size_t kNodes = 20000, kLeaves = 16;
    Random random(700);
    SCOPED_TRACE("seed 700");
    const Nodes start = randomNodes(kNodes, random);
    const std::vector<LinkNodes> links = randomLinks(60000, kNodes, kLeaves, random);
    std::vector<NodePath> paths(kNodes);
    for (NodePath& path : paths)
        path.m_start = vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    Nodes expected;
    for (const unsigned threads : {0u, 1u, 2u, 7u})
    {
        ThreadTeam team(std::max(1u, threads));
        LinkSweep sweep;
        sweep.build(kNodes, kLeaves, links);
        ASSERT_EQ(sweep.linkCount(), links.size());
        for (std::size_t i = 0; i < links.size(); ++i)
            sweep.set(i, 0.01f * float(1 + i % 7), strengthOf(start[links[i].m_nodes[0]], start[links[i].m_nodes[1]]));
        sweep.start(paths.data(), threads == 0 ? nullptr : &team);
        Nodes nodes = start;
        for (int i = 0; i < 5; ++i)
            sweep.sweep(nodes.data(), threads == 0 ? nullptr : &team);
        if (expected.empty()) expected = nodes;
        EXPECT_TRUE(sameBits(nodes, expected)) << threads << " threads";
        EXPECT_FALSE(sameBits(nodes, start));
    }
}

// Every number of links up to a few blocks, of which no two share a node.
TEST(LinkSweep, VisitsEachLinkOnceAsBulletDoes)
{
    Random random(701);
    SCOPED_TRACE("seed 701");
    for (std::size_t count = 0; count <= 13; ++count)
    {
        Nodes nodes = randomNodes(2 * count + 1, random);
        std::vector<LinkNodes> links;
        for (std::size_t i = 0; i < count; ++i)
            links.push_back({{std::uint32_t(2 * i + 1), std::uint32_t(2 * i)}, 1});
        LinkSweep sweep;
        sweep.build(nodes.size(), 1, links);
        Nodes expected = nodes;
        for (std::size_t i = 0; i < count; ++i)
        {
            const float restSquared = i % 4 == 0 ? 0.0f : 0.3f;
            SolverNode &a = expected[2 * i + 1], &b = expected[2 * i];
            sweep.set(i, restSquared, strengthOf(a, b));
            visitAlone(a, b, restSquared);
        }
        sweep.sweep(nodes.data(), nullptr);
        EXPECT_TRUE(sameBits(nodes, expected)) << count << " links";
    }
}

// Pushes of a link are opposite, so that the centre of mass stays.
TEST(LinkSweep, KeepsTheCentreOfMass)
{
    constexpr std::size_t kNodes = 3000, kLeaves = 4;
    Random random(704);
    SCOPED_TRACE("seed 704");
    Nodes nodes = randomNodes(kNodes, random);
    for (SolverNode& node : nodes)
        node.m_inverseMass = 1;
    const auto sums = [&nodes]
    {
        std::vector<double> all(3, 0.0);
        for (const SolverNode& node : nodes)
        {
            all[0] += double(node.m_displacement.x);
            all[1] += double(node.m_displacement.y);
            all[2] += double(node.m_displacement.z);
        }
        return all;
    };
    const std::vector<double> before = sums();
    LinkSweep sweep;
    sweep.build(kNodes, kLeaves, randomLinks(9000, kNodes, kLeaves, random));
    for (std::size_t i = 0; i < sweep.linkCount(); ++i)
        sweep.set(i, 0.1f, 0.5f);
    for (int i = 0; i < 10; ++i)
        sweep.sweep(nodes.data(), nullptr);
    // A visit rounds six coordinates by 2^-25 m at most; errors of either sign add up like their root.
    const double bound = 4 * std::sqrt(2.0 * 9000 * 10) * std::pow(2, -25);
    for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(sums()[axis], before[axis], bound);
}

// A node with more links than there are colours; each link has its own end.
TEST(LinkSweep, HandlesANodeWithAHundredLinks)
{
    constexpr std::size_t kLinks = 100;
    Random random(702);
    Nodes nodes = randomNodes(kLinks + 1, random);
    std::vector<LinkNodes> links;
    for (std::uint32_t i = 1; i <= kLinks; ++i)
        links.push_back({{0, i}, 1});
    LinkSweep sweep;
    sweep.build(nodes.size(), 1, links);
    for (SolverNode& node : nodes)
        node.m_inverseMass = 1;
    for (std::size_t i = 0; i < kLinks; ++i)
        sweep.set(i, 1, 0.5f);
    for (int i = 0; i < 400; ++i)
        sweep.sweep(nodes.data(), nullptr);
    for (std::size_t i = 1; i <= kLinks; ++i)
        EXPECT_NEAR(distance(nodes[0], nodes[i]), 1, 1e-3) << "link " << i;
}

TEST(LinkSweep, LeavesLinksWithoutStrengthOrLengthAlone)
{
    Nodes nodes(4, SolverNode{{1, 2, 3}, 1});
    nodes[2].m_displacement.x = 5;
    const Nodes before = nodes;
    LinkSweep sweep;
    sweep.build(4, 1, {{{0, 1}, 1}, {{2, 3}, 1}});
    sweep.set(0, 0, 0.5f);  // both nodes at one position, and no length at rest
    sweep.sweep(nodes.data(), nullptr);
    EXPECT_TRUE(sameBits(nodes, before));
}

// A mass that hangs on one link, once by iterations of whole steps as in Bullet and once in substeps.
TEST(LinkStrength, AHangingMassStretchesItsLinkAsInBullet)
{
    constexpr double kTime = 1.0 / 60, kGravity = 9.81;
    for (const double stiffness : {0.02, 0.1, 0.5, 0.9})
    {
        for (const int iterations : {1, 4, 10})
        {
            double bullet = 0;  // m, below the rest length; every step starts at rest
            for (int step = 0; step < 20000; ++step)
                bullet = (bullet + kGravity * kTime * kTime) * std::pow(1 - stiffness, iterations);
            for (const int substeps : {1, 4, 12})
            {
                for (const int visits : {1, 3})
                {
                    const double h = kTime / substeps, share = visitShare(stiffness, iterations, substeps, visits);
                    double own = 0;
                    for (int step = 0; step < 400000; ++step)
                        own = (own + kGravity * h * h) * std::pow(1 - share, visits);
                    EXPECT_NEAR(own, bullet, 0.002 * bullet + 1e-12)
                        << stiffness << ", " << iterations << " iterations, " << substeps << " substeps";
                }
            }
        }
    }
    EXPECT_EQ(visitShare(1, 1, 5, 3), 1);
    EXPECT_EQ(visitShare(2, 1, 5, 3), 1);
    EXPECT_EQ(visitShare(0, 4, 5, 3), 0);
    EXPECT_EQ(visitShare(-1, 4, 5, 3), 0);
}
}  // namespace drape::test
