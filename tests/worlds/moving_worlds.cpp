#include <algorithm>
#include <cmath>

#include "tests/worlds/families.h"

namespace drape::test
{
namespace
{
constexpr double kPi = 3.14159265358979;

TriangleMesh randomBlades(WorldRandom& random)
{
    TriangleMesh mesh;
    const int count = 2 + random.below(4);
    for (int i = 0; i < count; ++i)
    {
        const double depth = random.within(.05, .2), height = random.within(.01, .05);
        TriangleMesh blade = boxMesh(.8, height, depth);
        const double angle = 2 * kPi * i / count;
        for (std::size_t v = 0; v < blade.m_positions.size(); v += 3)
        {
            float* p = &blade.m_positions[v];
            const float x = p[0] + .45f, z = p[2];
            p[0] = static_cast<float>(x * std::cos(angle) - z * std::sin(angle));
            p[2] = static_cast<float>(x * std::sin(angle) + z * std::cos(angle));
        }
        append(mesh, blade);
    }
    return mesh;
}
}  // namespace

void buildJaws(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const double least = builder.thickness() * random.within(2.3, 5), speed = random.within(.1, 2);
    const double open = .35 + builder.thickness();
    random.below(8);  // not used; keeps the later draws what the seeds stand for
    for (const int side : {1, -1})
        builder.addMoving(boxMesh(1, .1, 1),
                          [=](double time)
                          {
                              const double gap = std::max(least / 2, open - speed * std::max(0., time - .2));
                              return shifted(0, side * (gap + .05), 0);
                          });
    builder.drop({random.within(.4, .9), 0, 0, false});
    builder.world().m_frames = 120;
}

void buildFan(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const TriangleMesh blades = randomBlades(random);
    const double rate = random.within(.5, 12);
    const double speed = rate * (random.chance(.5) ? 1 : -1), tilt = random.within(0, 1.2);
    builder.addMoving(blades, [=](double time)
                      { return turned(btVector3(1, 0, 0), tilt) * turned(btVector3(0, 1, 0), speed * time); });
    builder.drop({random.within(.4, 1.4), 1.05 + builder.lift()});
    builder.world().m_frames = 150;
}

void buildConveyor(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const int cells = 1 + random.below(20);
    const double speed = random.within(.3, 8);
    const WorldObstacle& belt =
        builder.addMoving(gridMesh(cells * 2, cells, 30, 3), [=](double time) { return shifted(speed * time, 0, 0); });
    belt.m_object->setFriction(btScalar(std::max(builder.friction(), .3)));
    builder.addObstacle(boxMesh(.4, .6, 2), shifted(1.1, .31 + 2.5 * builder.thickness(), 0), false);
    builder.drop({random.within(.4, 1.2), .5 + builder.lift()});
    builder.world().m_frames = 100;
}

void buildSpinBox(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    const TriangleMesh box = randomBox(random, {.2, .8});
    const btVector3 axis = random.direction();
    const double speed = random.within(1, 15);
    builder.addMoving(box, [=](double time) { return turned(axis, speed * time); });
    builder.drop({random.within(.5, 1.6), .95 + builder.lift()});
    builder.world().m_frames = 120;
}

void buildDrawer(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    builder.addFloor(-.5, 5);
    const double speed = random.logWithin(.5, 50);
    builder.addMoving(boxMesh(1.5, .03, 1.5),
                      [=](double time) { return shifted(std::min(6., speed * std::max(0., time - .7)), 0, 0); });
    builder.drop({random.within(.5, 1.6), .6 + builder.lift()});
    builder.world().m_frames = 100;
}
}  // namespace drape::test
