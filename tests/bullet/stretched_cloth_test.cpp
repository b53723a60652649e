// Cloth that came apart or whose pins were put elsewhere: its steps stay short, say what they gave up, and the cloth
// comes back. Cloth that keeps its size gets all the tests that it needs, however fast it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bullet_plugin/adapter/stretch.h"
#include "bullet_plugin/core/pipeline/ordinary_work.h"
#include "scenes/random.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
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
    std::vector<std::string> m_lines;  // of the log

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

// Every node goes its own way, downwards.
void blowApart(btSoftBody& cloth, btScalar speed)
{
    Random random(1);
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
    {
        btVector3 way(random.within(-1, 1), random.within(-1, 0), random.within(-1, 1));
        cloth.m_nodes[i].m_v = way.normalized() * speed;
    }
}

// The longest edge of a face as a multiple of the longest link at rest.
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
                                     { return line.find("times its longest link at rest") != std::string::npos; }));
}
}  // namespace

class StretchedCloth : public BackendTest
{
};

// Where every node goes its own way the cloth stays in one piece, and is held like any other.
TEST_P(StretchedCloth, ThatFliesApartIsHeldTogether)
{
    Hills hills(GetParam().m_settings);
    btSoftBody& cloth = hills.addCloth();
    PenetrationMeter meter(hills.m_mesh, meshOf(cloth));
    for (int step = 0; step < 60; ++step)
    {
        if (step % 10 == 0) blowApart(cloth, 200);
        hills.step();
        ASSERT_EQ(hills.statistics().m_status, std::uint32_t(step % 10 == 0 ? kStepMotionHeldBack : kStepGood)) << step;
        // The tests of triangles for this step alone would be sixty million.
        ASSERT_LE(hills.statistics().m_candidates, hills.ordinary(cloth).m_tests + 1);
        ASSERT_LE(hills.statistics().m_sweptTests, hills.ordinary(cloth).m_swept);
        const StepMeasure measure = meter.measure(positionsOf(cloth).data());
        ASSERT_EQ(measure.m_intersectingPairs, 0u) << step;
        ASSERT_EQ(measure.nodesBelow(), 0u) << step;
        ASSERT_LT(stretchNow(cloth), double(kMostStretch)) << step;
    }
    EXPECT_TRUE(hills.m_lines.empty());
}

// Its starts are stretched already: nothing is known of the way there.
TEST_P(StretchedCloth, ThatIsApartIsLeftOutAndSaysSo)
{
    Hills hills(GetParam().m_settings);
    btSoftBody& cloth = hills.addCloth();
    hills.step();  // in which Bullet measures the links at rest
    std::vector<btVector3> places;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        places.push_back(cloth.m_nodes[i].m_x);
    const auto put = [&](int i, const btVector3& place)
    {
        cloth.m_nodes[i].m_x = cloth.m_nodes[i].m_q = place;
        cloth.m_nodes[i].m_v.setZero();
    };
    Random random(1);
    // It is told once, and again when it happens again.
    for (int turn = 1; turn <= 2; ++turn)
    {
        for (int step = 0; step < 3; ++step)
        {
            for (int i = 0; i < cloth.m_nodes.size(); ++i)
                put(i, btVector3(random.within(-2, 2), random.within(-0.1, 0.1), random.within(-2, 2)));
            blowApart(cloth, 20);
            hills.step();
            ASSERT_EQ(hills.statistics().m_status & kStepClothsLeftOut, std::uint32_t(kStepClothsLeftOut));
            ASSERT_EQ(hills.statistics().m_clothsLeftOut, 1u);
            EXPECT_EQ(hills.statistics().m_contacts, 0u);
            EXPECT_LE(hills.statistics().m_candidates, hills.ordinary(cloth).m_tests + 1);
            EXPECT_EQ(hills.statistics().m_sweptTests, 0u);
        }
        EXPECT_EQ(toldLeftOut(hills.m_lines), std::size_t(turn));
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
            put(i, places[std::size_t(i)] - btVector3(0, btScalar(0.3), 0));  // so low that the hills are near
        hills.step();
        EXPECT_EQ(hills.statistics().m_clothsLeftOut, 0u);
    }
}

// Another cloth beside it keeps its contacts, bit for bit.
TEST_P(StretchedCloth, LeavesOthersAsTheyAre)
{
    std::uint64_t hashes[2];
    Random random(1);
    for (const bool beside : {false, true})
    {
        Hills hills(GetParam().m_settings);
        btSoftBody& cloth = hills.addCloth(17, btVector3(btScalar(-1.2), btScalar(0.25), 0));
        btSoftBody* const other = beside ? &hills.addCloth(40, btVector3(1, btScalar(0.5), 0)) : nullptr;
        std::uint64_t hash = kHashStart;
        std::size_t leftOut = 0;
        for (int step = 0; step < 20; ++step)
        {
            for (int i = 0; other && step == 10 && i < other->m_nodes.size(); ++i)
                other->m_nodes[i].m_x = btVector3(random.within(-2, 2), random.within(-1, 1), random.within(-2, 2));
            hills.step();
            leftOut += hills.statistics().m_clothsLeftOut;
            hash = hashOf(cloth, hash);
        }
        EXPECT_EQ(leftOut > 0, beside);
        hashes[beside] = hash;
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

// A whole cloth at 200 m/s needs more tests than ordinary motion, in one step and again in the next.
TEST_P(StretchedCloth, IsNotWhatIsOnlyFast)
{
    Hills hills(GetParam().m_settings, 160);
    btSoftBody& cloth = hills.addCloth(40, btVector3(0, 1, 0));
    bool neededMore = false;
    for (int step = 0; step < 4; ++step)
    {
        const btVector3 velocity(step % 2 ? -160 : 160, -120, 0);
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
            cloth.m_nodes[i].m_v = velocity;
        hills.step();
        EXPECT_EQ(hills.statistics().m_status, std::uint32_t(kStepGood));
        neededMore = neededMore || hills.statistics().m_candidates > hills.ordinary(cloth).m_tests ||
                     hills.statistics().m_sweptTests > hills.ordinary(cloth).m_swept;
    }
    EXPECT_TRUE(neededMore) << "the scene does not test what it is for";
    EXPECT_GT(hills.statistics().m_contacts, 0u);
}

// A character that is put elsewhere with its pins, while the rest of its cape stays behind and is pulled after it.
TEST_P(StretchedCloth, ThatIsPulledAfterItsPinsComesBack)
{
    Plugin plugin(GetParam().m_settings);
    const TriangleMesh mesh = makeSphere(0.4f, 5);
    MeshShape shape(mesh);
    DropWorld world(&plugin);
    btRigidBody& body = world.addKinematic(shape.shape());
    ClothSpec spec;
    spec.m_nodes = 33;
    spec.m_centre = btVector3(0, btScalar(0.45), 0);
    btSoftBody& cape = world.addCloth(spec);
    for (int i = 0; i < spec.m_nodes; ++i)
        cape.setMass(i, 0);
    world.step(60);
    const btVector3 jump(10, 0, 5);
    std::vector<btVector3> pins;
    const btTransform pose(btMatrix3x3::getIdentity(), jump);
    body.setWorldTransform(pose);
    for (int i = 0; i < spec.m_nodes; ++i)
        pins.push_back(cape.m_nodes[i].m_x += jump);
    std::size_t leftOut = 0;
    std::uint64_t most = 0;
    for (int step = 0; step < 300; ++step)
    {
        world.step();
        leftOut += plugin.statistics().m_clothsLeftOut;
        most = std::max(most, plugin.statistics().m_candidates);
    }
    EXPECT_GT(leftOut, 0u) << most;
    EXPECT_LT(most, 1000000u);
    EXPECT_EQ(plugin.statistics().m_status, std::uint32_t(kStepGood));
    for (int i = 0; i < spec.m_nodes; ++i)
        ASSERT_EQ(cape.m_nodes[i].m_x, pins[std::size_t(i)]) << "a pin moved: " << i;
    for (int i = 0; i < cape.m_nodes.size(); ++i)
        ASSERT_LT((cape.m_nodes[i].m_x - jump).length(), 2) << i;
    PenetrationMeter meter(placed(mesh, pose), meshOf(cape));
    EXPECT_EQ(meter.measure(positionsOf(cape).data()).m_intersectingPairs, 0u);
}

INSTANTIATE_TEST_SUITE_P(Backends, StretchedCloth, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
