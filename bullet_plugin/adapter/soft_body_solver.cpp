#include "drape/soft_body_solver.h"

#include <algorithm>
#include <exception>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/body_solver.h"
#include "bullet_plugin/adapter/collision_step.h"
#include "bullet_plugin/adapter/motion_bounds.h"
#include "bullet_plugin/adapter/plugin_state.h"
#include "bullet_plugin/adapter/stopwatch.h"

namespace drape
{
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
    KinematicMotions& motions = m_state->motionsOf(this);
    motions.beginStep(dt);
    std::vector<MovingObject> moving;  // of one world: a solver has no other
    for (int i = 0; i < m_softBodySet.size(); ++i)
    {
        if (i == 0) moving = movingObjects(*m_softBodySet[i], motions);
        if (m_softBodySet[i]->isActive())
            coverMotion(*m_softBodySet[i], reach * m_softBodySet[i]->getCollisionShape()->getMargin(), moving);
    }
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
