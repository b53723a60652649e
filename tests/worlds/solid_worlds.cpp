#include <algorithm>
#include <cmath>

#include "scenes/mesh_builder.h"
#include "tests/worlds/families.h"

namespace drape::test
{
namespace
{
constexpr double kPi = 3.14159265358979;

// Adds four triangles for every four that there are: a copy, one that names a vertex twice, one without area along an
// edge, and one that names a copy of the first vertex twice.
void makeDegenerate(WorldRandom& random, TriangleMesh& mesh)
{
    const int count = static_cast<int>(mesh.triangleCount());
    const auto vertexAt = [&mesh](int index) { return mesh.m_triangles[static_cast<std::size_t>(index)]; };
    const auto placeOf = [&mesh](int vertex) { return &mesh.m_positions[3 * static_cast<std::size_t>(vertex)]; };
    for (int i = 0; i < count / 4; ++i)
    {
        const int copied = 3 * random.below(count);
        addTriangle(mesh, vertexAt(copied), vertexAt(copied + 1), vertexAt(copied + 2));
        const int twice = vertexAt(3 * random.below(count)), once = vertexAt(3 * random.below(count));
        addTriangle(mesh, twice, twice, once);
        const int edge = 3 * random.below(count), a = vertexAt(edge), b = vertexAt(edge + 1);
        const float *p = placeOf(a), *q = placeOf(b);
        const float middle[3] = {(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2};
        addVertex(mesh, middle[0], middle[1], middle[2]);
        addTriangle(mesh, a, static_cast<int>(mesh.vertexCount()) - 1, b);
        const float first[3] = {mesh.m_positions[0], mesh.m_positions[1], mesh.m_positions[2]};
        addVertex(mesh, first[0], first[1], first[2]);
        const int duplicate = static_cast<int>(mesh.vertexCount()) - 1;
        addTriangle(mesh, duplicate, vertexAt(0), duplicate);
    }
}

TriangleMesh randomWall(WorldRandom& random)
{
    const int cells = 1 + random.below(10);
    return gridMesh(cells, cells, 4, 4);
}
}  // namespace

void buildBlob(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    builder.addObstacle(randomBlob(random, {.2, .5}, 30, 20, .3));
    builder.drop({random.within(.6, 1.8), .85 + builder.lift()});
}

void buildBoxes(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const int count = 2 + random.below(5);
    for (int i = 0; i < count; ++i)
    {
        const btTransform pose = builder.randomPose({0, 6}, {-.4, .4}, {-.4, 0}, {-.4, .4});
        builder.addObstacle(randomBox(random, {.05, .6}), pose, false);
    }
    builder.addFloor(-1.2, 4);
    builder.drop({random.within(.6, 1.6), .95 + builder.lift()});
}

void buildRing(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const btTransform pose = builder.randomPose({-.5, .5}, 0, 0, 0);
    const int across = 4 + random.below(10), around = 8 + random.below(30);
    const double tube = random.within(.01, .1), ring = random.within(.2, .5);
    builder.addObstacle(torusMesh(ring, tube, around, across), pose);
    builder.drop({random.within(.3, 1.2), .7 + builder.lift()});
    builder.world().m_frames = 120;
}

void buildCorner(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const double distance = random.within(.6, .9);
    builder.addObstacle(randomWall(random), shifted(0, -distance, 0));
    builder.keepObstacles();
    const double leanX = random.within(-.4, .4);
    builder.addObstacle(randomWall(random), turned(btVector3(0, 0, 1), -kPi / 2 + leanX, -distance, 0, 0));
    const double leanZ = random.within(-.4, .4);
    builder.addObstacle(randomWall(random), turned(btVector3(1, 0, 0), kPi / 2 + leanZ, 0, 0, -distance));
    btSoftBody& body = builder.drop({random.within(.3, .8), .15 + builder.lift(), 0, false});
    const double speed = random.logWithin(1, 60);
    for (int i = 0; i < body.m_nodes.size(); ++i)
        body.m_nodes[i].m_v = btVector3(btScalar(-speed), btScalar(-speed * random.within(.5, 1.)), btScalar(-speed));
}

void buildDegenerate(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    TriangleMesh mesh = randomBlob(random, {.2, .5}, 16, 10, .2);
    makeDegenerate(random, mesh);
    builder.addObstacle(mesh);
    builder.drop({random.within(.5, 1.6), .85 + builder.lift()});
}

void buildSelfIntersecting(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const int count = 2 + random.below(4);
    for (int i = 0; i < count; ++i)
    {
        const btTransform pose = builder.randomPose({0, 6}, {-.3, .3}, {-.3, .1}, {-.3, .3});
        TriangleMesh mesh;
        if (random.chance(.5))
            mesh = bumpySphere(random, random.within(.2, .4), 10, 8, .2);
        else
            mesh = randomBox(random, {.2, .7});
        builder.addObstacle(mesh, pose, false);
    }
    builder.drop({random.within(.6, 1.6), 1.1 + builder.lift()});
}

// The surface moves by less than a twentieth of the thickness in a step.
void buildSlowScale(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    World& world = builder.world();
    constexpr double kRadius = .35;
    const btVector3 one(1, 1, 1);
    ObstacleSpec spec;
    spec.m_friction = builder.friction();
    spec.m_scaling = &one;
    WorldObstacle& obstacle = world.addObstacle(bumpySphere(random, kRadius, 16, 10, .15), spec);
    const double rate = .05 * builder.thickness() / kRadius * random.within(.1, 1);
    const int axis = random.below(3);
    const double direction = random.chance(.7) ? 1 : -1;
    obstacle.m_beforeStep = [&world, &obstacle, rate, axis, direction](double time)
    {
        const double factor = 1 + direction * std::min(.4, rate * std::max(0., time * 60 - 30));
        btVector3 scaling(1, 1, 1);
        for (int k = 0; k < 3; ++k)
            if (k == axis || axis == 0) scaling[k] = btScalar(factor);
        obstacle.m_scaledShape->setLocalScaling(scaling);
        world.bullet().updateSingleAabb(obstacle.m_object.get());
    };
    builder.drop({random.within(.6, 1.4), .6 + builder.lift()});
    world.m_frames = 150;
}
}  // namespace drape::test
