#include <algorithm>

#include "tests/worlds/families.h"

namespace drape::test
{
namespace
{
// Pins nothing, two or four corners, or the border.
void pin(WorldRandom& random, btSoftBody& body, int nodesX, int nodesZ)
{
    const int how = random.below(4);
    for (int j = 0; j < nodesZ; ++j)
        for (int i = 0; i < nodesX; ++i)
        {
            const bool sideX = i == 0 || i == nodesX - 1, sideZ = j == 0 || j == nodesZ - 1;
            const bool isPinned =
                (how == 1 && sideX && j == 0) || (how == 2 && sideX && sideZ) || (how == 3 && (sideX || sideZ));
            if (isPinned) body.setMass(j * nodesX + i, 0);
        }
}

void addLoad(WorldBuilder& builder, double height)
{
    WorldRandom& random = builder.random();
    LoadSpec spec;
    spec.m_isBox = random.chance(.5);
    const TriangleMesh mesh = spec.m_isBox ? randomBox(random, {.1, .5}) : randomBlob(random, {.08, .3}, 8, 6, .3);
    spec.m_mass = random.logWithin(.01, 50);
    spec.m_friction = builder.friction();
    spec.m_pose = builder.randomPose({-3, 3}, {-.3, .3}, height, {-.3, .3});
    if (random.chance(.5))
    {
        spec.m_velocity = random.direction() * btScalar(random.logWithin(.1, 15));
        spec.m_velocity.setY(-btFabs(spec.m_velocity.y()));
        spec.m_spin = random.direction() * btScalar(random.logWithin(.1, 20));
    }
    builder.world().addLoad(mesh, spec);
}
}  // namespace

void buildLoads(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    builder.addFloor(-1.5, 8);
    const int nodesX = 6 + random.below(14), nodesZ = 6 + random.below(14);
    const double sizeX = random.within(.6, 2), sizeZ = random.within(.6, 2);
    btSoftBody& body = *builder.world().addGrid({nodesX, nodesZ, sizeX, sizeZ, shifted(0, 0, 0)}).m_body;
    body.setTotalMass(btScalar(random.logWithin(.1, 10)));
    builder.style(body, false);
    pin(random, body, nodesX, nodesZ);
    const int loads = 1 + random.below(3);
    for (int i = 0; i < loads; ++i)
        addLoad(builder, .65 + builder.lift() + i * 1.2);
    builder.world().m_frames = 120;
}
}  // namespace drape::test
