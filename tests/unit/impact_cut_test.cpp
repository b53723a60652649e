// Cuts of predicted paths at the first surface that a node would pass: where paths end, which nodes they concern, and
// what their velocities lose.
#include "bullet_plugin/core/solver/host/impact_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace drape::test
{
namespace
{
constexpr float kThickness = 0.02f, kPerSecond = 60;
constexpr float kStandOff = kThickness / 2;  // before the surface

// Nodes that fall from 1 m to -1 m, at x = 0, 1, ….
SolverNodes fallingNodes(std::size_t count)
{
    SolverNodes nodes;
    nodes.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        nodes.setPath(i, vec3(float(i), 1, 0), vec3(0, -2, 0), vec3(0, -2 * kPerSecond, 0), 1);
    return nodes;
}

// Returns the contact of nodes of a fall with the plane y = height, with equal weights.
SolverContact planeContact(const std::vector<int>& nodes, float height)
{
    SolverContact contact = {};
    for (std::size_t k = 0; k < 3; ++k)
    {
        contact.m_nodes[k] = k < nodes.size() ? nodes[k] : -1;
        contact.m_plane.m_weights[k] = k < nodes.size() ? 1 / float(nodes.size()) : 0.0f;
    }
    contact.m_plane.m_normal = vec3(0, 1, 0);
    contact.m_plane.m_point = vec3(0, height, 0);
    contact.m_thickness = kThickness;
    contact.m_gaps.m_start = 1 - height - kThickness;
    contact.m_gaps.m_end = -1 - height - kThickness;
    contact.m_time = (1 - height) / 2;
    return contact;
}

void expectNear(Vec3 is, Vec3 expected)
{
    EXPECT_NEAR(is.x, expected.x, 1e-6f);
    EXPECT_NEAR(is.y, expected.y, 1e-6f);
    EXPECT_NEAR(is.z, expected.z, 1e-6f);
}

void expectUncut(const SolverNodes& nodes, std::size_t node)
{
    EXPECT_FALSE(nodes.isShifted(node)) << "node " << node;
    EXPECT_EQ(nodes.displacement(node).y, nodes.pathVector(node).y) << "node " << node;
    EXPECT_EQ(nodes.velocity(node).y, -2 * kPerSecond) << "node " << node;
}

// Expects the node at a height, with a velocity that lost the rest of its path.
void expectCut(const SolverNodes& nodes, std::size_t node, float height)
{
    EXPECT_TRUE(nodes.isShifted(node)) << "node " << node;
    expectNear(nodes.position(node), vec3(float(node), height, 0));
    EXPECT_NEAR(nodes.velocity(node).y, (height - 1) * kPerSecond, 1e-4f) << "node " << node;
    EXPECT_EQ(nodes.pathVector(node).y, -2) << "the path itself stays";
}
}  // namespace

TEST(ImpactCut, ANodeStopsBeforeThePlaneThatItWouldPass)
{
    for (const float height : {0.75f, 0.0f, -0.5f})
    {
        SolverNodes nodes = fallingNodes(2);
        const std::vector<SolverContact> contacts{planeContact({1}, height)};
        EXPECT_TRUE(anyCuts(contacts));
        EXPECT_TRUE(cutAtImpacts(nodes, contacts, Cut::EachNode, kPerSecond));
        expectUncut(nodes, 0);
        expectCut(nodes, 1, height + kStandOff);
    }
}

TEST(ImpactCut, TheFirstOfSeveralImpactsCounts)
{
    std::vector<SolverContact> contacts{planeContact({0}, -0.5f), planeContact({0}, 0.5f), planeContact({0}, 0)};
    for (int turn = 0; turn < 3; ++turn)
    {
        SolverNodes nodes = fallingNodes(1);
        EXPECT_TRUE(cutAtImpacts(nodes, contacts, Cut::EachNode, kPerSecond));
        expectCut(nodes, 0, 0.5f + kStandOff);
        std::rotate(contacts.begin(), contacts.begin() + 1, contacts.end());
    }
}

TEST(ImpactCut, AFaceCutsAllOfItsNodes)
{
    SolverNodes nodes = fallingNodes(5);
    const std::vector<SolverContact> contacts{planeContact({0, 2, 4}, 0), planeContact({4, 3}, 0.25f)};
    EXPECT_TRUE(cutAtImpacts(nodes, contacts, Cut::EachNode, kPerSecond));
    expectCut(nodes, 0, kStandOff);
    expectUncut(nodes, 1);
    expectCut(nodes, 2, kStandOff);
    expectCut(nodes, 3, 0.25f + kStandOff);
    expectCut(nodes, 4, 0.25f + kStandOff);
}

TEST(ImpactCut, TheWholeBodyStopsAtItsFirstImpact)
{
    SolverNodes nodes = fallingNodes(4);
    const std::vector<SolverContact> contacts{planeContact({2}, 0), planeContact({1}, 0.25f)};
    EXPECT_TRUE(cutAtImpacts(nodes, contacts, Cut::WholeBody, kPerSecond));
    for (std::size_t i = 0; i < nodes.count(); ++i)
        expectCut(nodes, i, 0.25f + kStandOff);
}

TEST(ImpactCut, PinnedNodesStay)
{
    for (const Cut cut : {Cut::EachNode, Cut::WholeBody})
    {
        SolverNodes nodes = fallingNodes(3);
        nodes.setPath(1, nodes.start(1), nodes.pathVector(1), nodes.velocity(1), 0);
        EXPECT_TRUE(cutAtImpacts(nodes, {planeContact({0, 1, 2}, 0)}, cut, kPerSecond));
        expectCut(nodes, 0, kStandOff);
        expectUncut(nodes, 1);
        expectCut(nodes, 2, kStandOff);
    }
}

TEST(ImpactCut, LeavesPathsWithoutImpactAlone)
{
    SolverContact met = planeContact({0}, 0), leaving = met, resting = met;
    met.m_time = 1;                                 // near at the end; nothing was passed
    leaving.m_gaps.m_end = leaving.m_gaps.m_start;  // passed in the other direction
    resting.m_time = std::numeric_limits<float>::quiet_NaN();
    const std::vector<SolverContact> contacts{met, leaving, resting};
    for (const Cut cut : {Cut::EachNode, Cut::WholeBody})
    {
        SolverNodes nodes = fallingNodes(1);
        EXPECT_FALSE(anyCuts(contacts));
        EXPECT_FALSE(cutAtImpacts(nodes, contacts, cut, kPerSecond));
        EXPECT_FALSE(cutAtImpacts(nodes, {}, cut, kPerSecond));
        expectUncut(nodes, 0);
    }
}

// A node that begins nearer than the stand-off does not move at all.
TEST(ImpactCut, ANodeThatStartsTooNearStaysAtItsStart)
{
    SolverNodes nodes = fallingNodes(1);
    EXPECT_TRUE(cutAtImpacts(nodes, {planeContact({0}, 1 - kStandOff / 2)}, Cut::EachNode, kPerSecond));
    expectCut(nodes, 0, 1);
}

// Friction takes its coefficient times the velocity towards the plane from that along it. A second plane takes more.
TEST(ImpactCut, TheVelocityAlongThePlaneIsGivenBackLessFriction)
{
    for (const float friction : {0.0f, 0.25f, 4.0f})
    {
        SolverNodes nodes = fallingNodes(2);
        nodes.setPath(0, vec3(0, 1, 0), vec3(3, -2, 0), vec3(3 * kPerSecond, -2 * kPerSecond, 0), 1);
        SolverContact contact = planeContact({0}, 0);
        contact.m_friction = friction;
        std::vector<Vec3> slides;
        EXPECT_TRUE(cutAtImpacts(nodes, {contact}, Cut::EachNode, kPerSecond, &slides));
        ASSERT_EQ(slides.size(), nodes.count());
        const float lost = 1 - contact.m_time * (1 - kStandOff);  // share of the path
        const float along = lost * kPerSecond * std::max(0.0f, 3 - 2 * friction);
        EXPECT_NEAR(slides[0].x, along, 1e-3f) << friction;
        EXPECT_NEAR(slides[0].y, 0, 1e-3f);
        expectNear(slides[1], vec3(0, 0, 0));
        SolverContact wall = planeContact({0}, 0);
        wall.m_plane.m_normal = vec3(-1, 0, 0);
        wall.m_friction = 0;
        nodes.setEnd(0, nodes.displacement(0), nodes.velocity(0));
        EXPECT_TRUE(cutAtImpacts(nodes, {wall}, Cut::EachNode, kPerSecond, &slides));
        EXPECT_NEAR(slides[0].x, 0, 1e-3f);
    }
}

TEST(ImpactCut, AHeldNodeGetsNoVelocityAlongThePlane)
{
    SolverNodes nodes = fallingNodes(1);
    nodes.setPath(0, vec3(0, 1, 0), vec3(3, -2, 0), vec3(0, 0, 0), 1);
    std::vector<Vec3> slides;
    const SolverContact near = planeContact({0}, 1 - kStandOff / 2);
    EXPECT_TRUE(cutAtImpacts(nodes, {near}, Cut::EachNode, kPerSecond, &slides));
    expectNear(slides[0], vec3(0, 0, 0));
}

// The plane rose by half a metre, as a body or by its vertices: the path ends where the plane carries it.
TEST(ImpactCut, APathEndsWhereAMovingObstacleCarriesIt)
{
    constexpr float kRise = 0.5f;
    const float up[12] = {1, 0, 0, 0, 0, 1, 0, kRise, 0, 0, 1, 0};
    const std::vector<Vec3> starts{vec3(0, 1 + kRise, 0), vec3(1, 1 + kRise, 0)};
    for (const Carry& carry : {Carry{up, nullptr}, Carry{nullptr, starts.data()}})
    {
        SolverNodes nodes = fallingNodes(2);
        SolverContact contact = planeContact({0}, 0);  // at the end of its motion
        contact.m_carry = carry;
        contact.m_gaps.m_start = 1 + kRise - kThickness;
        contact.m_time = (1 + kRise) / (2 + kRise);  // on the way from the carried start to the end
        EXPECT_TRUE(cutAtImpacts(nodes, {contact}, Cut::EachNode, kPerSecond));
        expectCut(nodes, 0, kStandOff);
        expectUncut(nodes, 1);
    }
}

// A body at rest is in the way of an obstacle that falls: its nodes go along.
TEST(ImpactCut, ANodeAtRestIsTakenAlongByAnObstacle)
{
    const float down[12] = {1, 0, 0, 0, 0, 1, 0, -2, 0, 0, 1, 0};
    SolverNodes nodes;
    nodes.resize(1);
    nodes.setPath(0, vec3(0, 0, 0), vec3(0, 0, 0), vec3(0, 0, 0), 1);
    SolverContact contact = planeContact({0}, -1);  // the plane fell from 1 m to -1 m
    contact.m_plane.m_normal = vec3(0, -1, 0);
    contact.m_gaps.m_start = 1 - kThickness;
    contact.m_gaps.m_end = -1 - kThickness;
    contact.m_time = 0.5f;
    contact.m_carry = {down, nullptr};
    EXPECT_TRUE(cutAtImpacts(nodes, {contact}, Cut::EachNode, kPerSecond));
    expectNear(nodes.position(0), vec3(0, -1 - kStandOff, 0));
    EXPECT_NEAR(nodes.velocity(0).y, -(1 + kStandOff) * kPerSecond, 1e-4f);
}
}  // namespace drape::test
