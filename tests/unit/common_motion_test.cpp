// The rigid motion that masses have in common, groups of nodes, and nodes that stop each other.
#include <gtest/gtest.h>

#include "bullet_plugin/core/cloth_cloth/stopped_nodes.h"
#include "bullet_plugin/core/solver/host/common_motion.h"
#include "scenes/random.h"

namespace drape::test
{
namespace
{
Vec3d randomVector(Random& random, double most)
{
    return {random.within(-most, most), random.within(-most, most), random.within(-most, most)};
}

struct Momenta
{
    Vec3d m_linear, m_angular;
    double m_energy = 0;
};

Momenta momentaOf(const std::vector<StoppedNode>& nodes)
{
    Momenta sum;
    for (const StoppedNode& node : nodes)
    {
        const Vec3d momentum = node.m_mass * node.m_velocity;
        sum.m_linear = sum.m_linear + momentum;
        sum.m_angular = sum.m_angular + cross(node.m_place, momentum);
        sum.m_energy += dot(momentum, node.m_velocity);
    }
    return sum;
}

void expectNear(Vec3d a, Vec3d b, double tolerance)
{
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

std::vector<StoppedNode> randomNodes(Random& random, std::uint32_t impact)
{
    std::vector<StoppedNode> nodes;
    for (int i = 0; i < 20; ++i)
        nodes.push_back({randomVector(random, 1) + Vec3d{100, 0, 0}, randomVector(random, 5) + Vec3d{0, 30, 0},
                         random.within(0.1, 2), random.within(0, 1), impact});
    return nodes;
}
}  // namespace

TEST(CommonMotion, HasTheMomentaOfWhatWasAdded)
{
    Random random(5);
    const std::vector<StoppedNode> nodes = randomNodes(random, 0);
    CommonMotion motion;
    for (const StoppedNode& node : nodes)
        motion.add(node.m_mass, node.m_place, node.m_velocity);
    motion.compute();
    std::vector<StoppedNode> common = nodes;
    for (StoppedNode& node : common)
        node.m_velocity = motion.velocityAt(node.m_place);
    const Momenta before = momentaOf(nodes), after = momentaOf(common);
    expectNear(after.m_linear, before.m_linear, 1e-10);
    expectNear(after.m_angular, before.m_angular, 1e-4);
    EXPECT_LT(after.m_energy, before.m_energy);
}

TEST(CommonMotion, ABodyCountsAsItsPoints)
{
    // A dumbbell along x that turns about y.
    CommonMotion points, body;
    for (const double side : {-1.0, 1.0})
        points.add(1, {side, 0, 0}, {0, 0, -2 * side});
    body.addBody(2, {0, 0, 0}, {0, 0, 0}, {0, 2, 2, 0, 0, 0}, {0, 2, 0});
    for (CommonMotion* motion : {&points, &body})
    {
        motion->add(1, {0, 3, 1}, {1, 0, 0});
        motion->compute();
    }
    expectNear(points.spin(), body.spin(), 1e-12);
    expectNear(points.velocityAt({5, 6, 7}), body.velocityAt({5, 6, 7}), 1e-12);
}

TEST(CommonMotion, OnePointMovesOn)
{
    CommonMotion motion;
    motion.add(2, {1, 2, 3}, {4, 5, 6});
    motion.compute();
    expectNear(motion.velocityAt({1, 2, 3}), {4, 5, 6}, 1e-12);
}

TEST(StoppedNodes, KeepTheirMomentaAndGainNoEnergy)
{
    Random random(6);
    std::vector<StoppedNode> nodes = randomNodes(random, 7);
    const Momenta before = momentaOf(nodes);
    slowDown(nodes, ImpactMotion::Shares);
    const Momenta after = momentaOf(nodes);
    expectNear(after.m_linear, before.m_linear, 1e-10);
    expectNear(after.m_angular, before.m_angular, 1e-3);
    EXPECT_LT(after.m_energy, before.m_energy);
}

TEST(StoppedNodes, ThatMoveAsOneKeepTheirMomentum)
{
    Random random(7);
    const std::vector<StoppedNode> before = randomNodes(random, 7);
    for (const ImpactMotion motion : {ImpactMotion::Common, ImpactMotion::Straight})
    {
        std::vector<StoppedNode> nodes = before;
        EXPECT_TRUE(slowDown(nodes, motion));
        expectNear(momentaOf(nodes).m_linear, momentaOf(before).m_linear, 1e-10);
        EXPECT_LT(momentaOf(nodes).m_energy, momentaOf(before).m_energy);
        if (motion == ImpactMotion::Straight)
            expectNear(nodes[0].m_velocity, nodes[1].m_velocity, 1e-12);
        else
            expectNear(momentaOf(nodes).m_angular, momentaOf(before).m_angular, 1e-3);
    }
}

TEST(StoppedNodes, BesideHeldNodesTheyLoseTheLeastShare)
{
    for (const bool moves : {false, true})
    {
        Random random(8);
        std::vector<StoppedNode> nodes = randomNodes(random, 3);
        if (!moves) nodes[5].m_mass = 0;
        nodes[4].m_isHeld = moves;
        const std::vector<StoppedNode> before = nodes;
        double least = 1;
        for (const StoppedNode& node : nodes)
            least = std::min(least, node.m_share);
        EXPECT_FALSE(slowDown(nodes, ImpactMotion::Common));
        for (std::size_t i = 0; i < nodes.size(); ++i)
        {
            EXPECT_TRUE(nodes[i].m_isHeld);
            expectNear(nodes[i].m_velocity, (before[i].m_mass > 0 ? least : 1) * before[i].m_velocity, 0);
        }
    }
}

TEST(StoppedNodes, ImpactsAreApart)
{
    Random random(9);
    std::vector<StoppedNode> nodes = randomNodes(random, 1), alone = nodes;
    std::vector<StoppedNode> others = randomNodes(random, 2);
    nodes.insert(nodes.end(), others.begin(), others.end());
    nodes.push_back({{0, 0, 0}, {1, 2, 3}, 1, 1, NodeGroups::kNone});
    slowDown(nodes, ImpactMotion::Shares);
    slowDown(alone, ImpactMotion::Shares);
    for (std::size_t i = 0; i < alone.size(); ++i)
        expectNear(nodes[i].m_velocity, alone[i].m_velocity, 0);
    expectNear(nodes.back().m_velocity, {1, 2, 3}, 0);
}

TEST(NodeGroups, JoinsChains)
{
    NodeGroups groups;
    groups.clear(8);
    groups.join(1, 2);
    groups.join(5, 6);
    groups.join(3, 3);
    groups.join(2, 6);
    groups.nameGroups();
    EXPECT_EQ(groups.groupOf(0), NodeGroups::kNone);
    EXPECT_EQ(groups.groupOf(1), groups.groupOf(5));
    EXPECT_EQ(groups.groupOf(2), groups.groupOf(6));
    EXPECT_NE(groups.groupOf(3), groups.groupOf(1));
    EXPECT_EQ(groups.groupOf(3), 3u);
}
}  // namespace drape::test
