// Motion limits of nodes near obstacles. Points limited one by one equal those of the whole body at once, nodes follow
// a moving obstacle, and triangles limit their nodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_plugin/adapter/motion_limit.h"
#include "tests/bullet/drop_world.h"
#include "tests/bullet/kinematic_scene.h"
#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
constexpr int kNodes = 600;
constexpr btScalar kActivation = btScalar(0.5);

// Nodes with a displacement. Some are pinned and one has none; every third has contacts.
struct Strayed
{
    std::unique_ptr<btSoftBody> m_body;
    MotionLimit m_limit;
    ClothFaces m_faces;
    std::vector<btVector3> m_places;  // after they went

    static bool hasContact(int node) { return node % 3 == 0; }

    Strayed(btSoftBodyWorldInfo& info, std::uint32_t number)
    {
        Random random(number);
        const auto vector = [&random](float most)
        { return btVector3(random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most)); };
        std::vector<btVector3> starts;
        std::vector<btScalar> masses;
        for (int i = 0; i < kNodes; ++i)
        {
            starts.push_back(vector(1));
            masses.push_back(i % 7 == 0 ? btScalar(0) : btScalar(0.01));
        }
        m_body = std::make_unique<btSoftBody>(&info, kNodes, starts.data(), masses.data());
        m_body->m_sst.sdt = kDt;
        m_body->m_sst.isdt = 1 / kDt;
        for (int i = 0; i < kNodes; ++i)
            m_body->m_nodes[i].m_x += vector(0.03f);
        std::vector<std::int32_t> triangles;
        for (int i = 0; i + 2 < kNodes; i += 3)
            triangles.insert(triangles.end(), {i, i + 1, i + 2});
        m_faces = ClothFaces(std::move(triangles), kNodes);
        m_limit.addObstacle(btVector3(-1, -1, -1), btVector3(1, btScalar(0.2), 1), btScalar(0.02), kActivation);
        m_limit.addObstacle(btVector3(-1, 0, -1), btVector3(btScalar(0.3), 1, 1), btScalar(0.05), kActivation);
        m_limit.record(*m_body, m_faces);
        for (int i = 0; i < kNodes; ++i)
        {
            if (hasContact(i)) m_limit.addContactNode(i);
            m_body->m_nodes[i].m_x += vector(0.04f);
        }
        m_body->m_nodes[3].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
        for (int i = 0; i < kNodes; ++i)
            m_places.push_back(m_body->m_nodes[i].m_x);
    }

    bool wasMoved(int node) const { return !(m_body->m_nodes[node].m_x == m_places[static_cast<std::size_t>(node)]); }
};

bool isNumber(const btVector3& place)
{
    return place == place;
}
}  // namespace

TEST(MotionLimit, LimitsNodesWithContactsOneByOne)
{
    btSoftBodyWorldInfo info;
    SCOPED_TRACE("seed 4");
    Strayed strayed(info, 4);
    ASSERT_TRUE(strayed.m_limit.obstaclesRest());
    strayed.m_limit.apply(*strayed.m_body);
    int brought = 0, left = 0;
    for (int i = 0; i < kNodes; ++i)
    {
        if (!Strayed::hasContact(i)) continue;
        btVector3 place = strayed.m_places[static_cast<std::size_t>(i)];
        const bool moved = strayed.m_limit.keepNear(static_cast<std::size_t>(i), place);
        if (!isNumber(place)) continue;
        EXPECT_EQ(place, strayed.m_body->m_nodes[i].m_x) << "node " << i;
        EXPECT_EQ(moved, strayed.wasMoved(i)) << "node " << i;
        ++(moved ? brought : left);
    }
    EXPECT_GT(brought, kNodes / 12);
    EXPECT_GT(left, kNodes / 24);
}

TEST(MotionLimit, LimitsNodesWithoutContactsSeparately)
{
    btSoftBodyWorldInfo info;
    SCOPED_TRACE("seed 4");
    Strayed strayed(info, 4), whole(info, 4);
    whole.m_limit.apply(*whole.m_body);
    strayed.m_limit.applyToOthers(*strayed.m_body);
    int brought = 0;
    for (int i = 0; i < kNodes; ++i)
    {
        const btSoftBody::Node& node = strayed.m_body->m_nodes[i];
        if (!isNumber(node.m_x)) continue;
        if (Strayed::hasContact(i))
        {
            EXPECT_FALSE(strayed.wasMoved(i)) << "node " << i;
            continue;
        }
        EXPECT_EQ(node.m_x, whole.m_body->m_nodes[i].m_x) << "node " << i;
        EXPECT_EQ(node.m_v, whole.m_body->m_nodes[i].m_v) << "node " << i;
        brought += strayed.wasMoved(i) ? 1 : 0;
    }
    EXPECT_GT(brought, kNodes / 12);
}

// Records ranges of nodes, as threads do.
TEST(MotionLimit, RecordsNodesInAnyRanges)
{
    btSoftBodyWorldInfo info;
    SCOPED_TRACE("seed 4");
    Strayed whole(info, 4), parts(info, 4);
    MotionLimit limit;
    limit.startRecord(parts.m_faces);
    const std::pair<std::size_t, std::size_t> stretches[] = {{400, 199}, {0, 1}, {1, 249}, {599, 1}, {250, 150}};
    for (const auto& [first, count] : stretches)
        limit.recordNodes(*parts.m_body, first, count);
    whole.m_limit.record(*parts.m_body, parts.m_faces);
    EXPECT_EQ(limit.paths().m_inverseMass, whole.m_limit.paths().m_inverseMass);
    for (std::size_t i = 0; i < kNodes; ++i)
    {
        if (i == 3) continue;  // no number
        EXPECT_EQ(limit.paths().m_start[i], whole.m_limit.paths().m_start[i]) << "node " << i;
        EXPECT_EQ(limit.paths().m_end[i], whole.m_limit.paths().m_end[i]) << "node " << i;
    }
}

// Each face limits all of its nodes. Faces share nodes, come in any order and with any node first, and may be given
// twice.
TEST(MotionLimit, HonoursEveryFaceOfANode)
{
    SCOPED_TRACE("seed 5");
    std::vector<btVector3> expected;
    for (int turn = 0; turn < 4; ++turn)
    {
        btSoftBodyWorldInfo info;
        Strayed strayed(info, 5);
        Random random(6);  // identical faces in each iteration
        std::vector<std::int32_t> triangles;
        for (int i = 0; i < 3 * 2 * kNodes; ++i)
            triangles.push_back(std::int32_t(random.uniform(0, kNodes - 0.001f)));
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
        const std::vector<btVector3> pulled = strayed.m_places;
        for (int i = 0; i < kNodes; ++i)
            strayed.m_body->m_nodes[i].m_x = strayed.m_limit.paths().m_end[std::size_t(i)];
        strayed.m_limit.record(*strayed.m_body, faces);
        for (int i = 0; i < kNodes; ++i)
            strayed.m_body->m_nodes[i].m_x = pulled[std::size_t(i)];
        strayed.m_limit.apply(*strayed.m_body);
        std::vector<btVector3> places;
        for (int i = 0; i < kNodes; ++i)
            places.push_back(strayed.m_body->m_nodes[i].m_x);
        if (turn == 0) expected = places;
        int brought = 0;
        for (int i = 0; i < kNodes; ++i)
        {
            if (i == 3) continue;  // no number
            EXPECT_EQ(places[std::size_t(i)], expected[std::size_t(i)]) << "node " << i << ", turn " << turn;
            brought += strayed.wasMoved(i) ? 1 : 0;
        }
        EXPECT_GT(brought, kNodes / 4);
        EXPECT_LT(brought, kNodes);
    }
}

namespace
{
// Returns the limited position of a node that rested at the origin and ended at `to`. The obstacle beside it went up by
// 1 m or rested.
btVector3 limited(const btVector3& to, bool moves)
{
    btSoftBodyWorldInfo info;
    const btVector3 place(0, 0, 0);
    const btScalar mass = 1;
    btSoftBody body(&info, 1, &place, &mass);
    body.m_sst.isdt = 1 / kDt;
    const btTransform up = shiftedBy(btVector3(0, 1, 0));
    MotionLimit limit;
    limit.addObstacle(btVector3(-2, -2, -2), btVector3(2, 2, 2), kThickness, btScalar(0.5), moves ? &up : nullptr);
    const ClothFaces noFaces({}, 1);
    limit.record(body, noFaces);
    limit.addContactNode(0);
    body.m_nodes[0].m_x = to;
    limit.apply(body);
    return body.m_nodes[0].m_x;
}
}  // namespace

// A node moves with the obstacle, and no farther from its path than beside an obstacle at rest.
TEST(KinematicMotion, MovesTheLimitOfNodes)
{
    const btVector3 half(0, btScalar(0.5), 0), beside(btScalar(0.5), btScalar(0.5), 0), beyond(0, 2, 0);
    EXPECT_TRUE(limited(half, true) == half);
    EXPECT_NEAR(limited(half, false).y(), kThickness / 2, 1e-6);
    EXPECT_NEAR(limited(beside, true).x(), kThickness / 2, 1e-6);
    EXPECT_NEAR(limited(beside, true).y(), 0.5, 1e-6);
    EXPECT_NEAR(limited(beyond, true).y(), 1 + kThickness / 2, 1e-6);
}

// All nodes are beside the obstacle before and after they were pulled; only their triangle comes over its corner.
TEST(MotionLimit, LimitsTrianglesThatArePulledOverACorner)
{
    const btVector3 places[] = {
        {btScalar(2.2), btScalar(0.5), 0}, {btScalar(0.5), btScalar(2.2), 0}, {btScalar(2.2), btScalar(2.2), 0}};
    const btVector3 pull(btScalar(-0.5), btScalar(-0.5), 0);
    const btScalar masses[] = {1, 1, 1};
    const btTransform rests = btTransform::getIdentity();
    for (const bool joined : {true, false})
    {
        for (const bool moves : {true, false})
        {
            btSoftBodyWorldInfo info;
            btSoftBody body(&info, 3, places, masses);
            body.m_sst.isdt = 1 / kDt;
            const ClothFaces faces(joined ? std::vector<std::int32_t>{0, 1, 2} : std::vector<std::int32_t>(), 3);
            MotionLimit limit;
            limit.addObstacle(btVector3(-1, -1, -1), btVector3(1, 1, 1), kThickness, btScalar(0.5),
                              moves ? &rests : nullptr);
            limit.record(body, faces);
            for (int i = 0; i < 3; ++i)
                body.m_nodes[i].m_x += pull;
            limit.apply(body);
            const btScalar most = joined ? kFreeShare * btScalar(1.5) * kThickness : pull.length();
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR((body.m_nodes[i].m_x - places[i]).length(), most, 1e-6) << "node " << i;
        }
    }
}
}  // namespace drape::test
