#include <algorithm>
#include <utility>

#include <BulletSoftBody/btSoftBodyHelpers.h>

#include "scenes/mesh.h"
#include "tests/worlds/families.h"

namespace drape::test
{
namespace
{
TriangleMesh randomSpikes(WorldRandom& random)
{
    TriangleMesh spikes;
    for (int i = 0; i < 5; ++i)
    {
        const int around = 3 + random.below(6);
        const double height = random.within(0, .2), radius = random.within(.02, .1), aside = random.within(-.1, .1);
        TriangleMesh spike = frustumMesh(radius, -.5, 0, height, around, true);
        shift(spike, .25 * (i - 2), 0, aside);
        append(spikes, spike);
    }
    return spikes;
}

// Makes a rod along x.
TriangleMesh randomRod(WorldRandom& random)
{
    const int around = 3 + random.below(9);
    const double radius0 = random.within(.005, .1), radius1 = random.within(.005, .1);
    TriangleMesh rod = frustumMesh(radius0, -1, radius1, 1, around, true);
    for (std::size_t i = 0; i < rod.m_positions.size(); i += 3)
        std::swap(rod.m_positions[i], rod.m_positions[i + 1]);
    for (std::size_t i = 0; i < rod.m_triangles.size(); i += 3)
        std::swap(rod.m_triangles[i], rod.m_triangles[i + 1]);
    return rod;
}

TriangleMesh randomRing(WorldRandom& random)
{
    const int across = 4 + random.below(10), around = 6 + random.below(20);
    const double tube = random.within(.03, .15), ring = random.within(.2, .5);
    return torusMesh(ring, tube, around, across);
}

// Makes a support to lie on, to be wound around, or a sharp one.
TriangleMesh randomSupport(WorldRandom& random)
{
    switch (random.below(6))
    {
        case 0:
            return gridMesh(20, 20, 5, 5, randomHills(random, {.05, .25}, 9));
        case 1:
            return randomBlob(random, {.2, .5}, 20, 14, .3);
        case 2:
            return randomBox(random, {.05, .8});
        case 3:
            return randomRing(random);
        case 4:
            return randomSpikes(random);
        default:
            return randomRod(random);
    }
}

// Makes a rope that is complete above `height`, across the middle.
std::unique_ptr<btSoftBody> randomRope(WorldBuilder& builder, double height)
{
    WorldRandom& random = builder.random();
    World& world = builder.world();
    const int links = 2 + random.below(40);
    const double length = random.within(.4, 2);
    btVector3 along = random.direction();
    along.setY(btFabs(along.y()) * btScalar(random.chance(.3)));
    along.normalize();
    const btScalar off = btScalar(random.within(-.15, .15)), low = btScalar(height + random.within(0, .3));
    const btVector3 middle(off * along.z(), low + along.y() * btScalar(length / 2), -off * along.x());
    const btVector3 half = along * btScalar(length / 2);
    const int fixedEnds = random.chance(.3) ? 1 + random.below(3) : 0;
    std::unique_ptr<btSoftBody> rope(btSoftBodyHelpers::CreateRope(world.bullet().getWorldInfo(), middle - half,
                                                                   middle + half, links - 1, fixedEnds));
    if (random.chance(.3)) rope->setMass(links / 2, btScalar(random.logWithin(1, 100)));
    if (random.chance(.3)) rope->generateBendingConstraints(2);
    return rope;
}

// Adds a chain of links to every node of one of the cloth's sides.
void addFringe(btSoftBody& cloth, WorldRandom& random)
{
    const int links = 1 + random.below(4), step = 1 + random.below(2), nodes = std::min(8, cloth.m_nodes.size());
    const double length = random.within(.02, .15);
    btVector3 out = random.direction();
    out.setY(btFabs(out.y()));
    for (int i = 0; i < nodes; i += step)
    {
        for (int k = 1; k <= links; ++k)
        {
            cloth.appendNode(cloth.m_nodes[i].m_x + out * btScalar(length * k), 1 / cloth.m_nodes[i].m_im);
            const int last = cloth.m_nodes.size() - 1;
            cloth.appendLink(k == 1 ? i : last - 1, last);
        }
    }
}
}  // namespace

void buildRopes(WorldBuilder& builder)
{
    WorldRandom& random = builder.random();
    World& world = builder.world();
    const TriangleMesh support = randomSupport(random);
    const double top = double(boundsOf(support).m_high[1]) + builder.lift();
    builder.addObstacle(support);
    if (random.chance(.25)) addFringe(builder.drop({.8, top + .25, 4 + random.below(8)}), random);
    const int count = 1 + random.below(4);
    for (int i = 0; i < count; ++i)
    {
        std::unique_ptr<btSoftBody> rope = randomRope(builder, top);
        rope->getCollisionShape()->setMargin(btScalar(world.m_clothMargin));
        rope->m_cfg.piterations = 4;
        rope->m_cfg.kDF = btScalar(builder.friction());
        const btScalar speed = btScalar(random.chance(.4) ? random.logWithin(1, 60) : 0);
        rope->addVelocity(btVector3(0, -speed, 0));
        builder.style(*world.addCloth(std::move(rope)).m_body);
    }
}
}  // namespace drape::test
