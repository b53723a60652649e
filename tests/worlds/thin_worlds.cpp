#include <cmath>

#include "scenes/mesh_builder.h"
#include "tests/worlds/families.h"

namespace drape::test
{
namespace
{
constexpr double kPi = 3.14159265358979;

TriangleMesh randomSpikes(WorldRandom& random)
{
    TriangleMesh mesh;
    const int rows = 2 + random.below(6);
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < rows; ++j)
        {
            const int around = 3 + random.below(6);
            const double height = random.within(.1, .4), tip = 1e-3 * random.within(0, 5);
            TriangleMesh spike = frustumMesh(random.within(.02, .1), 0, tip, height, around, true);
            shift(spike, (i - .5 * (rows - 1)) * .8 / rows, 0, (j - .5 * (rows - 1)) * .8 / rows);
            append(mesh, spike);
        }
    return mesh;
}

TriangleMesh randomNeedles(WorldRandom& random)
{
    TriangleMesh mesh;
    const int count = 5 + random.below(60);
    for (int i = 0; i < count; ++i)
    {
        const double x = random.within(-.6, .6), z = random.within(-.6, .6), y = random.within(-.3, .3);
        const double length = random.within(.1, .6), width = random.logWithin(1e-5, .02);
        const btVector3 along = random.direction() * btScalar(length), across = random.direction() * btScalar(width);
        const int first = static_cast<int>(mesh.vertexCount());
        addVertex(mesh, x, y, z);
        addVertex(mesh, x + along.x(), y + along.y(), z + along.z());
        addVertex(mesh, x + along.x() + across.x(), y + along.y() + across.y(), z + along.z() + across.z());
        addTriangle(mesh, first, first + 1, first + 2);
    }
    return mesh;
}

TriangleMesh randomSlats(WorldRandom& random)
{
    TriangleMesh mesh;
    const int count = 3 + random.below(12);
    const double width = random.within(.005, .05);
    for (int i = 0; i < count; ++i)
    {
        const bool board = random.chance(.5);
        TriangleMesh slat = board ? boxMesh(width, random.within(.01, .3), 2) : gridMesh(1, 1, width, 2);
        shift(slat, (i - .5 * (count - 1)) * 1.4 / count, random.within(-.02, .02), 0);
        append(mesh, slat);
    }
    return mesh;
}

// Makes four walls of 2 m around a square shaft, from the floor down.
TriangleMesh randomShaft(WorldRandom& random, double width)
{
    TriangleMesh mesh;
    for (int side = 0; side < 4; ++side)
    {
        const int cellsZ = 1 + random.below(6), cellsX = 1 + random.below(6);
        TriangleMesh wall = gridMesh(cellsX, cellsZ, width, 2);
        const double angle = kPi / 2 * side;
        for (std::size_t i = 0; i < wall.m_positions.size(); i += 3)
        {
            float* p = &wall.m_positions[i];
            const double x = p[0], y = p[2] - 1, z = width / 2;
            p[0] = static_cast<float>(x * std::cos(angle) - z * std::sin(angle));
            p[1] = static_cast<float>(y);
            p[2] = static_cast<float>(x * std::sin(angle) + z * std::cos(angle));
        }
        append(mesh, wall);
    }
    return mesh;
}
}  // namespace

void buildSpikes(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    builder.addObstacle(randomSpikes(random));
    builder.addFloor(-.5, 4);
    builder.drop({random.within(.5, 1.4), .8 + builder.lift()});
    builder.world().m_frames = 120;
}

void buildFunnel(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const int around = 6 + random.below(30);
    const double top = random.within(.6, 1.2), bottom = random.within(.05, .25);
    builder.addObstacle(frustumMesh(bottom, -.6, top, .2, around, false));
    builder.drop({random.within(.4, 1.), .75 + builder.lift()});
    builder.world().m_frames = 150;
}

void buildTwoSheets(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const double gap = builder.thickness() * random.within(.05, .9);
    const int cells = 1 + random.below(20);
    const Hills hills = randomHills(random, {0, .1}, 6);
    TriangleMesh upper = gridMesh(cells, cells, 4, 4, hills), lower = upper;
    shift(lower, 0, -gap, 0);
    if (random.chance(.5))
    {
        append(upper, lower);
        builder.addObstacle(upper);
    }
    else
    {
        builder.addObstacle(upper, btTransform::getIdentity(), false);
        builder.addObstacle(lower, btTransform::getIdentity(), false);
    }
    builder.drop({random.within(.5, 1.5), .6 + builder.lift()});
}

void buildNeedleRain(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    builder.addObstacle(randomNeedles(random));
    builder.addFloor(-1.4, 6);
    builder.drop({random.within(.5, 1.5), 1.2 + builder.lift()});
    builder.world().m_frames = 120;
}

void buildSlats(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const TriangleMesh slats = randomSlats(random);
    builder.addObstacle(slats, turned(btVector3(0, 1, 0), random.within(0, 3)));
    builder.addFloor(-1.2, 5);
    builder.drop({random.within(.5, 1.6), .9 + builder.lift()});
    builder.world().m_frames = 120;
}

void buildChimney(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const double width = random.within(.2, .5);
    builder.addObstacle(randomShaft(random, width));
    builder.drop({width * random.within(.8, 2.5), .7 + builder.lift()});
    builder.world().m_frames = 150;
}
}  // namespace drape::test
