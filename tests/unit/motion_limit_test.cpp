// Motion limits of nodes near obstacles. Points limited one by one equal those of the whole cloth at once, nodes follow
// a moving obstacle, and triangles limit their nodes.
#include "bullet_plugin/core/solver/host/motion_limit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
constexpr std::size_t kNodes = 600;
constexpr float kActivation = 0.5f, kThickness = 0.02f;
constexpr std::size_t kNotANumber = 3;  // a node whose displacement is none

bool same(Vec3 a, Vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

// Nodes with a displacement. Some are pinned and one has none; every third has contacts.
struct OffPath
{
    SolverNodes m_nodes;
    MotionLimit m_limit;
    ClothFaces m_faces;
    std::vector<Vec3> m_pulled;  // displacements after they went

    static bool hasContact(std::size_t node) { return node % 3 == 0; }

    explicit OffPath(std::uint32_t seed)
    {
        Random random(seed);
        const auto vector = [&random](float most)
        {
            const float x = random.uniform(-most, most), y = random.uniform(-most, most);
            return vec3(x, y, random.uniform(-most, most));
        };
        m_nodes.resize(kNodes);
        std::vector<std::int32_t> triangles;
        for (std::size_t i = 0; i < kNodes; ++i)
        {
            const Vec3 start = vector(1), way = vector(0.03f);
            m_nodes.setPath(i, start, way, vec3(0, 0, 0), i % 7 == 0 ? 0.0f : 100.0f);
            triangles.push_back(std::int32_t(i));
        }
        m_faces = ClothFaces(std::move(triangles), kNodes);
        m_limit.addObstacle(vec3(-1, -1, -1), vec3(1, 0.2f, 1), 0.02f, kActivation);
        m_limit.addObstacle(vec3(-1, 0, -1), vec3(0.3f, 1, 1), 0.05f, kActivation);
        m_limit.startStep(m_faces);
        for (std::size_t i = 0; i < kNodes; ++i)
        {
            if (hasContact(i)) m_limit.addContactNode(int(i));
            m_pulled.push_back(vec3Add(m_nodes.pathVector(i), vector(0.04f)));
        }
        m_pulled[kNotANumber].x = std::numeric_limits<float>::quiet_NaN();
        for (std::size_t i = 0; i < kNodes; ++i)
            m_nodes.setCurrent(i, m_pulled[i], vec3(0, 0, 0));
    }

    bool wasMoved(std::size_t node) const { return !same(m_nodes.displacement(node), m_pulled[node]); }
};
}  // namespace

TEST(MotionLimit, LimitsNodesWithContactsOneByOne)
{
    SCOPED_TRACE("seed 4");
    OffPath cloth(4), alone(4);
    ASSERT_TRUE(cloth.m_limit.obstaclesRest());
    cloth.m_limit.apply(cloth.m_nodes);
    std::size_t brought = 0, left = 0;
    for (std::size_t i = 0; i < kNodes; ++i)
    {
        alone.m_limit.keepNear(alone.m_nodes, i);
        if (i == kNotANumber) continue;
        if (!OffPath::hasContact(i))
        {
            EXPECT_FALSE(alone.wasMoved(i)) << "node " << i;
            continue;
        }
        EXPECT_TRUE(same(alone.m_nodes.displacement(i), cloth.m_nodes.displacement(i))) << "node " << i;
        EXPECT_EQ(alone.m_nodes.isShifted(i), cloth.m_nodes.isShifted(i)) << "node " << i;
        EXPECT_EQ(alone.m_nodes.isShifted(i), cloth.wasMoved(i)) << "node " << i;
        ++(cloth.wasMoved(i) ? brought : left);
    }
    EXPECT_GT(brought, kNodes / 12);
    EXPECT_GT(left, kNodes / 24);
}

TEST(MotionLimit, LimitsNodesWithoutContactsSeparately)
{
    SCOPED_TRACE("seed 4");
    OffPath cloth(4), whole(4);
    whole.m_limit.apply(whole.m_nodes);
    cloth.m_limit.applyToOthers(cloth.m_nodes);
    std::size_t brought = 0;
    for (std::size_t i = 0; i < kNodes; ++i)
    {
        if (i == kNotANumber) continue;
        if (OffPath::hasContact(i))
        {
            EXPECT_FALSE(cloth.wasMoved(i)) << "node " << i;
            continue;
        }
        EXPECT_TRUE(same(cloth.m_nodes.displacement(i), whole.m_nodes.displacement(i))) << "node " << i;
        EXPECT_EQ(cloth.m_nodes.isShifted(i), whole.m_nodes.isShifted(i)) << "node " << i;
        brought += cloth.wasMoved(i) ? 1 : 0;
    }
    EXPECT_GT(brought, kNodes / 12);
}

TEST(MotionLimit, LeavesFixedNodesAlone)
{
    SCOPED_TRACE("seed 4");
    OffPath cloth(4);
    cloth.m_limit.apply(cloth.m_nodes);
    for (std::size_t i = 0; i < kNodes; i += 7)
        EXPECT_FALSE(cloth.wasMoved(i)) << "node " << i;
}

// Each face limits all of its nodes. Faces share nodes, come in any order and with any node first, and may be given
// twice.
TEST(MotionLimit, HonoursEveryFaceOfANode)
{
    SCOPED_TRACE("seed 5");
    std::vector<Vec3> expected;
    for (int turn = 0; turn < 4; ++turn)
    {
        OffPath cloth(5);
        Random random(6);  // identical faces in each iteration
        std::vector<std::int32_t> triangles;
        for (std::size_t i = 0; i < 3 * 2 * kNodes; ++i)
            triangles.push_back(std::int32_t(random.uniform(0, float(kNodes) - 0.001f)));
        if (turn == 1) std::reverse(triangles.begin(), triangles.end());
        if (turn == 2) std::rotate(triangles.begin(), triangles.begin() + 300, triangles.end());
        if (turn == 3)
        {
            for (std::size_t i = 0; i < triangles.size(); i += 3)
                std::rotate(&triangles[i], &triangles[i] + 1, &triangles[i] + 3);
            const std::vector<std::int32_t> again = triangles;
            triangles.insert(triangles.end(), again.begin(), again.end());
        }
        const ClothFaces faces(std::move(triangles), kNodes);
        cloth.m_limit.startStep(faces);
        cloth.m_limit.apply(cloth.m_nodes);
        std::vector<Vec3> places;
        for (std::size_t i = 0; i < kNodes; ++i)
            places.push_back(cloth.m_nodes.displacement(i));
        if (turn == 0) expected = places;
        std::size_t brought = 0;
        for (std::size_t i = 0; i < kNodes; ++i)
        {
            if (i == kNotANumber) continue;
            EXPECT_TRUE(same(places[i], expected[i])) << "node " << i << ", turn " << turn;
            brought += cloth.wasMoved(i) ? 1 : 0;
        }
        EXPECT_GT(brought, kNodes / 4);
        EXPECT_LT(brought, kNodes);
    }
}

namespace
{
// An obstacle went up by 1 m: not at all, as a body or by its vertices.
enum class Rise
{
    None,
    Body,
    Vertices
};

const float kUp[12] = {1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 0};

// Returns the limited position of a node that rested at the origin and ended at `to`, beside an obstacle.
Vec3 limited(Vec3 to, Rise rise)
{
    SolverNodes nodes;
    nodes.resize(1);
    nodes.setPath(0, vec3(0, 0, 0), vec3(0, 0, 0), vec3(0, 0, 0), 1);
    const Vec3 raised = vec3(0, 1, 0);
    const Carry carry{rise == Rise::Body ? kUp : nullptr, rise == Rise::Vertices ? &raised : nullptr};
    MotionLimit limit;
    limit.addObstacle(vec3(-2, -2, -2), vec3(2, 2, 2), kThickness, 0.5f, carry);
    const ClothFaces noFaces({}, 1);
    limit.startStep(noFaces);
    limit.addContactNode(0);
    EXPECT_EQ(limit.obstaclesRest(), rise == Rise::None);
    EXPECT_EQ(limit.mostCarried(nodes), rise == Rise::None ? 0.0f : 1.0f);
    nodes.setCurrent(0, to, vec3(0, 0, 0));
    limit.apply(nodes);
    return nodes.position(0);
}
}  // namespace

// A node moves with the obstacle, and no farther from its path than beside an obstacle at rest.
TEST(MotionLimit, MovesWithTheObstacle)
{
    const Vec3 half = vec3(0, 0.5f, 0), beside = vec3(0.5f, 0.5f, 0), beyond = vec3(0, 2, 0);
    EXPECT_NEAR(limited(half, Rise::None).y, kThickness / 2, 1e-6);
    for (const Rise rise : {Rise::Body, Rise::Vertices})
    {
        EXPECT_TRUE(same(limited(half, rise), half));
        EXPECT_NEAR(limited(beside, rise).x, kThickness / 2, 1e-6);
        EXPECT_NEAR(limited(beside, rise).y, 0.5, 1e-6);
        EXPECT_NEAR(limited(beyond, rise).y, 1 + kThickness / 2, 1e-6);
    }
}

// Only nodes with contacts count, and nothing does beside obstacles at rest.
TEST(MotionLimit, BoundsWhatObstaclesCarry)
{
    SolverNodes nodes;
    nodes.resize(2);
    for (std::size_t i = 0; i < 2; ++i)
        nodes.setPath(i, vec3(0, 0, 0), vec3(0, 0, 0), vec3(0, 0, 0), 1);
    const Vec3 starts[] = {vec3(0, 0, 3), vec3(0, 4, 0)};
    const ClothFaces noFaces({}, 2);
    MotionLimit limit;
    limit.addObstacle(vec3(-1, -1, -1), vec3(1, 1, 1), kThickness, kActivation);
    limit.startStep(noFaces);
    limit.addContactNode(0);
    EXPECT_EQ(limit.mostCarried(nodes), 0);
    limit.addObstacle(vec3(-1, -1, -1), vec3(1, 1, 1), kThickness, kActivation, {kUp, nullptr});
    EXPECT_EQ(limit.mostCarried(nodes), 1);
    limit.addObstacle(vec3(-1, -1, -1), vec3(1, 1, 1), kThickness, kActivation, {nullptr, starts});
    EXPECT_EQ(limit.mostCarried(nodes), 3);
    limit.addContactNode(1);
    EXPECT_EQ(limit.mostCarried(nodes), 4);
    limit.clear();
    EXPECT_TRUE(limit.obstaclesRest());
    EXPECT_EQ(limit.mostCarried(nodes), 0);
}

// All nodes are beside the obstacle before and after they were pulled; only their triangle comes over its corner.
TEST(MotionLimit, LimitsTrianglesThatArePulledOverACorner)
{
    const Vec3 starts[] = {vec3(2.2f, 0.5f, 0), vec3(0.5f, 2.2f, 0), vec3(2.2f, 2.2f, 0)};
    const Vec3 pull = vec3(-0.5f, -0.5f, 0);
    const float unmoved[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    for (const bool joined : {true, false})
    {
        for (const bool moves : {true, false})
        {
            SolverNodes nodes;
            nodes.resize(3);
            const ClothFaces faces(joined ? std::vector<std::int32_t>{0, 1, 2} : std::vector<std::int32_t>(), 3);
            MotionLimit limit;
            limit.addObstacle(vec3(-1, -1, -1), vec3(1, 1, 1), kThickness, 0.5f, {moves ? unmoved : nullptr, nullptr});
            limit.startStep(faces);
            for (std::size_t i = 0; i < 3; ++i)
            {
                nodes.setPath(i, starts[i], vec3(0, 0, 0), vec3(0, 0, 0), 1);
                nodes.setCurrent(i, pull, vec3(0, 0, 0));
            }
            EXPECT_EQ(limit.anyOffPath(nodes), joined);
            limit.apply(nodes);
            const float most = joined ? kFreeShare * 1.5f * kThickness : vec3Length(pull);
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_NEAR(vec3Length(nodes.displacement(i)), most, 1e-6) << "node " << i;
        }
    }
}
}  // namespace drape::test
