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

SoftBodySolver::SoftBodySolver(Plugin& plugin) : m_state(plugin.state())
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
    // The mesh's own bounds hold its margin; the activation distance beyond the thickness is shared out alike.
    const btScalar reach = 1 + btScalar(m_state->settings().m_activation);
    for (int i = 0; i < m_softBodySet.size(); ++i)
        if (m_softBodySet[i]->isActive())
            coverMotion(*m_softBodySet[i], reach * m_softBodySet[i]->getCollisionShape()->getMargin());
}

void SoftBodySolver::solveConstraints(btScalar)
{
    CollisionStep step(*m_state);
    StepStatistics& statistics = m_state->m_statistics;
    try
    {
        if (m_state->ready())
        {
            Stopwatch watch;
            step.begin(m_state->takeNotes(this));
            const double beginMs = watch.lapMs();
            step.finish();
            statistics.m_writeMs = watch.lapMs() - statistics.m_waitMs;
            statistics.m_uploadMs = std::max(statistics.m_uploadMs, beginMs);  // mirrors and copying included
        }
    }
    catch (const std::exception& exception)
    {
        step.bodies().clear();
        m_state->fail("drape::SoftBodySolver::solveConstraints", exception.what());
    }

    for (int i = 0; i < m_softBodySet.size(); ++i)
    {
        btSoftBody* body = m_softBodySet[i];
        if (!body->isActive()) continue;
        if (BodyContacts* contacts = step.contactsOf(*body))
            statistics.m_finishMs += solveBody(*contacts);
        else
            body->solveConstraints();
    }
    try
    {
        step.checkStrayed();
    }
    catch (const std::exception& exception)
    {
        m_state->fail("drape::SoftBodySolver::solveConstraints", exception.what());
    }
}
}  // namespace drape
