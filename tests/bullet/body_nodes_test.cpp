// Exchange of nodes between a soft body and the solver: paths, ends, and what is written back.
#include "bullet_plugin/adapter/solver/body_nodes.h"

#include <gtest/gtest.h>

#include "tests/bullet/drop_world.h"

namespace drape::test
{
namespace
{
void expectEqual(Vec3 is, Vec3 expected)
{
    EXPECT_EQ(is.x, expected.x);
    EXPECT_EQ(is.y, expected.y);
    EXPECT_EQ(is.z, expected.z);
}

// Two nodes far from the origin, each on its way from m_q to m_x; the second one is pinned. All numbers are exact.
struct MovingPair
{
    MovingPair() : m_body(&m_info, 2, m_starts, m_masses)
    {
        for (int i = 0; i < 2; ++i)
        {
            m_body.m_nodes[i].m_x += btVector3(0, -0.25f, 0.125f);
            m_body.m_nodes[i].m_v.setValue(1, btScalar(2 + i), 3);
        }
        m_nodes.resize(2);
        for (int i = 0; i < 2; ++i)
            recordPath(m_body.m_nodes[i], std::size_t(i), m_nodes);
    }

    const btVector3 m_starts[2] = {btVector3(1024, 2, 3), btVector3(-4, 5, 6)};
    const btScalar m_masses[2] = {btScalar(0.5), 0};
    btSoftBodyWorldInfo m_info;
    btSoftBody m_body;
    SolverNodes m_nodes;
};
}  // namespace

TEST(BodyNodes, PathsLeadFromTheStepsStartToTheCurrentPosition)
{
    const MovingPair pair;
    const SolverNodes& nodes = pair.m_nodes;
    expectEqual(nodes.start(0), vec3(1024, 2, 3));
    expectEqual(nodes.start(1), vec3(-4, 5, 6));
    for (std::size_t i = 0; i < 2; ++i)
    {
        expectEqual(nodes.pathVector(i), vec3(0, -0.25f, 0.125f));
        expectEqual(nodes.displacement(i), nodes.pathVector(i));
        expectEqual(nodes.velocity(i), vec3(1, float(2 + i), 3));
        EXPECT_FALSE(nodes.isShifted(i));
    }
    EXPECT_EQ(nodes.inverseMass(0), 2);
    EXPECT_EQ(nodes.inverseMass(1), 0);
}

TEST(BodyNodes, ContactsMayNotMoveAnchoredNodes)
{
    MovingPair pair;
    pair.m_body.m_nodes[0].m_battach = -1;  // a bit with a sign
    recordPath(pair.m_body.m_nodes[0], 0, pair.m_nodes);
    EXPECT_EQ(pair.m_nodes.inverseMass(0), 0);
    EXPECT_EQ(pair.m_nodes.nodes()[0].m_inverseMass, 2) << "links do";
}

TEST(BodyNodes, RecordEndKeepsTheStartOfThePath)
{
    MovingPair pair;
    SolverNodes& nodes = pair.m_nodes;
    nodes.shift(0, vec3(0, 1, 0));
    btSoftBody::Node& node = pair.m_body.m_nodes[0];
    node.m_x = btVector3(1024, 1, 4);
    node.m_q = btVector3(0, 0, 0);
    node.m_v.setValue(0, 0, 7);
    recordEnd(node, 0, nodes);
    expectEqual(nodes.start(0), vec3(1024, 2, 3));
    expectEqual(nodes.pathVector(0), vec3(0, -1, 1));
    expectEqual(nodes.displacement(0), nodes.pathVector(0));
    expectEqual(nodes.velocity(0), vec3(0, 0, 7));
    EXPECT_EQ(nodes.inverseMass(0), 2);
    EXPECT_FALSE(nodes.isShifted(0));
}

TEST(BodyNodes, ShiftedNodesAloneAreWrittenBack)
{
    MovingPair pair;
    pair.m_nodes.shift(0, vec3(0, 0.5f, 0));
    pair.m_nodes.setVelocity(0, vec3(4, 4, 4));
    pair.m_nodes.setVelocity(1, vec3(5, 5, 5));
    const btVector3 other = pair.m_body.m_nodes[1].m_x;
    writeShifted(pair.m_nodes, pair.m_body);
    EXPECT_TRUE(pair.m_body.m_nodes[0].m_x == btVector3(1024, 2.25f, 3.125f));
    EXPECT_TRUE(pair.m_body.m_nodes[0].m_v == btVector3(4, 4, 4));
    EXPECT_TRUE(pair.m_body.m_nodes[1].m_x == other);
    EXPECT_TRUE(pair.m_body.m_nodes[1].m_v == btVector3(1, 3, 3));
}
}  // namespace drape::test
