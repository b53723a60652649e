#include <cmath>

#include "scenes/mesh_builder.h"
#include "scenes/vector3.h"
#include "tests/worlds/families.h"

namespace drape::test
{
namespace
{
TriangleMesh hillsOf(const Hills& hills, int cells, double size)
{
    return gridMesh(cells, cells, size, size, hills);
}

// Gives every triangle vertices of its own, moves them towards its middle, and turns half of the triangles over.
TriangleMesh shattered(WorldRandom& random, const TriangleMesh& whole, double share)
{
    TriangleMesh mesh;
    for (std::size_t t = 0; t < whole.m_triangles.size(); t += 3)
    {
        Vector3 corners[3], middle;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const float* p = &whole.m_positions[3 * static_cast<std::size_t>(whole.m_triangles[t + k])];
            corners[k] = {p[0], p[1], p[2]};
            middle += (1. / 3) * corners[k];
        }
        const int first = static_cast<int>(mesh.vertexCount());
        for (const Vector3& corner : corners)
        {
            const Vector3 p = middle + share * (corner - middle);
            addVertex(mesh, p.x, p.y, p.z);
        }
        if (random.chance(.5))
            addTriangle(mesh, first, first + 1, first + 2);
        else
            addTriangle(mesh, first, first + 2, first + 1);
    }
    return mesh;
}
}  // namespace

void buildTerrain(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    Hills hills = randomHills(random, {.05, .3}, 9);
    hills.m_ripple = random.within(0, .15);
    hills.m_rippleFrequency = random.within(1, 6);
    hills.m_ripplePhase = random.within(0, 6);
    const int cells = 10 + random.below(50);
    builder.addObstacle(hillsOf(hills, cells, 4));
    builder.drop({random.within(.5, 1.6), .75 + builder.lift()});
}

void buildFineMesh(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const Hills hills = randomHills(random, {.02, .2}, 6);
    const int cells = 80 + random.below(60);
    builder.addObstacle(hillsOf(hills, cells, 1.2));
    const int nodes = 3 + random.below(3);
    builder.drop({random.within(.5, 1), .5 + builder.lift(), nodes});
}

void buildCoarseMesh(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const double slope = random.within(-.4, .4);
    const double sizeZ = random.logWithin(10, 100), sizeX = random.logWithin(10, 100);
    builder.addObstacle(gridMesh(1, 1, sizeX, sizeZ), turned(btVector3(1, 0, 1), slope));
    const int nodes = 20 + random.below(15);
    builder.drop({random.within(.2, .6), .75 + builder.lift(), nodes});
}

void buildCrumpled(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const Hills hills = randomHills(random, {.05, .3}, 9);
    const int cells = 10 + random.below(30);
    builder.addObstacle(hillsOf(hills, cells, 4));
    const double height = 1. + builder.lift();
    btSoftBody& body = builder.drop({1, height});
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btScalar radius = btScalar(random.within(0, .3));
        body.m_nodes[i].m_x = btVector3(0, btScalar(height), 0) + random.direction() * radius;
        body.m_nodes[i].m_q = body.m_nodes[i].m_x;
    }
}

void buildCracks(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const Hills hills = randomHills(random, {.05, .3}, 9);
    const int cells = 6 + random.below(30);
    const double share = random.chance(.3) ? 1 : random.within(.9, 1.);
    builder.addObstacle(shattered(random, hillsOf(hills, cells, 4), share)).m_frontsUp = true;
    builder.drop({random.within(.5, 1.6), .75 + builder.lift()});
}

void buildWaveFloor(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const Hills hills = randomHills(random, {.05, .3}, 9);
    const int cells = 6 + random.below(30);
    const double amplitude = random.within(.05, .5), swing = random.within(2, 20);
    // Starts at the origin and drops by about the amplitude in the first step.
    const auto motion = [=](double time)
    {
        if (time == 0) return shifted(0, 0, 0);
        return shifted(.3 * amplitude * std::cos(swing * .7 * time) - .3 * amplitude,
                       amplitude * std::sin(swing * time) - amplitude, 0);
    };
    builder.addMoving(hillsOf(hills, cells, 5), motion);
    builder.drop({random.within(.5, 1.6), .75 + builder.lift()});
    builder.world().m_frames = 120;
}
}  // namespace drape::test
