// Ropes: held, loaded, as sticks on the ground, and one that is hit.
#include <BulletSoftBody/btSoftBodyHelpers.h>

#include "benchmarks/soft_demo/demo_scenes.h"

namespace drape::bench
{
namespace
{
// Fifteen ropes of 20 kg between pins, from soft to stiff.
void buildRopes(DemoWorld& world)
{
    constexpr int kRopes = 15;
    for (int i = 0; i < kRopes; ++i)
    {
        const btScalar z = btScalar(0.25) * btScalar(i);
        btSoftBody& rope = world.addSoft(
            btSoftBodyHelpers::CreateRope(world.info(), btVector3(-10, 0, z), btVector3(10, 0, z), 16, 1 + 2));
        rope.m_cfg.piterations = 4;
        rope.m_materials[0]->m_kLST = btScalar(0.1 + 0.9 * i / (kRopes - 1));
        rope.setTotalMass(20);
    }
}

// A box of 50 kg that hangs from two ropes.
void buildRopeAttach(DemoWorld& world)
{
    btRigidBody& box = world.addBody(50, at(12, 8, 0), std::make_shared<btBoxShape>(btVector3(2, 6, 2)));
    for (const btScalar z : {btScalar(-1), btScalar(1)})
    {
        btSoftBody& rope =
            world.addSoft(btSoftBodyHelpers::CreateRope(world.info(), btVector3(0, 8, z), btVector3(10, 8, z), 8, 1));
        rope.setTotalMass(50);
        rope.appendAnchor(rope.m_nodes.size() - 1, &box);
    }
}

// A field of 16 x 16 rods of 10 g that stand on the ground, and a ball that falls on them.
void buildSticks(DemoWorld& world)
{
    constexpr int kSide = 16;
    constexpr btScalar kHalf = 5, kLength = 4, kFoot = -10;
    for (int i = 0; i < kSide * kSide; ++i)
    {
        const btScalar x = kHalf * btScalar(2 * (i % kSide)) / (kSide - 1) - kHalf;
        const btScalar z = kHalf * btScalar(2 * (i / kSide)) / (kSide - 1) - kHalf;
        const btVector3 foot(x, kFoot, z);
        btSoftBody& stick = world.addSoft(btSoftBodyHelpers::CreateRope(
            world.info(), foot, foot + btVector3(btScalar(0.001) * kLength, kLength, 0), 4, 1));
        stick.m_cfg.kDP = btScalar(0.005);
        stick.m_cfg.kCHR = btScalar(0.1);
        for (int distance = 2; distance <= 4; ++distance)
            stick.generateBendingConstraints(distance);
        stick.setMass(1, 0);
        stick.setTotalMass(btScalar(0.01));
    }
    world.addBody(10, at(0, 13, 0), std::make_shared<btSphereShape>(btScalar(3)));
}

// A box of 10 kg that falls on one node on a link of 1 m.
void buildImpact(DemoWorld& world)
{
    btSoftBody& rope =
        world.addSoft(btSoftBodyHelpers::CreateRope(world.info(), btVector3(0, 0, 0), btVector3(0, -1, 0), 0, 1));
    rope.m_cfg.kCHR = btScalar(0.5);
    world.addBody(10, at(0, 20, 0), std::make_shared<btBoxShape>(btVector3(2, 2, 2)));
}

// A frame of four links whose corners but one are pinned.
void buildBending(DemoWorld& world)
{
    constexpr btScalar kHalf = 4;
    const btVector3 corners[] = {{-kHalf, 0, -kHalf}, {kHalf, 0, -kHalf}, {kHalf, 0, kHalf}, {-kHalf, 0, kHalf}};
    const btScalar masses[] = {0, 0, 0, 1};
    btSoftBody* frame = new btSoftBody(&world.info(), 4, corners, masses);
    for (int i = 0; i < 4; ++i)
        frame->appendLink(i, (i + 1) % 4);
    frame->appendLink(0, 2);
    world.addSoft(frame);
}

// Eight loose ropes that fall on the wavy mesh.
void buildRopesOnMesh(DemoWorld& world)
{
    for (int i = 0; i < 8; ++i)
    {
        const btScalar z = btScalar(i - 4);
        btSoftBody& rope = world.addSoft(
            btSoftBodyHelpers::CreateRope(world.info(), btVector3(-8, -2, z), btVector3(8, -2, z), 62, 0));
        rope.getCollisionShape()->setMargin(btScalar(0.1));
        rope.setTotalMass(5);
        rope.m_cfg.kDF = 1;
    }
}
}  // namespace

void addRopeScenes(std::vector<DemoScene>& scenes)
{
    const DemoScene added[] = {{"ropes", "fifteen ropes between pins, from soft to stiff", 0, buildRopes},
                               {"rope_attach", "box hangs from two ropes", 0, buildRopeAttach},
                               {"sticks", "ball falls on 256 rods", 0, buildSticks},
                               {"impact", "box falls on the end of a link", kLoads, buildImpact, -8.5},
                               {"bending", "frame of links with one free corner", 0, buildBending},
                               {"ropes_on_mesh", "loose ropes fall on a wavy mesh", kWavyGround, buildRopesOnMesh}};
    scenes.insert(scenes.end(), std::begin(added), std::end(added));
}
}  // namespace drape::bench
