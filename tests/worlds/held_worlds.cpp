#include <cmath>
#include <utility>

#include <BulletSoftBody/btSoftBodyHelpers.h>

#include "tests/worlds/families.h"

namespace drape::test
{
namespace
{
constexpr double kPi = 3.14159265358979;

struct Pin
{
    int m_node;
    btVector3 m_place;  // at the start
};

// Pins the node and remembers where it is.
Pin pinned(btSoftBody& body, int node)
{
    body.setMass(node, 0);
    return {node, body.m_nodes[node].m_x};
}

void addHills(WorldBuilder& builder, const Hills& hills, int cells)
{
    builder.addObstacle(gridMesh(cells, cells, 5, 5, hills), btTransform::getIdentity(), false);
}
}  // namespace

void buildRod(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const double radius = random.within(.05, .2);
    const TriangleMesh rod = frustumMesh(radius, -.8, radius, .8, 8 + random.below(20), true);
    const double speed = random.within(.5, 6);
    const auto turn = [speed](double time) { return turned(btVector3(1, 0, 0), speed * time); };
    builder.addMoving(rod, [turn](double time) { return turn(time) * turned(btVector3(0, 0, 1), kPi / 2); });
    const int nodesX = 8 + random.below(8), nodesZ = 10 + random.below(14);
    const double height = radius + builder.thickness() * 1.05;
    WorldCloth& cloth = builder.world().addGrid({nodesX, nodesZ, .8, 1.2, shifted(0, height, .6)});
    builder.style(*cloth.m_body, false);
    std::vector<Pin> pins;
    for (int i = 0; i < nodesX; ++i)
        pins.push_back(pinned(*cloth.m_body, i));
    cloth.m_drive = [pins, turn](double time, btSoftBody& body)
    {
        for (const Pin& pin : pins)
        {
            btSoftBody::Node& node = body.m_nodes[pin.m_node];
            node.m_q = node.m_x;
            node.m_x = turn(time) * pin.m_place;
            node.m_v.setZero();
        }
    };
    builder.world().m_frames = 120;
}

void buildPressure(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    World& world = builder.world();
    const int resolution = 60 + random.below(200);
    const btScalar z = btScalar(random.within(.2, .5)), y = btScalar(random.within(.2, .5)),
                   x = btScalar(random.within(.2, .5));
    std::unique_ptr<btSoftBody> body(btSoftBodyHelpers::CreateEllipsoid(
        world.bullet().getWorldInfo(), btVector3(0, btScalar(1. + builder.lift()), 0), btVector3(x, y, z), resolution));
    body->getCollisionShape()->setMargin(btScalar(world.m_clothMargin));
    body->m_cfg.kPR = btScalar(random.logWithin(1, 3000));
    body->m_cfg.kDF = 1;
    body->m_cfg.kDP = btScalar(.001);
    body->m_materials[0]->m_kLST = btScalar(random.within(.1, 1));
    body->setTotalMass(btScalar(random.logWithin(.1, 30)), true);
    builder.style(*world.addCloth(std::move(body)).m_body);
    const Hills hills = randomHills(random, {.05, .3}, 9);
    addHills(builder, hills, 10 + random.below(30));
}

void buildMovingPins(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const Hills hills = randomHills(random, {.05, .25}, 9);
    addHills(builder, hills, 10 + random.below(40));
    const int nodes = 8 + random.below(12);
    WorldCloth& cloth = builder.world().addGrid({nodes, nodes, 1, 1, shifted(0, .5 + builder.lift(), 0)});
    builder.style(*cloth.m_body, false);
    const double amplitude = random.within(.2, 1.2), swing = random.within(.5, 5);
    const int count = 1 + random.below(3), corners[3] = {0, nodes - 1, nodes * nodes - 1};
    std::vector<Pin> pins;
    for (int i = 0; i < count; ++i)
        pins.push_back(pinned(*cloth.m_body, corners[i]));
    cloth.m_drive = [=](double time, btSoftBody& body)
    {
        const btVector3 way(btScalar(amplitude * std::sin(swing * time)), btScalar(.1 * (std::cos(swing * time) - 1)),
                            btScalar(amplitude * (1 - std::cos(.7 * swing * time))));
        for (const Pin& pin : pins)
            body.m_nodes[pin.m_node].m_x = pin.m_place + way;
    };
}

void buildAnchors(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    World& world = builder.world();
    const Hills hills = randomHills(random, {.05, .2}, 6);
    addHills(builder, hills, 10 + random.below(30));
    btSoftBody& cloth = builder.drop({1, .8 + builder.lift(), 0, false});
    auto shape = std::make_unique<btBoxShape>(btVector3(btScalar(.1), btScalar(.1), btScalar(.1)));
    const double mass = random.logWithin(.1, 50);
    btVector3 inertia;
    shape->calculateLocalInertia(btScalar(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shape.get(), inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(cloth.m_nodes[0].m_x + btVector3(0, btScalar(.15 + world.m_clothMargin), 0));
    auto body = std::make_unique<btRigidBody>(info);
    btRigidBody* anchor = body.get();
    world.addBody(std::move(body), std::move(shape));
    const int count = 1 + random.below(4);
    for (int i = 0; i < count; ++i)
        cloth.appendAnchor(i, anchor, true, btScalar(random.within(.3, 1)));
}
}  // namespace drape::test
