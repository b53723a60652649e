#include "benchmarks/compare_solvers/link_scene.h"

#include <cmath>

#include <BulletSoftBody/btSoftBodyHelpers.h>

namespace drape::bench
{
namespace
{
using Body = std::unique_ptr<btSoftBody>;

constexpr btScalar kSide = 2;  // m

// Makes a cloth of 1 kg. `down` is the direction of its columns.
Body makeCloth(btSoftBodyWorldInfo& info, int nodes, const btVector3& down)
{
    const btVector3 first(-kSide / 2, 0, 0), last(kSide / 2, 0, 0);
    Body body(btSoftBodyHelpers::CreatePatch(info, first, last, first + kSide * down, last + kSide * down, nodes, nodes,
                                             0, true));
    body->setTotalMass(1);
    return body;
}

void pin(btSoftBody& body, int node)
{
    body.setMass(node, 0);
}

// The first row of nodes is at the top of the cloth.
Body makeHanging(btSoftBodyWorldInfo& info, int nodes)
{
    Body body = makeCloth(info, nodes, btVector3(0, 0, 1));
    pin(*body, 0);
    pin(*body, nodes - 1);
    return body;
}

// Holds the cloth as a round table would, without one.
Body makeTablecloth(btSoftBodyWorldInfo& info, int nodes)
{
    Body body = makeCloth(info, nodes, btVector3(0, 0, 1));
    for (int i = 0; i < nodes * nodes; ++i)
    {
        const btVector3& place = body->m_nodes[i].m_x;
        if (std::max(btFabs(place.x()), btFabs(place.z() - kSide / 2)) < kSide / 8) pin(*body, i);
    }
    return body;
}

// The middle of the trampoline is thrown down.
Body makeTrampoline(btSoftBodyWorldInfo& info, int nodes)
{
    Body body = makeCloth(info, nodes, btVector3(0, 0, 1));
    for (int i = 0; i < nodes * nodes; ++i)
    {
        const int row = i / nodes, column = i % nodes;
        if (row == 0 || column == 0 || row == nodes - 1 || column == nodes - 1) pin(*body, i);
        const btVector3 fromMiddle = body->m_nodes[i].m_x - btVector3(0, 0, kSide / 2);
        if (fromMiddle.length() < kSide / 8) body->m_nodes[i].m_v.setValue(0, -5, 0);
    }
    return body;
}

Body makeRope(btSoftBodyWorldInfo& info, int nodes)
{
    Body body(btSoftBodyHelpers::CreateRope(info, btVector3(0, 0, 0), btVector3(kSide, 0, 0), nodes - 2, 1));
    body->setTotalMass(1);
    pin(*body, 0);
    return body;
}

// The flag is pinned at one side, and the wind blows along it and a little across.
Body makeFlag(btSoftBodyWorldInfo& info, int nodes)
{
    Body body = makeCloth(info, nodes, btVector3(0, -1, 0));
    for (int row = 0; row < nodes; ++row)
        pin(*body, row * nodes);
    body->m_cfg.aeromodel = btSoftBody::eAeroModel::V_TwoSided;
    body->m_cfg.kDG = btScalar(0.02);
    body->m_cfg.kLF = btScalar(0.01);
    body->setWindVelocity(btVector3(5, 0, 2));
    return body;
}

Body makeCape(btSoftBodyWorldInfo& info, int nodes)
{
    Body body = makeCloth(info, nodes, btVector3(0, -1, 0));
    for (int column = 0; column < nodes; ++column)
        pin(*body, column);
    return body;
}

// Swings the shoulders to and fro by half a metre in two seconds.
void driveCape(btSoftBody& cape, int nodes, double time)
{
    const btScalar way = btScalar(0.25 * (1 - std::cos(3.14159265 * time)));
    for (int column = 0; column < nodes; ++column)
        cape.m_nodes[column].m_x.setZ(way);
}
}  // namespace

const std::vector<LinkScene>& linkScenes()
{
    static const std::vector<LinkScene> scenes = {{"hanging", makeHanging, nullptr, true, 13, 33},
                                                  {"tablecloth", makeTablecloth, nullptr, true, 13, 33},
                                                  {"trampoline", makeTrampoline, nullptr, true, 13, 33},
                                                  {"rope", makeRope, nullptr, true, 13, 41},
                                                  {"flag", makeFlag, nullptr, false, 13, 33},
                                                  {"cape", makeCape, driveCape, false, 13, 33}};
    return scenes;
}
}  // namespace drape::bench
