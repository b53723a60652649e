// Worlds in which Drape has nothing to do run as with Bullet's own solver and collision configuration, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"

namespace drape::test
{
namespace
{
using Bodies = std::vector<std::unique_ptr<btSoftBody>>;

using MakeBodies = Bodies (*)(btSoftBodyWorldInfo&);

struct Placed
{
    btCollisionShape* m_shape;
    btVector3 m_place;  // m
};

// The results of all steps: the bodies' hash and the largest number of Bullet's pairs.
struct Outcome
{
    std::uint64_t m_hash = 0;
    int m_mostPairs = 0;
};

// Steps a world of soft bodies and obstacles at rest, with a plugin or without.
Outcome run(Plugin* plugin, const std::vector<Placed>& obstacles, MakeBodies make, int steps)
{
    DropWorld world(plugin);
    for (const Placed& placed : obstacles)
        world.addObstacle(*placed.m_shape, btTransform(btQuaternion::getIdentity(), placed.m_place));
    const Bodies bodies = make(world.world().getWorldInfo());
    for (const auto& body : bodies)
        world.world().addSoftBody(body.get());
    Outcome outcome;
    for (int step = 0; step < steps; ++step)
    {
        world.step();
        outcome.m_mostPairs = std::max(outcome.m_mostPairs, world.world().getPairCache()->getNumOverlappingPairs());
        for (const auto& body : bodies)
            outcome.m_hash = hashOf(*body, outcome.m_hash);
    }
    for (const auto& body : bodies)
        world.world().removeSoftBody(body.get());
    return outcome;
}

void expectStockBits(const std::vector<Placed>& obstacles, MakeBodies make, int steps)
{
    Settings settings = hostSettings();
    settings.m_solver = Solver::Bullet;
    settings.m_staticConvex = ShapeContacts::Bullet;
    Plugin plugin(settings);
    const Outcome stock = run(nullptr, obstacles, make, steps), drape = run(&plugin, obstacles, make, steps);
    EXPECT_EQ(stock.m_hash, drape.m_hash);
    EXPECT_EQ(stock.m_mostPairs, drape.m_mostPairs);
    EXPECT_GT(stock.m_mostPairs, 0) << "nothing meets";
}

const btVector3 kGround(2, btScalar(0.2), 2);  // m, half of its sides

// Makes upright ropes, which tip over onto each other and the ground.
Bodies makeRopes(btSoftBodyWorldInfo& info)
{
    Bodies ropes;
    for (int i = 0; i < 16; ++i)
    {
        const btVector3 foot(btScalar(0.66) * btScalar(i % 4) - 1, btScalar(0.5), btScalar(0.66) * btScalar(i / 4) - 1);
        ropes.emplace_back(btSoftBodyHelpers::CreateRope(info, foot, foot + btVector3(0, 2, 0), 4, 0));
        ropes.back()->setTotalMass(1);
    }
    return ropes;
}

Bodies makeSoftBoxes(btSoftBodyWorldInfo& info)
{
    Bodies boxes;
    for (int i = 0; i < 4; ++i)
    {
        btVector3 corners[8];
        for (int k = 0; k < 8; ++k)
            corners[k] = btVector3(btScalar(0.3) * btScalar(i) + btScalar(k & 1) - 1,
                                   btScalar(1) + btScalar(1.6) * btScalar(i) + btScalar((k & 2) / 2),
                                   btScalar((k & 4) / 4) - btScalar(0.5));
        boxes.emplace_back(btSoftBodyHelpers::CreateFromConvexHull(info, corners, 8));
        boxes.back()->generateBendingConstraints(2);
        boxes.back()->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    }
    return boxes;
}
}  // namespace

TEST(LeftToBullet, RopesOnABoxKeepBulletsBits)
{
    btBoxShape ground(kGround);
    expectStockBits({{&ground, btVector3(0, 0, 0)}}, makeRopes, 120);
}

TEST(LeftToBullet, RopesKeepBulletsBitsFarFromAMesh)
{
    btBoxShape ground(kGround);
    MeshShape mesh(makeSphere(0.5f, 2));
    expectStockBits({{&ground, btVector3(0, 0, 0)}, {&mesh.shape(), btVector3(20, 0, 0)}}, makeRopes, 120);
}

TEST(LeftToBullet, SoftBodiesThatDrapeWouldTakeKeepBulletsBitsWithoutAMesh)
{
    btBoxShape ground(kGround);
    expectStockBits({{&ground, btVector3(0, 0, 0)}}, makeSoftBoxes, 200);
}

TEST(LeftToBullet, SoftBodiesThatDrapeWouldTakeKeepBulletsBitsFarFromAMesh)
{
    btBoxShape ground(kGround);
    MeshShape mesh(makeSphere(0.5f, 2));
    expectStockBits({{&ground, btVector3(0, 0, 0)}, {&mesh.shape(), btVector3(20, 0, 0)}}, makeSoftBoxes, 200);
}

// Cluster collision is left to Bullet beside a mesh, too.
TEST(LeftToBullet, SoftBodiesThatCollideByClustersKeepBulletsBitsBesideAMesh)
{
    btBoxShape ground(kGround);
    MeshShape mesh(makeBox(1.0f, 0.4f, 1.0f));
    const MakeBodies make = [](btSoftBodyWorldInfo& info)
    {
        Bodies boxes = makeSoftBoxes(info);
        for (const auto& box : boxes)
        {
            box->generateClusters(1);
            box->m_cfg.collisions = btSoftBody::fCollision::CL_RS | btSoftBody::fCollision::CL_SS;
        }
        return boxes;
    };
    expectStockBits({{&ground, btVector3(0, 0, 0)}, {&mesh.shape(), btVector3(btScalar(0.5), btScalar(0.3), 0)}}, make,
                    60);
}
}  // namespace drape::test
