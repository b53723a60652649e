// Ropes, fringes and strings: links without a face against meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>

#include "scenes/mesh_builder.h"
#include "scenes/shapes.h"
#include "tests/bullet/rope_scene.h"
#include "tests/support/published_data.h"

namespace drape::test
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
constexpr int kRodSides = 7;
constexpr double kRodRadius = 0.05, kRodLength = 3;  // m

// Makes a closed prism around the z axis. A radius of 0 at the far end gives a needle.
TriangleMesh makeRod(double radius, double farRadius)
{
    TriangleMesh mesh;
    for (const double z : {-kRodLength / 2, kRodLength / 2})
    {
        const double own = z < 0 ? radius : farRadius;
        for (int i = 0; i < kRodSides && (own > 0 || i == 0); ++i)
            addVertex(mesh, own * std::cos(2 * kPi * i / kRodSides), own * std::sin(2 * kPi * i / kRodSides), z);
    }
    for (int i = 0; i < kRodSides; ++i)
    {
        const int next = (i + 1) % kRodSides;
        const int far = farRadius > 0 ? kRodSides + i : kRodSides, farNext = farRadius > 0 ? kRodSides + next : far;
        addTriangle(mesh, i, next, far);
        if (farRadius > 0) addTriangle(mesh, next, farNext, far);
        if (i > 0 && i + 1 < kRodSides) addTriangle(mesh, 0, next, i);
        if (farRadius > 0 && i > 0 && i + 1 < kRodSides) addTriangle(mesh, kRodSides, kRodSides + i, kRodSides + next);
    }
    return mesh;
}

// Makes a needle with its tip upwards, at height 0.
TriangleMesh makeNeedle(double radius)
{
    const btQuaternion upright(btVector3(1, 0, 0), btScalar(-kPi / 2));
    return placed(makeRod(radius, 0), btTransform(upright, btVector3(0, btScalar(-kRodLength / 2), 0)));
}

TriangleMesh obstacleNamed(const std::string& name)
{
    TriangleMesh mesh;
    if (name == "needle") return makeNeedle(0.03);
    if (name == "rod") return makeRod(kRodRadius, kRodRadius);
    if (name == "bunny" && loadBunny(mesh)) placeOnFloor(mesh, 2.0f);
    if (name == "bunny") return mesh;
    const bool known = makeShape(name, mesh);
    EXPECT_TRUE(known) << name;
    return mesh;
}

// Makes a square of 17 x 17 nodes and 1 m. Each node of its rim has a thread of three links that goes straight
// outwards.
std::unique_ptr<btSoftBody> makeFringed(btSoftBodyWorldInfo& info, btScalar height)
{
    constexpr int kSide = 17;
    const btScalar half = btScalar(0.5), threads = btScalar(0.07);
    std::unique_ptr<btSoftBody> cloth(btSoftBodyHelpers::CreatePatch(
        info, btVector3(-half, height, -half), btVector3(half, height, -half), btVector3(-half, height, half),
        btVector3(half, height, half), kSide, kSide, 0, true));
    for (int i = 0; i < kSide * kSide; ++i)
    {
        const int column = i % kSide, row = i / kSide;
        const btVector3 out(btScalar((column == kSide - 1) - (column == 0)), 0,
                            btScalar((row == kSide - 1) - (row == 0)));
        for (int k = 1; k <= 3 && !out.isZero(); ++k)
        {
            cloth->appendNode(cloth->m_nodes[i].m_x + out * (threads * btScalar(k)), 1);
            const int last = cloth->m_nodes.size() - 1;
            cloth->appendLink(k == 1 ? i : last - 1, last);
        }
    }
    style(*cloth, 1);
    return cloth;
}

struct RopeDrop
{
    const char* m_obstacle;
    int m_speed;  // m/s, downwards
};

class RopesDropped : public testing::TestWithParam<RopeDrop>
{
};

// Drops ropes across the middle, in several directions. Returns the hash of all steps.
std::uint64_t drop(const RopeDrop& drop, const Settings& settings, int steps)
{
    const TriangleMesh obstacle = obstacleNamed(drop.m_obstacle);
    if (obstacle.m_triangles.empty()) return 0;
    RopeWorld world(obstacle, settings);
    const btScalar top = btScalar(boundsOf(obstacle).m_high[1]);
    for (int i = 0; i < 6; ++i)
    {
        const btScalar angle = btScalar(0.1 + i * kPi / 6), off = btScalar(0.031 * i - 0.07);
        const btVector3 along(btCos(angle), 0, btSin(angle)), beside(-along.z(), 0, along.x());
        const btVector3 middle = beside * off + btVector3(0, top + btScalar(0.1 + 0.05 * i), 0);
        btSoftBody& rope =
            world.add(makeRope(world.info(), middle - along * btScalar(1.2), middle + along * btScalar(1.17), 48));
        rope.setVelocity(btVector3(0, btScalar(-drop.m_speed), 0));
        EXPECT_EQ(world.m_plugin.whyStock(&rope, world.m_object), "");
    }
    world.run(steps);
    EXPECT_GE(world.m_mostContacts, 6u);  // one for each rope
    EXPECT_GT(world.leastGap(), kThickness / 8);
    return world.hash();
}
}  // namespace

TEST_P(RopesDropped, EndEveryStepOutsideWithTheSameBitsOnEveryBackend)
{
    std::uint64_t first = 0;
    for (const BackendCase& backend : allBackends())
    {
        if (backend.m_missing) continue;
        SCOPED_TRACE(backend.m_name);
        const std::uint64_t hash = drop(GetParam(), backend.m_settings, 120);
        if (first == 0) first = hash;
        EXPECT_EQ(hash, first);
        if (HasFailure()) return;
    }
}

INSTANTIATE_TEST_SUITE_P(Drops, RopesDropped,
                         testing::Values(RopeDrop{"sphere", 0}, RopeDrop{"sphere", 10}, RopeDrop{"sphere", 200},
                                         RopeDrop{"box", 0}, RopeDrop{"box", 50}, RopeDrop{"stairs", 2},
                                         RopeDrop{"stairs", 50}, RopeDrop{"torus", 10}, RopeDrop{"bowl", 3},
                                         RopeDrop{"needle", 0}, RopeDrop{"needle", 10}, RopeDrop{"needle", 100},
                                         RopeDrop{"rod", 0}, RopeDrop{"rod", 20}, RopeDrop{"rod", 100},
                                         RopeDrop{"bunny", 0}, RopeDrop{"bunny", 10}, RopeDrop{"bunny", 50}),
                         [](const testing::TestParamInfo<RopeDrop>& test)
                         { return test.param.m_obstacle + std::to_string(test.param.m_speed); });

class Ropes : public BackendTest
{
};

// A weight of a hundred nodes hangs over the edge of a box. Its links are longer than the height of the edge above the
// ground, so the edge must support links, not nodes.
TEST_P(Ropes, HangOverAnEdgeWithAWeight)
{
    RopeWorld world(makeBox(1.0f, 0.4f, 1.0f), GetParam().m_settings);
    const btScalar height = btScalar(0.2 + 1.5 * kThickness);
    btSoftBody& rope = world.add(
        makeRope(world.info(), btVector3(0, height, btScalar(0.01)), btVector3(1, height, btScalar(0.02)), 8, 1));
    rope.setMass(8, rope.getMass(7) * 100);
    rope.m_cfg.piterations = 20;
    world.run(400);
    EXPECT_GT(world.contactsOfKind(2), 0u);
    EXPECT_LT(rmsSpeed(rope), 0.02);
    EXPECT_LT(rope.m_nodes[8].m_x.y(), 0);
    EXPECT_GT(double(rope.m_nodes[2].m_x.y()), 0.2 + 0.9 * kThickness);
    EXPECT_GT(world.leastGap(), kThickness / 4);
}

// The rope is pulled by its end over the top and around the edge, at several speeds.
TEST_P(Ropes, StayOutsideWhenDraggedOverAnEdge)
{
    for (const int speed : {1, 5, 20})
    {
        SCOPED_TRACE(speed);
        RopeWorld world(makeBox(1.0f, 0.4f, 1.0f), GetParam().m_settings);
        const btScalar height = btScalar(0.2 + 1.5 * kThickness);
        btSoftBody& rope = world.add(makeRope(world.info(), btVector3(btScalar(0.6), height, 0),
                                              btVector3(btScalar(-1.4), height, btScalar(0.1)), 40));
        for (int step = 0; step < 90 && !HasFailure(); ++step)
        {
            btSoftBody::Node& end = rope.m_nodes[0];
            if (end.m_x.y() > -1) end.m_v = btVector3(btScalar(0.1), -1, 0) * btScalar(speed);
            world.run(1);
        }
        EXPECT_GT(world.m_mostContacts, 20u);
        if (HasFailure()) return;
    }
}

// The rope has two and a half turns around a rod, its ends drawn tight. A link that passed the rod would remove a turn.
TEST_P(Ropes, StayWoundOnARod)
{
    for (const int speed : {1, 10, 60})
    {
        SCOPED_TRACE(speed);
        RopeWorld world(makeRod(kRodRadius, kRodRadius), GetParam().m_settings);
        constexpr int kLinks = 60;
        std::unique_ptr<btSoftBody> wound = makeRope(world.info(), btVector3(0, 0, 0), btVector3(2, 0, 0), kLinks);
        const auto angleOf = [](const btVector3& p) { return std::atan2(double(p.y()), double(p.x())); };
        for (int i = 0; i <= kLinks; ++i)
        {
            const double along = double(i) / kLinks, angle = 5 * kPi * along;
            const double radius = kRodRadius + 2 * kThickness + 0.1 * std::fabs(along - 0.5);
            wound->m_nodes[i].m_x = wound->m_nodes[i].m_q = btVector3(
                btScalar(radius * std::cos(angle)), btScalar(radius * std::sin(angle)), btScalar(0.8 * (along - 0.5)));
        }
        for (int i = 0; i < wound->m_links.size(); ++i)
            wound->m_links[i].m_rl =
                btScalar(0.9) * (wound->m_links[i].m_n[0]->m_x - wound->m_links[i].m_n[1]->m_x).length();
        wound->updateConstants();
        btSoftBody& rope = world.add(std::move(wound));
        for (int step = 0; step < 120 && !HasFailure(); ++step)
        {
            rope.m_nodes[0].m_v += btVector3(btScalar(0.2), btScalar(-0.3), 0) * btScalar(speed);
            rope.m_nodes[kLinks].m_v += btVector3(btScalar(-0.2), btScalar(-0.3), 0) * btScalar(speed);
            world.run(1);
            double turned = 0;
            for (int i = 0; i < kLinks; ++i)
                turned += std::remainder(angleOf(rope.m_nodes[i + 1].m_x) - angleOf(rope.m_nodes[i].m_x), 2 * kPi);
            EXPECT_GT(turned, 3 * kPi) << "step " << step;
        }
        EXPECT_GT(world.contactsOfKind(2), 5u);
        if (HasFailure()) return;
    }
}

// Lies on two posts, with no node near either.
TEST_P(Ropes, RestOnPostsBetweenTheirNodes)
{
    const btScalar wide = btScalar(0.45);
    TriangleMesh posts = placed(makeBox(0.04f, 1.0f, 0.04f),
                                btTransform(btQuaternion::getIdentity(), btVector3(-wide, btScalar(-0.5), 0)));
    const TriangleMesh other = placed(makeBox(0.04f, 1.0f, 0.04f),
                                      btTransform(btQuaternion::getIdentity(), btVector3(wide, btScalar(-0.5), 0)));
    const std::int32_t first = std::int32_t(posts.vertexCount());
    posts.m_positions.insert(posts.m_positions.end(), other.m_positions.begin(), other.m_positions.end());
    for (const std::int32_t index : other.m_triangles)
        posts.m_triangles.push_back(first + index);
    RopeWorld world(posts, GetParam().m_settings);
    btSoftBody& rope = world.add(makeRope(world.info(), btVector3(btScalar(-0.9), btScalar(0.03), btScalar(0.004)),
                                          btVector3(btScalar(0.9), btScalar(0.03), btScalar(-0.003)), 6));
    world.run(300);
    EXPECT_GT(world.contactsOfKind(2), 1u);
    EXPECT_LT(rmsSpeed(rope), 0.02);
    EXPECT_GT(rope.m_nodes[2].m_x.y(), btScalar(-0.3));
    EXPECT_GT(world.leastGap(), kThickness / 2);
}

// Cloth with threads of three links along its rim falls on something sharp and on something round.
TEST_P(Ropes, HangFromAClothAsItsFringe)
{
    for (const auto& [obstacle, speed] : {std::make_pair("needle", 0), std::make_pair("needle", 30),
                                          std::make_pair("torus", 0), std::make_pair("box", 30)})
    {
        SCOPED_TRACE(std::string(obstacle) + " " + std::to_string(speed));
        const TriangleMesh mesh = obstacleNamed(obstacle);
        RopeWorld world(mesh, GetParam().m_settings);
        btSoftBody& cloth = world.add(makeFringed(world.info(), btScalar(boundsOf(mesh).m_high[1]) + btScalar(0.1)));
        cloth.setVelocity(btVector3(0, btScalar(-speed), 0));
        world.run(120);
        EXPECT_GT(world.m_mostContacts, 10u);
        EXPECT_GT(world.leastGap(), kThickness / 8);
        if (HasFailure()) return;
    }
}

// Across a box, as one link whose ends are outside, upright, and through a ring twice.
TEST_P(Ropes, ThoseBeginningThroughAMeshAreReportedAndComeOut)
{
    const struct
    {
        TriangleMesh m_obstacle;
        btVector3 m_from, m_to;
        int m_links;
    } starts[] = {
        {makeBox(1.0f, 0.4f, 1.0f), {btScalar(-1.2), btScalar(0.1), 0}, {btScalar(1.2), btScalar(0.1), 0}, 40},
        {makeBox(1.0f, 0.4f, 1.0f), {btScalar(-1.2), btScalar(0.1), 0}, {btScalar(1.2), btScalar(0.1), 0}, 1},
        {makeBox(1.0f, 0.4f, 1.0f), {0, btScalar(-0.9), btScalar(0.1)}, {0, 1, btScalar(0.1)}, 20},
        {makeTorus(0.5f, 0.1f, 24, 12), {btScalar(-1.2), 0, 0}, {btScalar(1.2), btScalar(0.02), 0}, 30}};
    for (const auto& start : starts)
    {
        SCOPED_TRACE(start.m_links);
        Settings settings = GetParam().m_settings;
        settings.m_log = nullptr;
        Plugin plugin(settings);
        MeshShape shape(start.m_obstacle);
        DropWorld world(&plugin);
        world.addObstacle(shape.shape());
        const std::unique_ptr<btSoftBody> rope =
            makeRope(world.world().getWorldInfo(), start.m_from, start.m_to, start.m_links);
        world.world().addSoftBody(rope.get());
        EXPECT_NE(plugin.diagnose(world.world()).find("triangles intersect"), std::string::npos);
        PenetrationMeter meter(start.m_obstacle, meshWithLinks(*rope));
        world.step();
        EXPECT_EQ(plugin.statistics().m_status, std::uint32_t(kStepStartsIntersecting));
        EXPECT_GE(plugin.statistics().m_startIntersections, 2u);
        world.step(239);
        EXPECT_EQ(plugin.statistics().m_status, std::uint32_t(kStepGood));
        const StepMeasure measure = meter.measure(positionsOf(*rope).data());
        EXPECT_EQ(measure.nodesBelow(), 0u);
        EXPECT_EQ(measure.m_intersectingPairs, 0u);
        world.world().removeSoftBody(rope.get());
    }
}

// A link of the first rope joins it to the second.
TEST_P(Ropes, LinksToAnotherBodyAreReported)
{
    Plugin plugin(GetParam().m_settings);
    MeshShape shape(makeBox(1.0f, 0.4f, 1.0f));
    DropWorld world(&plugin);
    world.addObstacle(shape.shape());
    std::unique_ptr<btSoftBody> ropes[2];
    for (int i = 0; i < 2; ++i)
    {
        const btVector3 middle(0, btScalar(0.25), btScalar(0.3) * btScalar(i)), half(btScalar(0.4), 0, 0);
        ropes[i] = makeRope(world.world().getWorldInfo(), middle - half, middle + half, 10);
        world.world().addSoftBody(ropes[i].get());
    }
    world.step();
    EXPECT_EQ(plugin.statistics().m_status, std::uint32_t(kStepGood));
    ropes[0]->appendLink(5, 6);
    ropes[0]->m_links[ropes[0]->m_links.size() - 1].m_n[1] = &ropes[1]->m_nodes[5];
    for (int step = 0; step < 60; ++step)
    {
        world.step();
        ASSERT_EQ(plugin.statistics().m_status, std::uint32_t(kStepFacesLeftOut)) << "step " << step;
    }
    for (const auto& rope : ropes)
    {
        EXPECT_GT(lowestOf(*rope), btScalar(0.2));
        world.world().removeSoftBody(rope.get());
    }
}

INSTANTIATE_TEST_SUITE_P(Backend, Ropes, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
