#include "drape/soft_body_solver.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/body_solver.h"
#include "bullet_plugin/adapter/collision_step.h"
#include "bullet_plugin/adapter/plugin_state.h"
#include "bullet_plugin/adapter/stopwatch.h"

namespace drape
{
namespace
{
bool finite(const btVector3& v)
{
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

// Widens the bounds, which the broad phase reads next, to the whole motion of the step plus the reach of a contact.
// Bullet's own bounds come from the node tree of the step before and lag behind fast cloth, which then has no pair when
// it needs one.
void coverMotion(btSoftBody& body, btScalar reach)
{
    btVector3 low(SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY), high = -low;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = body.m_nodes[i];
        if (!finite(node.m_x) || !finite(node.m_q)) continue;
        low.setMin(node.m_x);
        low.setMin(node.m_q);
        high.setMax(node.m_x);
        high.setMax(node.m_q);
    }
    if (low.x() > high.x()) return;
    const btVector3 margin(reach, reach, reach);
    body.m_bounds[0].setMin(low - margin);
    body.m_bounds[1].setMax(high + margin);
}

}  // namespace

// What is kept from step to step.
struct SoftBodySolver::Work
{
    explicit Work(PluginState& state) : m_step(state) {}

    CollisionStep m_step;
    ContactRounds m_rounds;
    double m_predictMs = 0;  // of this class's share in predictMotion
};

SoftBodySolver::SoftBodySolver(Plugin& plugin) : m_state(plugin.state()), m_work(new Work(*m_state))
{
    m_state->addSolver(this);
}

SoftBodySolver::~SoftBodySolver()
{
    m_state->removeSolver(this);
}

void SoftBodySolver::predictMotion(btScalar dt)
{
    m_state->dropNotes(this);  // of a dispatch that no solve followed
    btDefaultSoftBodySolver::predictMotion(dt);
    if (!m_state->ready()) return;
    Stopwatch watch;
    // The mesh's own bounds hold its margin; the activation distance beyond the thickness is shared out alike.
    const btScalar reach = 1 + btScalar(m_state->settings().m_activation);
    for (int i = 0; i < m_softBodySet.size(); ++i)
        if (m_softBodySet[i]->isActive())
            coverMotion(*m_softBodySet[i], reach * m_softBodySet[i]->getCollisionShape()->getMargin());
    m_work->m_predictMs = watch.lapMs();
}

void SoftBodySolver::detect()
{
    m_work->m_step.clear();
    if (!m_state->ready()) return;
    try
    {
        StepStatistics& statistics = m_state->m_statistics;
        Stopwatch watch;
        m_work->m_step.begin(m_state->takeNotes(this));
        const double beginMs = watch.lapMs();
        m_work->m_step.finish();
        statistics.m_uploadMs = m_work->m_predictMs + beginMs;
        statistics.m_writeMs = watch.lapMs() - statistics.m_waitMs;
    }
    catch (const std::exception& exception)
    {
        m_work->m_step.clear();
        m_state->fail("drape::SoftBodySolver::solveConstraints", exception.what());
    }
}

// Returns the time of Bullet's part, ms.
double SoftBodySolver::solveBodies()
{
    double bulletMs = 0;
    for (int i = 0; i < m_softBodySet.size(); ++i)
    {
        btSoftBody* body = m_softBodySet[i];
        if (!body->isActive()) continue;
        if (const BodyContacts* contacts = m_work->m_step.contactsOf(*body))
        {
            bulletMs += solveBody(*contacts, m_state->m_found, m_work->m_rounds);
            continue;
        }
        Stopwatch watch;
        body->solveConstraints();
        bulletMs += watch.lapMs();
    }
    return bulletMs;
}

void SoftBodySolver::checkStrayed()
{
    try
    {
        m_work->m_step.checkStrayed();
    }
    catch (const std::exception& exception)
    {
        m_state->fail("drape::SoftBodySolver::solveConstraints", exception.what());
    }
}

void SoftBodySolver::solveConstraints(btScalar)
{
    detect();
    StepStatistics& statistics = m_state->m_statistics;
    const double waitMs = statistics.m_waitMs;
    Stopwatch watch;
    const double bulletMs = solveBodies();
    checkStrayed();
    statistics.m_finishMs = watch.lapMs() - bulletMs - (statistics.m_waitMs - waitMs);
}
}  // namespace drape
