// Forces besides gravity, such as those of volume, pressure and springs of the app, add no energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
// A ball of 50 kg that keeps its volume, in free flight.
btSoftBody& addVolumeBall(DropWorld& world)
{
    world.world().getWorldInfo().m_gravity.setZero();
    btSoftBody* ball =
        btSoftBodyHelpers::CreateEllipsoid(world.world().getWorldInfo(), btVector3(0, 5, 0), btVector3(3, 3, 3), 512);
    ball->m_materials[0]->m_kLST = btScalar(0.45);
    ball->setTotalMass(50, true);
    world.world().addSoftBody(ball);
    return *ball;
}

double kineticEnergy(const btSoftBody& body)
{
    double energy = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (body.m_nodes[i].m_im > 0)
            energy += 0.5 * double(body.m_nodes[i].m_v.length2()) / double(body.m_nodes[i].m_im);
    return energy;
}

// Runs the world for `steps` steps and returns the largest kinetic energy, J.
double mostEnergy(DropWorld& world, const btSoftBody& body, int steps)
{
    double most = 0;
    for (int step = 0; step < steps; ++step)
    {
        world.step();
        most = std::max(most, kineticEnergy(body));
    }
    return most;
}

double largestDifference(const std::vector<float>& a, const std::vector<float>& b)
{
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        most = std::max(most, std::abs(double(a[i]) - double(b[i])));
    return most;
}

// The plugin's solver, or Bullet's own.
Settings hostSettingsOf(Solver solver)
{
    Settings settings = hostSettings();
    settings.m_solver = solver;
    return settings;
}
}  // namespace

TEST(Forces, OfAVolumeAddNoEnergy)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btSoftBody& ball = addVolumeBall(world);
    ball.m_cfg.kVC = 20;
    ball.setPose(true, false);
    ball.m_nodes[0].m_x *= btScalar(1.01);
    ASSERT_EQ(plugin.whyBulletSolves(ball), "");
    EXPECT_LT(mostEnergy(world, ball, 120), 0.01);
    world.world().removeSoftBody(&ball);
    delete &ball;
}

// A ball swings between pressure and its links.
TEST(Forces, OfPressureSwingAsWithBullet)
{
    double energies[2];
    for (const Solver solver : {Solver::Drape, Solver::Bullet})
    {
        Plugin plugin(hostSettingsOf(solver));
        DropWorld world(&plugin);
        btSoftBody& ball = addVolumeBall(world);
        ball.m_cfg.kPR = 2500;
        energies[int(solver == Solver::Bullet)] = mostEnergy(world, ball, 240);
        world.world().removeSoftBody(&ball);
        delete &ball;
    }
    EXPECT_GT(energies[0], 1);
    EXPECT_LT(energies[0], 1.5 * energies[1]);
}

// Springs of the app pull each node to its place at an angular frequency of 30 1/s.
TEST(Forces, OfSpringsAddNoEnergy)
{
    constexpr btScalar kSquaredFrequency = 900, kSpeed = 1;
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    world.world().getWorldInfo().m_gravity.setZero();
    ClothSpec spec;
    spec.m_nodes = 5;
    spec.m_damping = 0;
    btSoftBody& cloth = world.addCloth(spec);
    std::vector<btVector3> places;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        places.push_back(cloth.m_nodes[i].m_x);
    cloth.setVelocity(btVector3(0, kSpeed, 0));
    const double before = kineticEnergy(cloth);
    double most = 0;
    for (int step = 0; step < 240; ++step)
    {
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
            cloth.addForce((places[std::size_t(i)] - cloth.m_nodes[i].m_x) * kSquaredFrequency / cloth.m_nodes[i].m_im,
                           i);
        world.step();
        if (step >= 200) most = std::max(most, kineticEnergy(cloth));
    }
    EXPECT_LT(most, 1.5 * before);
    EXPECT_GT(most, 0.5 * before);
}

// Cloth that a force holds against gravity neither rises nor sinks, wherever it is solved.
TEST(Forces, ThatBalanceGravityHoldTheCloth)
{
    for (const SolverPlace place : {SolverPlace::Host, SolverPlace::Device})
        for (const btScalar damping : {btScalar(0), btScalar(0.1)})
        {
            Plugin plugin(settingsFor(place));
            MeshShape box(makeBox(1, 1, 1));
            DropWorld world(&plugin);
            world.addObstacle(box.shape(), btTransform(btQuaternion::getIdentity(), btVector3(0, -3, 0)));
            ClothSpec spec;
            spec.m_damping = damping;
            btSoftBody& cloth = world.addCloth(spec);
            const std::vector<float> before = positionsOf(cloth);
            const btVector3 lift = -world.world().getGravity() * cloth.getTotalMass() / btScalar(cloth.m_nodes.size());
            for (int step = 0; step < 120; ++step)
            {
                cloth.addForce(lift);
                world.step();
            }
            EXPECT_LT(largestDifference(before, positionsOf(cloth)), 1e-4) << int(place);
            EXPECT_LT(rmsSpeed(cloth), 1e-3) << int(place);
        }
}

// A constant force has Bullet's effect: the nodes' path is Bullet's.
TEST(Forces, OfTheAppMoveFreeNodesAsBullet)
{
    btVector3 ends[2];
    for (const Solver solver : {Solver::Drape, Solver::Bullet})
    {
        Plugin plugin(hostSettingsOf(solver));
        DropWorld world(&plugin);
        world.world().getWorldInfo().m_gravity.setZero();
        btSoftBody& cloth = world.addCloth(ClothSpec());
        cloth.m_cfg.kDP = 0;
        for (int step = 0; step < 10; ++step)
        {
            cloth.addForce(btVector3(1, 0, 0) * cloth.getTotalMass() / btScalar(cloth.m_nodes.size()));
            world.step();
        }
        ends[int(solver == Solver::Bullet)] = cloth.m_nodes[7].m_x;
    }
    EXPECT_LT((ends[0] - ends[1]).length(), btScalar(1e-5));
    EXPECT_GT(ends[0].x() + ClothSpec().m_size, 0);
}
}  // namespace drape::test
