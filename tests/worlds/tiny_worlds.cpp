#include "tests/worlds/tiny_worlds.h"

#include <cmath>

#include "scenes/mesh_builder.h"
#include "tests/worlds/world_meshes.h"

namespace drape::test
{
namespace
{
constexpr int kFrames = 60;

enum TinyShape
{
    kBox,
    kRoof,
    kCone,
    kHills,
    kSphere,
    kTinyShapes
};

// Makes two quads that meet in a ridge.
TriangleMesh randomRoof(WorldRandom& random, double size)
{
    TriangleMesh mesh;
    mesh.m_positions.reserve(18);
    addVertex(mesh, -size, -size * random.within(.1, 1), -size);
    addVertex(mesh, 0, 0, -size);
    addVertex(mesh, size, -size * random.within(.1, 1), -size);
    addVertex(mesh, -size, -size * .5, size);
    addVertex(mesh, 0, 0, size);
    addVertex(mesh, size, -size * .5, size);
    addQuad(mesh, 0, 3, 4, 1);
    addQuad(mesh, 1, 4, 5, 2);
    return mesh;
}

TriangleMesh randomObstacle(WorldRandom& random, int shape, double size)
{
    if (shape == kBox) return boxMesh(size, size * random.within(.05, 1), size);
    if (shape == kRoof) return randomRoof(random, size);
    if (shape == kCone) return frustumMesh(size * .5, -size, 1e-3, 0, 3 + random.below(5), true);
    if (shape == kHills) return gridMesh(6, 6, 2, 2, randomHills(random, size * .3, 9));
    const int rings = 4 + random.below(4), around = 6 + random.below(6);
    return sphereMesh(size * .5, around, rings);
}

std::function<btTransform(double)> randomMotion(WorldRandom& random, const btTransform& pose)
{
    const btVector3 axis = random.direction(), way = random.direction();
    const double speed = random.within(0, 8), amplitude = random.within(0, .3), swing = random.within(1, 10);
    return [=](double time)
    {
        btTransform now(btQuaternion(axis, btScalar(speed * time)), way * btScalar(amplitude * std::sin(swing * time)));
        now.setBasis(now.getBasis() * pose.getBasis());
        return now;
    };
}

void throwCloth(WorldRandom& random, btSoftBody& body)
{
    btVector3 way = random.direction();
    way.setY(-btFabs(way.y()));
    const double speed = random.logWithin(.3, 20);
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btScalar stray = btScalar(speed * random.within(0, 1));
        body.m_nodes[i].m_v = way * btScalar(speed) + random.direction() * stray;
    }
    body.m_cfg.piterations = 1 + random.below(10);
}
}  // namespace

void buildTinyWorld(World& world, std::uint64_t seed, bool kinematic)
{
    WorldRandom random(seed * 2 + (kinematic ? 1 : 0));
    const int shape = random.below(kTinyShapes);
    const double size = random.logWithin(.1, 1);
    const TriangleMesh mesh = randomObstacle(random, shape, size);
    ObstacleSpec spec;
    spec.m_kinematic = kinematic;
    const double tilt = shape == kHills ? 0 : random.within(0, .6);
    spec.m_pose = turned(random.direction(), tilt);
    spec.m_friction = random.within(0, 1);
    WorldObstacle& obstacle = world.addObstacle(mesh, spec);
    if (kinematic) obstacle.m_motion = randomMotion(random, spec.m_pose);

    const int nodesX = 2 + random.below(2), nodesZ = 2 + random.below(2);
    const double edge = random.logWithin(.05, .8);
    const double height = .05 + random.within(0, .2) + (kinematic ? .4 : 0) + (shape == kHills ? size * .3 : 0) + edge;
    const bool bending = random.below(2) != 0;
    const double z = random.within(-.3, .3) * size, x = random.within(-.3, .3) * size;
    const double turn = random.within(0, 3);
    const btTransform pose = turned(random.direction(), turn, x, height, z);
    throwCloth(random, *world.addGrid({nodesX, nodesZ, edge, edge, pose, bending}).m_body);
    world.m_frames = kFrames;
}
}  // namespace drape::test
