// Cloth that came apart or whose pins were moved elsewhere. Its steps stay short and report what they left out, and the
// cloth comes back. Cloth that keeps its size gets all the tests that it needs, at any speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "bullet_plugin/adapter/collision/stretch.h"
#include "bullet_plugin/core/lists/ordinary_tests.h"
#include "scenes/random.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
// Times as many tests as in ordinary motion that any cloth may make.
constexpr std::size_t kMostTimes = 8;

// Hills of so many triangles under a cloth that lies a little above them.
class Hills
{
public:
    explicit Hills(const Settings& settings, int cells = 100)
        : m_mesh(makeTerrain(4, 0.1f, cells, 3)), m_shape(m_mesh), m_plugin(withLog(settings)), m_world(&m_plugin)
    {
        m_world.addObstacle(m_shape.shape());
    }

    btSoftBody& addCloth(int nodes = 40, const btVector3& centre = btVector3(0, btScalar(0.5), 0))
    {
        ClothSpec spec;
        spec.m_nodes = nodes;
        spec.m_centre = centre;
        return m_world.addCloth(spec);
    }
    void step() { m_world.step(); }
    const StepStatistics& statistics() const { return m_plugin.statistics(); }
    TestLimits ordinary(const btSoftBody& cloth) const
    {
        TestLimits limits = ordinaryTests(std::size_t(cloth.m_faces.size()));
        limits += ordinaryTestsBeside(m_mesh.triangleCount());
        return limits;
    }

    TriangleMesh m_mesh;
    std::vector<std::string> m_lines;  // lines of the log

private:
    Settings withLog(Settings settings)
    {
        settings.m_log = [this](const char* line) { m_lines.push_back(line); };
        return settings;
    }

    MeshShape m_shape;
    Plugin m_plugin;
    DropWorld m_world;
};

// Moves every node on a path of its own, downwards.
void blowApart(btSoftBody& cloth, btScalar speed)
{
    Random random(1);
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
    {
        btVector3 way(btScalar(random.within(-1, 1)), btScalar(random.within(-1, 0)), btScalar(random.within(-1, 1)));
        cloth.m_nodes[i].m_v = way.normalized() * speed;
    }
}

// Returns the longest edge of a face as a multiple of the longest link at rest.
double stretchNow(const btSoftBody& cloth)
{
    double longest = 0, rest = 0;
    for (int i = 0; i < cloth.m_links.size(); ++i)
        rest = std::max(rest, double(cloth.m_links[i].m_rl));
    for (int f = 0; f < cloth.m_faces.size(); ++f)
        for (int k = 0; k < 3; ++k)
            longest = std::max(
                longest, double((cloth.m_faces[f].m_n[k]->m_x - cloth.m_faces[f].m_n[(k + 1) % 3]->m_x).length()));
    return longest / rest;
}

std::size_t toldLeftOut(const std::vector<std::string>& lines)
{
    return std::size_t(std::count_if(lines.begin(), lines.end(),
                                     [](const std::string& line)
                                     { return line.find("does not collide in this step") != std::string::npos; }));
}
}  // namespace

class StretchedCloth : public BackendTest
{
};

// Cloth whose nodes all move apart stays in one piece and collides like any other.
TEST_P(StretchedCloth, ClothThatFliesApartIsHeldTogether)
{
    Hills hills(GetParam().m_settings);
    btSoftBody& cloth = hills.addCloth();
    PenetrationMeter meter(hills.m_mesh, meshOf(cloth));
    for (int step = 0; step < 60; ++step)
    {
        if (step % 10 == 0) blowApart(cloth, 200);
        hills.step();
        ASSERT_EQ(hills.statistics().m_status & ~kStepMotionHeldBack, std::uint32_t(kStepGood)) << step;
        if (step % 10 == 0)
        {
            ASSERT_NE(hills.statistics().m_status, std::uint32_t(kStepGood)) << step;
        }
        // The tests of triangles for this step alone would be sixty million.
        ASSERT_LE(hills.statistics().m_candidates, kMostTimes * hills.ordinary(cloth).m_tests + 1);
        ASSERT_LE(hills.statistics().m_sweptTests, kMostTimes * hills.ordinary(cloth).m_swept);
        const StepMeasure measure = meter.measure(positionsOf(cloth).data());
        ASSERT_EQ(measure.m_intersectingPairs, 0u) << step;
        ASSERT_EQ(measure.nodesBelow(), 0u) << step;
        ASSERT_LT(stretchNow(cloth), double(kMostStretch)) << step;
    }
    EXPECT_TRUE(hills.m_lines.empty());
}

// The cloth's start is stretched already, so that limiting its stretch helps little.
TEST_P(StretchedCloth, ClothInPiecesMakesABoundedNumberOfTests)
{
    Hills hills(GetParam().m_settings);
    btSoftBody& cloth = hills.addCloth();
    hills.step();  // in which Bullet measures the links at rest
    Random random(1);
    for (int step = 0; step < 3; ++step)
    {
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
            cloth.m_nodes[i].m_x = cloth.m_nodes[i].m_q = btVector3(
                btScalar(random.within(-2, 2)), btScalar(random.within(-0.1, 0.1)), btScalar(random.within(-2, 2)));
        blowApart(cloth, 20);
        hills.step();
        EXPECT_NE(hills.statistics().m_status & (kStepClothsLeftOut | kStepMotionHeldBack), 0u);
        EXPECT_LE(hills.statistics().m_candidates, kMostTimes * hills.ordinary(cloth).m_tests + 1);
        EXPECT_LE(hills.statistics().m_sweptTests, kMostTimes * hills.ordinary(cloth).m_swept);
    }
}

// The settings' limit leaves the cloth out.
TEST_P(StretchedCloth, AnOmittedClothIsReportedOnce)
{
    Settings settings = GetParam().m_settings;
    settings.m_candidateLimit = 100;
    Hills hills(settings);
    hills.addCloth(17, btVector3(0, btScalar(0.12), 0));
    std::size_t leftOut = 0;
    for (int step = 0; step < 30; ++step)
    {
        hills.step();
        leftOut += hills.statistics().m_clothsLeftOut;
    }
    EXPECT_GT(leftOut, 1u);
    EXPECT_EQ(toldLeftOut(hills.m_lines), 1u);
}

// A second cloth beside it keeps its contacts, bit for bit.
TEST_P(StretchedCloth, LeavesOthersAsTheyAre)
{
    std::uint64_t hashes[2];
    for (const bool beside : {false, true})
    {
        Hills hills(GetParam().m_settings);
        btSoftBody& cloth = hills.addCloth(17, btVector3(btScalar(-1.2), btScalar(0.25), 0));
        btSoftBody* const other = beside ? &hills.addCloth(40, btVector3(1, btScalar(0.5), 0)) : nullptr;
        std::uint64_t hash = kHashStart;
        std::uint32_t status = 0;
        for (int step = 0; step < 20; ++step)
        {
            if (other && step == 10) blowApart(*other, 200);
            hills.step();
            status |= hills.statistics().m_status;
            hash = hashOf(cloth, hash);
        }
        EXPECT_EQ((status & (kStepClothsLeftOut | kStepMotionHeldBack)) != 0, beside);
        hashes[beside] = hash;
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

// Cloth keeps its size at 200 m/s.
TEST_P(StretchedCloth, FastClothIsNotStretchedCloth)
{
    Hills hills(GetParam().m_settings);
    btSoftBody& cloth = hills.addCloth(40, btVector3(0, 1, 0));
    for (int step = 0; step < 4; ++step)
    {
        const btVector3 velocity(step % 2 ? -80 : 80, -180, 0);
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
            cloth.m_nodes[i].m_v = velocity;
        hills.step();
        EXPECT_EQ(hills.statistics().m_status, std::uint32_t(kStepGood));
    }
    EXPECT_GT(hills.statistics().m_contacts, 0u);
}

namespace
{
// A ball with a cape over it. The test moves it elsewhere by the ball's world transform alone.
class Respawn
{
public:
    Respawn(const Settings& settings, int nodes, int levels, const btVector3& jump)
        : m_pose(btMatrix3x3::getIdentity(), jump),
          m_mesh(makeSphere(0.4f, levels)),
          m_shape(m_mesh),
          m_plugin(settings),
          m_world(&m_plugin),
          m_body(m_world.addKinematic(m_shape.shape())),
          m_cape(m_world.addCloth(specOf(nodes)))
    {
    }

    // Steps after the jump until the cape lies outside of the ball again.
    void jumpAndSettle()
    {
        m_body.setWorldTransform(m_pose);
        std::uint64_t most = 0;
        int leftOut = 0;
        for (int step = 0; step < 300; ++step)
        {
            m_world.step();
            // A cloth that is left out counts candidates that nobody tests.
            if (m_plugin.statistics().m_clothsLeftOut > 0)
                ++leftOut;
            else
                most = std::max(most, m_plugin.statistics().m_candidates);
        }
        EXPECT_LT(most, 1000000u);
        EXPECT_LE(leftOut, 1);
        EXPECT_EQ(m_plugin.statistics().m_status, std::uint32_t(kStepGood));
        for (int i = 0; i < m_cape.m_nodes.size(); ++i)
            ASSERT_LT((m_cape.m_nodes[i].m_x - m_pose.getOrigin()).length(), 2) << i;
        PenetrationMeter meter(placed(m_mesh, m_pose), meshOf(m_cape));
        EXPECT_EQ(meter.measure(positionsOf(m_cape).data()).m_intersectingPairs, 0u);
    }

private:
    static ClothSpec specOf(int nodes)
    {
        ClothSpec spec;
        spec.m_nodes = nodes;
        spec.m_centre = btVector3(0, btScalar(0.45), 0);
        return spec;
    }

    const btTransform m_pose;
    const TriangleMesh m_mesh;
    MeshShape m_shape;
    Plugin m_plugin;

public:
    DropWorld m_world;
    btRigidBody& m_body;
    btSoftBody& m_cape;
};
}  // namespace

// The app moves the pins along, while the rest of the cape stays behind and is pulled after them.
TEST_P(StretchedCloth, ClothPulledAfterItsPinsComesBack)
{
    constexpr int kPins = 33;
    const btVector3 jump(10, 0, 5);
    Respawn respawn(GetParam().m_settings, kPins, 5, jump);
    for (int i = 0; i < kPins; ++i)
        respawn.m_cape.setMass(i, 0);
    respawn.m_world.step(60);
    std::vector<btVector3> pins;
    for (int i = 0; i < kPins; ++i)
        pins.push_back(respawn.m_cape.m_nodes[i].m_x += jump);
    respawn.jumpAndSettle();
    for (int i = 0; i < kPins; ++i)
        ASSERT_EQ(respawn.m_cape.m_nodes[i].m_x, pins[std::size_t(i)]) << "a pin moved: " << i;
}

// Anchors hold the cape, and the app moves nothing but the body.
TEST_P(StretchedCloth, ClothThatHangsOnARespawnedBodyComesBack)
{
    Respawn respawn(GetParam().m_settings, 25, 4, btVector3(20, 0, 5));
    for (int i = 0; i < 25; i += 4)
        respawn.m_cape.appendAnchor(i, &respawn.m_body);
    respawn.m_world.step(60);
    respawn.jumpAndSettle();
}

INSTANTIATE_TEST_SUITE_P(Backends, StretchedCloth, testing::ValuesIn(allBackends()), backendName);

namespace
{
// A triangle with sides of 3, 4 and 5 m, and a node far away. No link joins the nodes.
struct LooseTriangle
{
    LooseTriangle() : m_body(&m_info, 4, m_places, m_masses)
    {
        m_nodes.resize(4);
        for (std::size_t i = 0; i < 4; ++i)
            recordPath(m_body.m_nodes[int(i)], i, m_nodes);
    }

    const btVector3 m_places[4] = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {1000, 0, 0}};
    const btScalar m_masses[4] = {1, 1, 1, 1};
    btSoftBodyWorldInfo m_info;
    btSoftBody m_body;
    SolverNodes m_nodes;
};
}  // namespace

TEST(Stretch, ABodyWithoutLinksIsMeasuredByTheLongestEdgeOfItsFaces)
{
    // The edges of the second face lead to nodes that the body does not have.
    for (const std::vector<std::int32_t>& corners :
         {std::vector<std::int32_t>{0, 1, 2, 3, -1, 4}, {1, 2, 0, -1, 4, 3}, {2, 0, 1, 4, 3, -1}})
    {
        SCOPED_TRACE(corners[0]);
        LooseTriangle triangle;
        const ClothFaces faces(corners, 4);
        EXPECT_EQ(unitOf(triangle.m_body, faces, triangle.m_nodes), 5);
        for (int i = 0; i < 4; ++i)
            triangle.m_body.m_nodes[i].m_x *= 3;
        const Stretch stretch = stretchOf(triangle.m_body, faces, triangle.m_nodes);
        EXPECT_EQ(stretch.m_start, 1);
        EXPECT_EQ(stretch.m_end, 3);
        for (int bad = 0; bad < 3; ++bad)
        {
            const btScalar before = triangle.m_body.m_nodes[bad].m_x.y();
            triangle.m_body.m_nodes[bad].m_x.setY(std::numeric_limits<btScalar>::quiet_NaN());
            EXPECT_GT(stretchOf(triangle.m_body, faces, triangle.m_nodes).m_end, 1e18f) << bad;
            triangle.m_body.m_nodes[bad].m_x.setY(before);
        }
    }
}

TEST(Stretch, ABodyWithoutLinksAndFacesHasItsOwnSize)
{
    const LooseTriangle triangle;
    const Stretch stretch = stretchOf(triangle.m_body, ClothFaces({}, 4), triangle.m_nodes);
    EXPECT_EQ(stretch.m_start, 1);
    EXPECT_EQ(stretch.m_end, 1);
}
TEST(StretchedCloth, LimitsOfZeroLeaveOutClothThatComesNear)
{
    for (const bool ofContacts : {false, true})
    {
        Settings settings = hostSettings();
        (ofContacts ? settings.m_contactLimit : settings.m_candidateLimit) = 0;
        Plugin plugin(settings);
        MeshShape box(makeBox(2, 0.2f, 2));
        DropWorld world(&plugin);
        world.addObstacle(box.shape());
        ClothSpec spec;
        spec.m_centre = btVector3(0, btScalar(0.4), 0);
        world.addCloth(spec);
        world.step();
        EXPECT_EQ(plugin.statistics().m_status, std::uint32_t(kStepGood)) << ofContacts;
        std::uint32_t status = 0;
        for (int step = 0; step < 40; ++step)
        {
            world.step();
            status |= plugin.statistics().m_status;
            EXPECT_EQ(plugin.statistics().m_contacts, 0u) << ofContacts;
        }
        EXPECT_NE(status & kStepClothsLeftOut, 0u) << ofContacts;
    }
}
}  // namespace drape::test
