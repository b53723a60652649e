// Cloth that collides with itself and with other cloth (Plugin::setSelfCollision()), by the exact check.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/core/backends/device_cloth_search.h"
#include "scenes/shapes.h"
#include "tests/bullet/layers.h"
#include "tests/support/backends.h"
#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
Settings withThreads(unsigned threads)
{
    Settings settings = hostSettings();
    settings.m_threads = threads;
    return settings;
}

// Returns the highest mean speed, m/s, of a node of `count` sheets in a stack on a box, over `steps` steps.
double creepOfStack(int count, int steps)
{
    MeshShape box(makeBox(4, 1, 4));
    Layers layers(hostSettings(), count, 0.022f);
    layers.m_world.addObstacle(box.shape());
    layers.m_world.step(180);
    const std::vector<float> before = layers.positions();
    layers.m_world.step(steps);
    const std::vector<float> after = layers.positions();
    EXPECT_TRUE(SelfIntersections(layers.joined()).find(after).empty());
    double most = 0;
    for (std::size_t i = 0; i < before.size(); i += 3)
        most = std::max(most,
                        std::hypot(double(after[i]) - double(before[i]), double(after[i + 1]) - double(before[i + 1]),
                                   double(after[i + 2]) - double(before[i + 2])));
    return most / (steps * double(kDt));
}
}  // namespace

TEST(SelfCollision, LayersOnASphereNeverMeetWithAnyNumberOfThreads)
{
    std::vector<std::vector<float>> ends;
    for (const unsigned threads : {1u, 2u, 7u})
    {
        MeshShape sphere(makeSphere(0.5f, 3));
        Layers layers(withThreads(threads), 3, 0.03f);
        layers.m_world.addObstacle(sphere.shape());
        EXPECT_EQ(layers.run(threads == 1 ? 150 : 60), 0u);
        EXPECT_EQ(layers.m_status, std::uint32_t(kStepGood)) << statusText(layers.m_status);
        EXPECT_GT(layers.m_plugin.statistics().m_selfContacts, 0u);
        if (threads == 1) continue;
        ends.push_back(layers.positions());
        EXPECT_EQ(ends.front(), ends.back());
    }
}

TEST(SelfCollision, ADeviceThatSearchesChangesNothing)
{
    if (!isDeviceExpected()) GTEST_SKIP() << "no OpenCL device, as DRAPE_TEST_NO_DEVICE says";
    std::vector<std::vector<float>> ends;
    for (const SolverPlace place : {SolverPlace::Host, SolverPlace::Device})
    {
        MeshShape sphere(makeSphere(0.5f, 3));
        Layers layers(settingsFor(place), 3, 0.03f);
        layers.m_world.addObstacle(sphere.shape());
        EXPECT_EQ(layers.m_plugin.state()->pipeline().searchDevice().m_device != nullptr, place == SolverPlace::Device);
        EXPECT_EQ(layers.run(60), 0u);
        EXPECT_GT(layers.m_plugin.statistics().m_selfContacts, 0u);
        ends.push_back(layers.positions());
    }
    EXPECT_EQ(ends.front(), ends.back());
}

TEST(SelfCollision, LayersWhoseLinksBulletSolvesNeverMeet)
{
    Settings settings = hostSettings();
    settings.m_solver = Solver::Bullet;
    MeshShape sphere(makeSphere(0.5f, 3));
    Layers layers(settings, 2, 0.03f);
    layers.m_world.addObstacle(sphere.shape());
    EXPECT_EQ(layers.run(60), 0u);
    EXPECT_EQ(layers.m_status & kStepClothsMeet, 0u);
}

TEST(SelfCollision, LayersMeetWithoutIt)
{
    MeshShape sphere(makeSphere(0.5f, 3));
    Layers layers(hostSettings(), 3, 0.03f, false);
    layers.m_world.addObstacle(sphere.shape());
    EXPECT_GT(layers.run(60), 0u);
}

TEST(SelfCollision, TheHighestLayerRestsAThicknessAboveEachLowerOne)
{
    MeshShape box(makeBox(4, 1, 4));
    Layers layers(hostSettings(), 3, 0.03f);
    layers.m_world.addObstacle(box.shape());
    EXPECT_EQ(layers.run(200), 0u);
    const double top = 0.5 + kThickness;
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(double(lowestOf(*layers.m_cloths[std::size_t(k)])), top + k * double(kThickness), 0.002) << k;
    for (const btSoftBody* cloth : layers.m_cloths)
        EXPECT_LT(rmsSpeed(*cloth), 0.01);
}

// With four sweeps over rows and no repeated pushes it creeps by 0.11 mm/s.
TEST(SelfCollision, AStackOfFiveSheetsStays)
{
    EXPECT_LT(creepOfStack(5, 60), 7e-5);
}

// Takes 20 s.
TEST(SelfCollision, AStackOfTenSheetsStays)
{
    EXPECT_LT(creepOfStack(10, 300), 1e-4);
}

// The rows' substeps are those of their own cloths.
TEST(SelfCollision, ALoneSheetWithFewSubstepsChangesNothing)
{
    std::vector<std::vector<float>> ends;
    for (const bool hasOther : {false, true})
    {
        MeshShape box(makeBox(4, 1, 4));
        Plugin plugin(hostSettings());
        DropWorld world(&plugin);
        world.addObstacle(box.shape());
        ClothSpec spec;
        spec.m_nodes = 13;
        btSoftBody* other = nullptr;
        if (hasOther)
        {
            spec.m_centre = btVector3(btScalar(1.3), btScalar(0.53), btScalar(1.3));
            other = &world.addCloth(spec);
            other->m_cfg.piterations = 1;
        }
        std::vector<float> positions;
        std::vector<const btSoftBody*> layers;
        for (int k = 0; k < 2; ++k)
        {
            spec.m_centre = btVector3(btScalar(-1.3), btScalar(0.53 + 0.022 * k), btScalar(-1.3));
            layers.push_back(&world.addCloth(spec));
            plugin.setSelfCollision(*layers.back(), true);
        }
        world.step(60);
        for (const btSoftBody* layer : layers)
        {
            const std::vector<float> own = positionsOf(*layer);
            positions.insert(positions.end(), own.begin(), own.end());
        }
        ends.push_back(positions);
    }
    EXPECT_EQ(ends[0], ends[1]);
}

// Switched on again after its nodes have moved together, a cloth takes these places for its rest.
TEST(SelfCollision, SwitchedOnAgainItTakesTheNewRest)
{
    std::vector<std::vector<float>> ends;
    for (const bool before : {false, true})
    {
        Plugin plugin(hostSettings());
        DropWorld world(&plugin);
        ClothSpec spec;
        spec.m_nodes = 13;
        btSoftBody& cloth = world.addCloth(spec);
        world.world().setGravity(btVector3(0, 0, 0));
        world.world().getWorldInfo().m_gravity.setZero();
        if (before)
        {
            plugin.setSelfCollision(cloth, true);
            world.step(2);
            plugin.setSelfCollision(cloth, false);
        }
        else
            world.step(2);
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
        {
            btSoftBody::Node& node = cloth.m_nodes[i];
            node.m_x = node.m_q = node.m_x * btScalar(0.2);
        }
        cloth.updateLinkConstants();
        for (int i = 0; i < cloth.m_links.size(); ++i)
        {
            btSoftBody::Link& link = cloth.m_links[i];
            link.m_rl *= btScalar(0.2);
            link.m_c1 = link.m_rl * link.m_rl;
        }
        plugin.setSelfCollision(cloth, true);
        world.step(5);
        ends.push_back(positionsOf(cloth));
    }
    EXPECT_EQ(ends[0], ends[1]);
}

TEST(SelfCollision, SheetsSideBySideFallFreely)
{
    Layers layers(hostSettings(), 2, 0.001f, false);
    for (const btSoftBody* cloth : layers.m_cloths)
        layers.m_plugin.setSelfCollision(*cloth, true, 0.0005);
    const std::vector<float> before = layers.positions();
    EXPECT_EQ(layers.run(30), 0u);
    double fallen = 0, expected = 0;
    for (std::size_t i = 1; i < before.size(); i += 3)
        fallen += double(before[i] - layers.positions()[i]) / double(before.size() / 3);
    for (int i = 1; i <= 30; ++i)
        expected += 9.81 * i / 3600.0;  // Bullet integrates so
    EXPECT_NEAR(fallen, expected, 0.03 * expected);
    Layers alone(hostSettings(), 2, 0.001f, false);
    alone.run(30);
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_NEAR(layers.positions()[i], alone.positions()[i], 1e-6f);
}

TEST(SelfCollision, SheetsThatMeetKeepTheirMomentum)
{
    Layers layers(hostSettings(), 2, 0.1f);
    layers.turnGravityOff();
    layers.m_cloths[0]->setVelocity(btVector3(0.2f, 3, 0));
    layers.m_cloths[1]->setVelocity(btVector3(0, -2, 0.1f));
    const btVector3 before = layers.momentum();
    EXPECT_EQ(layers.run(60), 0u);
    EXPECT_LT((layers.momentum() - before).length(), 1e-4f * before.length());
    EXPECT_LT(layers.m_cloths[0]->m_nodes[84].m_v.y(), 1.5f);  // it was stopped
}

TEST(SelfCollision, BulletsFiltersKeepBodiesFromMeeting)
{
    MeshShape box(makeBox(4, 1, 4));
    Layers layers(hostSettings(), 2, 0.03f, true, btBroadphaseProxy::StaticFilter);
    layers.m_world.addObstacle(box.shape());
    layers.run(60);
    EXPECT_NEAR(lowestOf(*layers.m_cloths[0]), lowestOf(*layers.m_cloths[1]), 0.001f);
    EXPECT_EQ(layers.m_status, std::uint32_t(kStepGood)) << statusText(layers.m_status);
}

// The lower sheet is pinned. Gravity leans, which is equivalent to a slope.
TEST(SelfCollision, ASheetSlidesOverAnotherAtTheSpeedThatFrictionLeaves)
{
    constexpr double kGravity = 9.81, kAngle = 0.3;
    for (const double friction : {0.0, 0.1, 0.2, 0.5})
    {
        Layers layers(hostSettings(), 2, 0.02f);
        for (btSoftBody* cloth : layers.m_cloths)
            cloth->m_cfg.kDF = btScalar(friction);
        for (int i = 0; i < layers.m_cloths[0]->m_nodes.size(); ++i)
            layers.m_cloths[0]->setMass(i, 0);
        const btVector3 gravity(btScalar(kGravity * std::sin(kAngle)), btScalar(-kGravity * std::cos(kAngle)), 0);
        layers.m_world.world().setGravity(gravity);
        layers.m_world.world().getWorldInfo().m_gravity = gravity;
        const std::vector<float> before = positionsOf(*layers.m_cloths[1]);
        constexpr int kSteps = 20;
        layers.m_world.step(kSteps);
        const std::vector<float> after = positionsOf(*layers.m_cloths[1]);
        double way = 0;
        for (std::size_t i = 0; i < before.size(); i += 3)
            way += 3 * (double(after[i]) - double(before[i])) / double(before.size());
        const double time = kSteps * double(kDt);
        const double right =
            0.5 * kGravity * std::max(0.0, std::sin(kAngle) - friction * std::cos(kAngle)) * time * time;
        EXPECT_NEAR(way, right, 0.02 * right + 1e-4) << friction;
    }
}

// The app moves a pinned sheet through the place of a free one, by less than the thickness a step and by more.
TEST(SelfCollision, APinnedSheetThatTheAppMovesCarriesAnotherAlong)
{
    for (const float share : {0.5f, 1.5f})
    {
        Layers layers(hostSettings(), 2, 0.03f);
        layers.turnGravityOff();
        btSoftBody &pinned = *layers.m_cloths[0], &free = *layers.m_cloths[1];
        for (int i = 0; i < pinned.m_nodes.size(); ++i)
            pinned.setMass(i, 0);
        SelfIntersections check(layers.joined());
        layers.m_world.step();  // before the first step nobody knows where the sheet comes from
        for (int step = 0; step < 20; ++step)
        {
            for (int i = 0; i < pinned.m_nodes.size(); ++i)
                pinned.m_nodes[i].m_x += btVector3(0, btScalar(2 * share * kMargin), 0);
            layers.m_world.step();
            EXPECT_EQ(layers.m_plugin.statistics().m_clothPairsMeeting, 0u) << share << " " << step;
            ASSERT_TRUE(check.find(layers.positions()).empty()) << share << " " << step;
        }
        EXPECT_GT(lowestOf(free), pinned.m_nodes[0].m_x.y()) << share;
    }
}

// A pinned sheet presses another one against a box. Cloth elsewhere falls on, and the pairs are flagged.
TEST(SelfCollision, APinnedSheetThatLeavesNoRoomIsFlaggedAndStopsNobodyElse)
{
    MeshShape box(makeBox(4, 1, 4));
    Layers layers(hostSettings(), 2, 0.03f);
    layers.m_world.addObstacle(box.shape());
    ClothSpec spec;
    spec.m_nodes = 5;
    spec.m_centre = btVector3(30, 50, 0);
    btSoftBody& falling = layers.m_world.addCloth(spec);
    layers.m_plugin.setSelfCollision(falling, true);
    btSoftBody& pinned = *layers.m_cloths[1];
    for (int i = 0; i < pinned.m_nodes.size(); ++i)
        pinned.setMass(i, 0);
    layers.m_world.step();
    bool flagged = false;
    double height = lowestOf(falling);
    for (int step = 0; step < 90; ++step)
    {
        for (int i = 0; i < pinned.m_nodes.size(); ++i)
            pinned.m_nodes[i].m_x -= btVector3(0, btScalar(0.002), 0);
        layers.m_world.step();
        flagged = flagged ||
                  (layers.m_plugin.statistics().m_clothPairsMeeting > 0 && !layers.m_plugin.flaggedPairs().empty());
        ASSERT_LT(lowestOf(falling), height) << step;
        height = lowestOf(falling);
    }
    EXPECT_LT(pinned.m_nodes[0].m_x.y(), 0.5);
    EXPECT_TRUE(flagged);
}

// Rows that recover the whole depth in one step make cloth in many folds fly apart.
TEST(SelfCollision, SheetsThatStartTooCloseRecoverSlowly)
{
    const double thickness = 2 * double(kMargin);
    Layers layers(hostSettings(), 2, btScalar(0.5 * thickness));
    layers.turnGravityOff();
    const auto distance = [&]
    {
        const std::vector<float> low = positionsOf(*layers.m_cloths[0]), high = positionsOf(*layers.m_cloths[1]);
        double sum = 0;
        for (std::size_t i = 1; i < low.size(); i += 3)
            sum += 3 * (double(high[i]) - double(low[i])) / double(low.size());
        return sum;
    };
    const double start = distance();
    layers.m_world.step();
    EXPECT_NEAR(distance(), start + 0.1 * thickness, 0.03 * thickness);
    layers.m_world.step(20);
    EXPECT_NEAR(distance(), thickness, 0.1 * thickness);
    // A tenth of the speed of the recovery.
    for (const btSoftBody* cloth : layers.m_cloths)
        EXPECT_LT(rmsSpeed(*cloth), 0.01 * thickness / double(kDt));
}

namespace
{
// Two sheets of which one leans through the other. Returns the steps after which nothing intersects, or the number of
// all; `fastest` gets the greatest speed (m/s) of the leaning sheet as a whole.
int stepsUntilApart(double shift, int steps, double& fastest)
{
    Layers layers(hostSettings(), 2, 0);
    layers.turnGravityOff();
    btSoftBody& second = *layers.m_cloths[1];
    for (int i = 0; i < second.m_nodes.size(); ++i)
    {
        btSoftBody::Node& node = second.m_nodes[i];
        node.m_x += btVector3(btScalar(shift), btScalar(0.4) * node.m_x.x(), btScalar(0.013));
        node.m_q = node.m_x;
    }
    SelfIntersections check(layers.joined());
    fastest = 0;
    std::size_t before = check.find(layers.positions()).size();
    for (int step = 0; step < steps; ++step)
    {
        layers.m_world.step();
        fastest = std::max(fastest, rmsSpeed(second));
        EXPECT_EQ(layers.m_plugin.clothPairs().size(), layers.m_plugin.statistics().m_clothPairsMeeting) << step;
        if (layers.m_plugin.clothPairs().empty()) return step;
        if (step % 20 != 0) continue;
        const std::size_t pairs = check.find(layers.positions()).size();
        EXPECT_LE(pairs, before) << step;
        before = pairs;
    }
    return steps;
}
}  // namespace

TEST(SelfCollision, ClothThatStartsThroughOtherClothIsPushedApart)
{
    double fastest = 0;
    EXPECT_LT(stepsUntilApart(0.3, 400, fastest), 400);
    EXPECT_LT(fastest, 1.0);
}

TEST(SelfCollision, SwitchedOffItCostsNothing)
{
    Layers layers(hostSettings(), 2, 0.01f);
    layers.m_world.step();
    EXPECT_GT(layers.m_plugin.statistics().m_selfContacts, 0u);
    for (const btSoftBody* cloth : layers.m_cloths)
        layers.m_plugin.setSelfCollision(*cloth, false);
    layers.m_world.step();
    EXPECT_EQ(layers.m_plugin.statistics().m_selfContacts, 0u);
}
// Bullet's flags ask for the same.
TEST(SelfCollision, FlagsOfBulletKeepClothsApart)
{
    Layers layers(hostSettings(), 3, 0.05f, false);
    for (btSoftBody* cloth : layers.m_cloths)
        cloth->m_cfg.collisions |= btSoftBody::fCollision::VF_SS | btSoftBody::fCollision::CL_SELF;
    MeshShape shape(makeSphere(0.4f, 3));
    layers.m_world.addObstacle(shape.shape());
    EXPECT_EQ(layers.run(90), 0u);
    EXPECT_GT(layers.m_plugin.statistics().m_selfContacts, 0u);
    for (const btSoftBody* cloth : layers.m_cloths)
        EXPECT_EQ(cloth->m_scontacts.size(), 0);
}

TEST(SelfCollision, FlagsAreBulletsWithItsLinks)
{
    Settings settings = hostSettings();
    settings.m_solver = Solver::Bullet;
    Layers layers(settings, 2, 0.02f, false);
    for (btSoftBody* cloth : layers.m_cloths)
        cloth->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    layers.m_world.step();
    EXPECT_EQ(layers.m_plugin.statistics().m_selfContacts, 0u);
    EXPECT_GT(layers.m_cloths[0]->m_scontacts.size() + layers.m_cloths[1]->m_scontacts.size(), 0);
}

// A cloth that is folded onto itself, with and without a flag.
TEST(SelfCollision, AFlagOfBulletKeepsAClothFromItself)
{
    for (const bool isSet : {false, true})
    {
        Plugin plugin(hostSettings());
        DropWorld world(&plugin);
        btSoftBody& cloth = world.addCloth(ClothSpec());
        cloth.setSelfCollision(isSet);
        world.step();  // remembers where the nodes are at rest
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
        {
            btSoftBody::Node& node = cloth.m_nodes[i];
            node.m_x.setX(btFabs(node.m_x.x()));
            if (node.m_x.x() > 0 && i % 17 > 8) node.m_x.setY(node.m_x.y() + btScalar(0.03));
            node.m_q = node.m_x;
        }
        world.step(5);
        EXPECT_EQ(plugin.statistics().m_selfContacts > 0, isSet);
    }
}
}  // namespace drape::test
