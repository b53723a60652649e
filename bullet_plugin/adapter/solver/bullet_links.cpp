#include "bullet_plugin/adapter/solver/bullet_links.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/solver/body_nodes.h"
#include "bullet_plugin/core/float_environment.h"
#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
namespace
{
// Bullet's iterations may be run part by part: those on velocities first, those on positions one by one, those
// against drift last. Each call on positions derives the velocities anew from the step's start, and nothing else in a
// call accumulates. Clusters and joints do accumulate.
bool iterationsCanBeSplit(const btSoftBody& body)
{
    return body.m_clusters.size() == 0 && body.m_joints.size() == 0;
}

// Sets the iterations of one call; the first call is 0. positions: iterations on positions in all calls.
void keepIterationsOf(int call, int positions, btSoftBody::Config& config)
{
    const int velocities = config.viterations > 0 ? 1 : 0;
    if (call >= velocities) config.viterations = 0;
    config.piterations = call >= velocities && call < velocities + positions ? 1 : 0;
    if (call < velocities + positions) config.diterations = 0;
}
}  // namespace

void solveByBullet(btSoftBody& body)
{
    const CallersFloats floats;
    body.solveConstraints();
}

// Returns how many of Bullet's iterations on positions the body gets.
int BulletLinks::positionIterations() const
{
    const int iterations = std::max(0, m_body->m_cfg.piterations);
    return iterations > 0 && m_hasContacts ? std::max(kLeastIterations, iterations) : iterations;
}

int BulletLinks::iterations() const
{
    const btSoftBody::Config& config = m_body->m_cfg;
    if (!iterationsCanBeSplit(*m_body)) return 1;
    return std::max(1, (config.viterations > 0) + positionIterations() + (config.diterations > 0));
}

void BulletLinks::solve(int iteration)
{
    btSoftBody::Config& config = m_body->m_cfg;
    const int velocities = config.viterations, positions = config.piterations, drift = config.diterations;
    if (iterationsCanBeSplit(*m_body)) keepIterationsOf(iteration, positionIterations(), config);
    Stopwatch watch;
    solveByBullet(*m_body);
    m_ms += watch.lapMs();
    config.viterations = velocities;
    config.piterations = positions;
    config.diterations = drift;
}

void BulletLinks::read(SolverNodes& nodes)
{
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        const btSoftBody::Node& node = m_body->m_nodes[int(i)];
        nodes.setCurrent(i, displacementOf(node, nodes, i), vec3Of(node.m_v));
    }
}

void BulletLinks::write(const SolverNodes& nodes)
{
    writeShifted(nodes, *m_body);
}
}  // namespace drape
