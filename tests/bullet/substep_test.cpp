// Drape's solver in Bullet worlds: the same bits everywhere, Bullet's meaning of materials and masses, momentum, and
// bodies that Bullet solves for a step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_plugin/adapter/solver/substep_body.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"
#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
Settings withSolver(Solver solver)
{
    Settings settings = hostSettings();
    settings.m_solver = solver;
    return settings;
}

// A cloth dropped on a sphere.
Course dropOnSphere(const Settings& settings, int nodes, int steps)
{
    Plugin plugin(settings);
    const TriangleMesh sphere = makeSphere(0.4f, 3);
    MeshShape shape(sphere);
    DropWorld world(&plugin);
    world.addObstacle(shape.shape());
    ClothSpec spec;
    spec.m_nodes = nodes;
    spec.m_centre = btVector3(0, btScalar(0.5), 0);
    btSoftBody& cloth = world.addCloth(spec);
    EXPECT_EQ(plugin.whyBulletSolves(cloth).empty(), settings.m_solver == Solver::Drape);
    return runMeasured(world, cloth, sphere, steps);
}

// Mean stretch of the links against their rest lengths.
double meanStretch(const btSoftBody& body)
{
    double sum = 0;
    for (int i = 0; i < body.m_links.size(); ++i)
    {
        const btSoftBody::Link& link = body.m_links[i];
        sum += double((link.m_n[0]->m_x - link.m_n[1]->m_x).length() / link.m_rl) - 1;
    }
    return sum / body.m_links.size();
}

// Returns the linear momentum, the angular momentum about the centre of mass, and the sums of the nodes' shares in them
// by length.
std::vector<double> momentumOf(const btSoftBody& cloth)
{
    std::vector<double> sums(8, 0.0);
    btVector3 centre(0, 0, 0);
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        centre += cloth.m_nodes[i].m_x / btScalar(cloth.m_nodes.size());
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = cloth.m_nodes[i];
        const double mass = 1 / double(node.m_im);
        const btVector3 turn = (node.m_x - centre).cross(node.m_v);
        for (int axis = 0; axis < 3; ++axis)
        {
            sums[std::size_t(axis)] += mass * double(node.m_v[axis]);
            sums[std::size_t(3 + axis)] += mass * double(turn[axis]);
        }
        sums[6] += mass * double(node.m_v.length());
        sums[7] += mass * double((node.m_x - centre).length() * node.m_v.length());
    }
    return sums;
}

// A rope that hangs from its first node.
std::unique_ptr<btSoftBody> makeHangingRope(btSoftBodyWorldInfo& info, int links, btScalar stiffness)
{
    std::unique_ptr<btSoftBody> rope(
        btSoftBodyHelpers::CreateRope(info, btVector3(0, 0, 0), btVector3(0, -1, 0), links - 1, 1));
    rope->m_materials[0]->m_kLST = stiffness;
    rope->updateConstants();
    rope->m_cfg.piterations = 4;
    rope->m_cfg.kDP = btScalar(0.05);
    return rope;
}

// Returns the rope's length, m, after it has come to rest.
double hungLength(Solver solver, int links, btScalar stiffness)
{
    Plugin plugin(withSolver(solver));
    DropWorld world(&plugin);
    const std::unique_ptr<btSoftBody> rope = makeHangingRope(world.world().getWorldInfo(), links, stiffness);
    world.world().addSoftBody(rope.get());
    world.step(600);
    world.world().removeSoftBody(rope.get());
    return -double(rope->m_nodes[rope->m_nodes.size() - 1].m_x.y());
}
}  // namespace

TEST(Substeps, GiveTheSameBitsOnAnyNumberOfThreads)
{
    Course first;
    for (const unsigned threads : {1u, 2u, 7u})
    {
        Settings settings = withSolver(Solver::Drape);
        settings.m_threads = threads;
        const Course course = dropOnSphere(settings, 41, 50);
        expectClean(course);
        if (threads == 1) first = course;
        EXPECT_EQ(course.m_hash, first.m_hash) << threads << " threads";
    }
}

class SubstepsOn : public BackendTest
{
};

TEST_P(SubstepsOn, GiveTheSameBitsOnEveryBackend)
{
    Settings settings = GetParam().m_settings;
    settings.m_solver = Solver::Drape;
    const Course course = dropOnSphere(settings, 25, 60), host = dropOnSphere(withSolver(Solver::Drape), 25, 60);
    expectClean(course);
    EXPECT_EQ(course.m_hash, host.m_hash);
}

INSTANTIATE_TEST_SUITE_P(Backends, SubstepsOn, testing::ValuesIn(allBackends()), backendName);

TEST(Substeps, ClothOnASphereStretchesSeveralTimesLess)
{
    const auto stretchWith = [](Solver solver)
    {
        Plugin plugin(withSolver(solver));
        MeshShape shape(makeSphere(0.4f, 3));
        DropWorld world(&plugin);
        world.addObstacle(shape.shape());
        ClothSpec spec;
        spec.m_nodes = 33;
        spec.m_centre = btVector3(0, btScalar(0.5), 0);
        btSoftBody& cloth = world.addCloth(spec);
        world.step(200);
        return meanStretch(cloth);
    };
    const double drape = stretchWith(Solver::Drape), bullet = stretchWith(Solver::Bullet);
    EXPECT_LT(drape, 0.4 * bullet);
    EXPECT_GT(drape, -0.01) << "links are not pressed together";
}

// One link has Bullet's equilibrium whatever its stiffness; a rope of stiff links is nearer to its rest length.
TEST(Substeps, SoftLinksKeepTheirStiffness)
{
    for (const btScalar stiffness : {btScalar(0.003), btScalar(0.02), btScalar(0.2)})
    {
        const double bullet = hungLength(Solver::Bullet, 1, stiffness), drape = hungLength(Solver::Drape, 1, stiffness);
        EXPECT_GT(bullet, 1.001);
        EXPECT_NEAR(drape - 1, bullet - 1, 0.03 * (bullet - 1)) << "kLST " << stiffness;
    }
    const double bullet = hungLength(Solver::Bullet, 20, 1), drape = hungLength(Solver::Drape, 20, 1);
    EXPECT_GT(bullet, 1.001);
    EXPECT_LT(drape - 1, 0.5 * (bullet - 1));
    EXPECT_GT(drape, 0.999);
}

// A cloth that flies and turns in vacuum. piterations: 0 for Bullet's default of one.
TEST(Substeps, FreeClothKeepsItsMomentum)
{
    for (const int iterations : {0, 4, 32})
    {
        SCOPED_TRACE(std::to_string(iterations) + " iterations");
        Plugin plugin(withSolver(iterations > 0 ? Solver::Drape : Solver::Auto));
        DropWorld world(&plugin);
        world.world().getWorldInfo().m_gravity.setZero();
        ClothSpec spec;
        spec.m_damping = 0;
        btSoftBody& cloth = world.addCloth(spec);
        cloth.m_cfg.piterations = std::max(1, iterations);
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
            cloth.m_nodes[i].m_v =
                btVector3(btScalar(0.3), btScalar(0.01) * btScalar(i % 17), btScalar(0.02) * btScalar(i / 17));
        const std::vector<double> before = momentumOf(cloth);
        world.step(1000);
        const std::vector<double> after = momentumOf(cloth);
        for (std::size_t i = 0; i < 3; ++i)
        {
            EXPECT_NEAR(after[i], before[i], 1e-5 * before[6]) << "linear " << i;
            EXPECT_NEAR(after[3 + i], before[3 + i], 1e-5 * before[7]) << "angular " << i;
        }
    }
}

TEST(Substeps, FreeFallIsAParabola)
{
    Plugin plugin(withSolver(Solver::Drape));
    DropWorld world(&plugin);
    ClothSpec spec;
    spec.m_damping = 0;
    btSoftBody& cloth = world.addCloth(spec);
    const double gravity = double(world.world().getWorldInfo().m_gravity.y());
    world.step(60);
    // Substeps of 1/60 s / n end half a substep's velocity below the parabola.
    EXPECT_NEAR(double(cloth.m_nodes[0].m_x.y()), 0.5 * gravity, 0.02 * std::fabs(gravity));
    EXPECT_NEAR(double(cloth.m_nodes[0].m_v.y()), gravity, 1e-3 * std::fabs(gravity));
}

TEST(Substeps, PinnedAndMovedNodesStayWhereTheAppPutsThem)
{
    Plugin plugin(withSolver(Solver::Drape));
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(ClothSpec());
    cloth.setMass(0, 0);
    cloth.setMass(16, 0);
    const btVector3 held = cloth.m_nodes[0].m_x;
    for (int step = 0; step < 120; ++step)
    {
        cloth.m_nodes[16].m_x += btVector3(0, 0, btScalar(0.002));
        world.step();
    }
    EXPECT_EQ(cloth.m_nodes[0].m_x, held);
    EXPECT_NEAR(double(cloth.m_nodes[16].m_x.z() - held.z()), 0.24, 1e-5);
    EXPECT_LT(double(lowestOf(cloth)), -0.3);
    EXPECT_LT(meanStretch(cloth), 0.05);
}

TEST(Substeps, ChangesBetweenStepsCount)
{
    Plugin plugin(withSolver(Solver::Drape));
    DropWorld world(&plugin);
    btSoftBodyWorldInfo& info = world.world().getWorldInfo();
    const std::unique_ptr<btSoftBody> rope = makeHangingRope(info, 8, 1);
    world.world().addSoftBody(rope.get());
    world.step(60);
    btSoftBody::Node& last = rope->m_nodes[8];
    EXPECT_NEAR(double(last.m_x.y()), -1, 0.02);
    rope->m_links[7].m_rl *= 2;
    rope->m_links[7].m_c1 *= 4;
    world.step(200);
    EXPECT_NEAR(double(last.m_x.y()), -1.125, 0.02) << "a longer link";
    rope->m_materials[0]->m_kLST = btScalar(0.001);
    rope->updateLinkConstants();
    world.step(60);
    EXPECT_LT(double(last.m_x.y()), -1.2) << "a softer material";
    rope->m_links.removeAtIndex(7);
    const double before = double(rope->m_nodes[8].m_x.y());
    world.step(30);
    EXPECT_LT(double(rope->m_nodes[8].m_x.y()), before - 0.5) << "a link less";
    world.world().removeSoftBody(rope.get());
}

TEST(Substeps, WhyBulletSolvesNamesTheReason)
{
    Plugin plugin(withSolver(Solver::Drape)), stock(withSolver(Solver::Bullet)), automatic(withSolver(Solver::Auto));
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(ClothSpec());
    world.step();
    const auto reason = [&] { return plugin.whyBulletSolves(cloth); };
    EXPECT_EQ(reason(), "");
    EXPECT_NE(stock.whyBulletSolves(cloth).find("m_solver"), std::string::npos);
    EXPECT_EQ(automatic.whyBulletSolves(cloth).find("m_solver"), std::string::npos);
    cloth.m_cfg.viterations = 1;
    EXPECT_NE(reason().find("viterations"), std::string::npos);
    cloth.m_cfg.viterations = 0;
    cloth.m_cfg.diterations = 1;
    EXPECT_NE(reason().find("diterations"), std::string::npos);
    cloth.m_cfg.diterations = 0;
    cloth.m_cfg.piterations = 0;
    EXPECT_NE(reason().find("piterations"), std::string::npos);
    cloth.m_cfg.piterations = 4;
    cloth.setPose(false, true);
    cloth.m_cfg.kMT = btScalar(0.1);
    EXPECT_NE(reason().find("pose"), std::string::npos);
    cloth.m_cfg.kMT = 0;
    btBoxShape box(btVector3(1, 1, 1));
    btRigidBody body(btScalar(1), nullptr, &box);
    cloth.appendAnchor(0, &body);
    EXPECT_EQ(reason(), "");
    cloth.m_anchors.clear();
    btSoftBody& other = world.addCloth(ClothSpec());
    cloth.m_links[0].m_n[1] = &other.m_nodes[0];
    EXPECT_NE(reason().find("another"), std::string::npos);
    cloth.m_links[0].m_n[1] = &cloth.m_nodes[1];
    EXPECT_EQ(reason(), "");
}

// The app asks for drift iterations between the prediction, with Drape's path of a free node, and the solve. A corner
// is held, so that links pull.
TEST(Substeps, ABodyThatChangesAfterItsPredictionIsBulletsForTheStep)
{
    const auto change = [](btDynamicsWorld* world, btScalar)
    { static_cast<btSoftBody*>(world->getWorldUserInfo())->m_cfg.diterations = 1; };
    std::vector<float> places[2];
    for (const Solver solver : {Solver::Bullet, Solver::Drape})
    {
        Plugin plugin(withSolver(solver));
        DropWorld world(&plugin);
        btSoftBody& cloth = world.addCloth(ClothSpec());
        cloth.setMass(0, 0);
        world.world().setInternalTickCallback(change, &cloth);
        EXPECT_EQ(plugin.whyBulletSolves(cloth).empty(), solver == Solver::Drape);
        world.step();
        EXPECT_FALSE(plugin.whyBulletSolves(cloth).empty());
        places[solver == Solver::Drape] = positionsOf(cloth);
    }
    // The paths of free nodes differ by 1 mm, 3/8 of the acceleration times the square of the step's time.
    for (std::size_t i = 0; i < places[0].size(); ++i)
        EXPECT_NEAR(places[0][i], places[1][i], 1e-6f) << i;
}

TEST(Substeps, AStepLeftToBulletCountsAsItsOwn)
{
    DropWorld world(nullptr);
    btSoftBody& cloth = world.addCloth(ClothSpec());
    SubstepBody substeps;
    const auto predict = [&]
    {
        substeps.reserve(cloth);
        substeps.beforePrediction(cloth, nullptr);
        cloth.predictMotion(kDt);
        substeps.afterPrediction(cloth, nullptr);
        EXPECT_TRUE(substeps.isPredicted());
    };
    const auto correctionTime = [&]
    {
        predict();
        EXPECT_TRUE(substeps.canSolveNow(cloth, nullptr));
        substeps.begin(cloth, nullptr, nullptr, nullptr);
        return substeps.substeps().correctionTime();
    };
    EXPECT_LT(correctionTime(), float(kDt));
    predict();
    substeps.leave(cloth);
    EXPECT_FALSE(substeps.isPredicted());
    EXPECT_GE(correctionTime(), float(kDt)) << "errors that Bullet left are corrected slowly";
}

// Velocity iterations leave the steps to Bullet while they are on. Its links let the cloth sag, at up to 0.2 m/s.
// Drape's contract it within some ten steps, at 0.09 m/s.
TEST(Substeps, AClothAtRestChangesOverWithoutAJump)
{
    Plugin plugin(withSolver(Solver::Drape));
    MeshShape shape(makeSphere(0.4f, 3));
    DropWorld world(&plugin);
    world.addObstacle(shape.shape());
    ClothSpec spec;
    spec.m_nodes = 25;
    spec.m_centre = btVector3(0, btScalar(0.45), 0);
    btSoftBody& cloth = world.addCloth(spec);
    cloth.m_cfg.piterations = 5;
    world.step(300);
    for (const int iterations : {1, 0, 1, 0})
    {
        cloth.m_cfg.viterations = iterations;
        EXPECT_EQ(plugin.whyBulletSolves(cloth).empty(), iterations == 0);
        for (int step = 0; step < 60; ++step)
        {
            world.step();
            EXPECT_LT(rmsSpeed(cloth), iterations == 0 ? 0.12 : 0.25) << "step " << step << " with " << iterations;
        }
    }
}

TEST(Substeps, AClothOnABoxRestsWhereBulletsDoes)
{
    const auto restOn = [](Solver solver)
    {
        Plugin plugin(withSolver(solver));
        btBoxShape box(btVector3(2, btScalar(0.5), 2));
        DropWorld world(&plugin);
        world.addObstacle(box);
        ClothSpec spec;
        spec.m_centre = btVector3(0, 1, 0);
        btSoftBody& cloth = world.addCloth(spec);
        double fastest = 0;
        for (int step = 0; step < 240; ++step)
        {
            world.step();
            fastest = std::max(fastest, rmsSpeed(cloth));
        }
        EXPECT_LT(fastest, 4) << "no node is thrown";
        EXPECT_LT(rmsSpeed(cloth), 0.02);
        return double(lowestOf(cloth));
    };
    EXPECT_NEAR(restOn(Solver::Drape), restOn(Solver::Bullet), 0.005);
}

TEST(Substeps, ManySmallClothsGiveTheSameBitsAsOneAtATime)
{
    const auto hashWith = [](unsigned threads)
    {
        Settings settings = withSolver(Solver::Drape);
        settings.m_threads = threads;
        Plugin plugin(settings);
        MeshShape shape(makeSphere(0.4f, 3));
        DropWorld world(&plugin);
        world.addObstacle(shape.shape());
        std::vector<btSoftBody*> cloths;
        for (int i = 0; i < 20; ++i)
        {
            ClothSpec spec;
            spec.m_nodes = 13;
            spec.m_centre =
                btVector3(btScalar(0.3) * btScalar(i % 5) - btScalar(0.6), btScalar(0.5 + 0.1 * (i / 5)), 0);
            cloths.push_back(&world.addCloth(spec));
        }
        world.step(40);
        std::uint64_t hash = kHashStart;
        for (const btSoftBody* cloth : cloths)
            hash = hashOf(*cloth, hash);
        return hash;
    };
    EXPECT_EQ(hashWith(1), hashWith(3));
}
// Links do not hand on what is not finite.
TEST(Substeps, ANodeThatIsNoNumberDoesNotSpread)
{
    enum class Harm
    {
        Velocity,
        Position,
        LinkLength
    };
    for (const SolverPlace place : {SolverPlace::Host, SolverPlace::Device})
    {
        for (const Harm harm : {Harm::Velocity, Harm::Position, Harm::LinkLength})
        {
            Plugin plugin(settingsFor(place));
            MeshShape box(makeBox(2, 0.2f, 2));
            DropWorld world(&plugin);
            world.addObstacle(box.shape());
            ClothSpec spec;
            spec.m_centre = btVector3(0, btScalar(0.2), 0);
            btSoftBody& cloth = world.addCloth(spec);
            world.step(30);
            const btScalar nothing = std::numeric_limits<btScalar>::quiet_NaN();
            if (harm == Harm::Velocity) cloth.m_nodes[7].m_v.setX(nothing);
            if (harm == Harm::Position) cloth.m_nodes[7].m_x.setX(nothing);
            if (harm == Harm::LinkLength) cloth.m_links[3].m_c1 = std::numeric_limits<btScalar>::infinity();
            world.step(6);
            int lost = 0;
            for (int i = 0; i < cloth.m_nodes.size(); ++i)
                lost += !std::isfinite(cloth.m_nodes[i].m_x.length2());
            const int expected = harm == Harm::LinkLength ? 0 : 1;
            EXPECT_EQ(lost, expected) << int(place) << " " << int(harm);
            const bool isTold = (plugin.statistics().m_status & kStepInvalidNodes) != 0;
            EXPECT_EQ(isTold, lost > 0) << int(place) << " " << int(harm);
        }
    }
}
// Beside a wall it would come to rest in the air, since damping takes all of its speed in every substep.
TEST(Substeps, DampedClothBesideAWallFallsAsAlone)
{
    std::vector<btScalar> heights;
    for (const bool hasWall : {false, true})
    {
        Plugin plugin(hostSettings());
        MeshShape wall(makeBox(1, 8, 8));
        DropWorld world(&plugin);
        const btTransform pose(btQuaternion::getIdentity(), btVector3(btScalar(1.021), 0, 0));
        if (hasWall) world.addObstacle(wall.shape(), pose);
        btSoftBody& cloth = world.addCloth(ClothSpec());
        cloth.m_cfg.kDP = 1;
        cloth.m_cfg.piterations = 70;
        world.step(30);
        heights.push_back(lowestOf(cloth));
        EXPECT_EQ(plugin.statistics().m_contacts > 0, hasWall);
    }
    EXPECT_LT(heights[0], btScalar(-0.0008));
    EXPECT_NEAR(heights[1], heights[0], 1e-5f);
}

namespace
{
// Swings a cloth that hangs from its upper edge, 1 mm aside at first, beside a wall 27 mm away or without one. Returns
// the least and the most x (m) of its lower edge.
std::pair<btScalar, btScalar> swing(SolverPlace place, bool hasWall)
{
    Plugin plugin(settingsFor(place));
    MeshShape wall(makeBox(1, 8, 8));
    DropWorld world(&plugin);
    const btTransform pose(btQuaternion::getIdentity(), btVector3(btScalar(0.527), 0, 0));
    if (hasWall) world.addObstacle(wall.shape(), pose);
    ClothSpec spec;
    spec.m_nodes = 9;
    spec.m_damping = 0;
    btSoftBody& cloth = world.addCloth(spec);
    cloth.m_cfg.piterations = 8;
    cloth.rotate(btQuaternion(btVector3(0, 0, 1), SIMD_HALF_PI + btScalar(0.001)));
    std::vector<int> lower;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
    {
        if (cloth.m_nodes[i].m_x.y() > btScalar(0.49)) cloth.setMass(i, 0);
        if (cloth.m_nodes[i].m_x.y() < btScalar(-0.49)) lower.push_back(i);
    }
    std::pair<btScalar, btScalar> range(1, -1);
    for (int step = 0; step < 120; ++step)
    {
        world.step();
        EXPECT_EQ(plugin.statistics().m_contacts > 0, hasWall);
        EXPECT_EQ(plugin.statistics().m_clothsSolvedOnDevice > 0, place == SolverPlace::Device);
        for (const int node : lower)
        {
            range.first = std::min(range.first, cloth.m_nodes[node].m_x.x());
            range.second = std::max(range.second, cloth.m_nodes[node].m_x.x());
        }
    }
    return range;
}
}  // namespace

// The wall is in detection's reach, and nothing touches it. Gravity hardly accelerates cloth that hangs almost
// straight, so that it would come to rest where it is.
TEST(Substeps, ClothSwingsBesideAWallAsAlone)
{
    std::vector<SolverPlace> places = {SolverPlace::Host};
    if (isDeviceExpected()) places.push_back(SolverPlace::Device);
    for (const SolverPlace place : places)
    {
        const auto alone = swing(place, false), beside = swing(place, true);
        EXPECT_GT(alone.second - alone.first, btScalar(0.0015));
        EXPECT_NEAR(beside.first, alone.first, 2e-5f) << int(place);
        EXPECT_NEAR(beside.second, alone.second, 2e-5f) << int(place);
    }
}
}  // namespace drape::test
