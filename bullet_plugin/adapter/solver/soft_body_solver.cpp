#include "drape/soft_body_solver.h"

#include "LinearMath/btQuickprof.h"
#include "bullet_plugin/adapter/motion/motion_bounds.h"
#include "bullet_plugin/adapter/solver/body_jobs.h"
#include "bullet_plugin/adapter/solver/solver_work.h"
#include "bullet_plugin/core/float_environment.h"
#include "bullet_plugin/core/public_call.h"
#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
SoftBodySolver::SoftBodySolver(Plugin& plugin) : m_state(plugin.state())
{
    if (!m_state) return;
    const auto start = [&]
    {
        m_work.reset(new Work(*m_state, *this, m_softBodySet));
        m_state->addSolver(this);
    };
    guarded(start, [&](const CaughtException&) { m_work.reset(); });
}

SoftBodySolver::~SoftBodySolver()
{
    if (m_work) m_state->removeSolver(this);
}

void SoftBodySolver::predictMotion(btScalar dt)
{
    if (!m_work) return btDefaultSoftBodySolver::predictMotion(dt);
    m_work->m_isIdle = m_work->isIdle();
    if (m_work->m_isIdle) return;
    BT_PROFILE("Drape predictMotion");
    const ThreadWatch::Call call = m_state->beginCall();
    const auto failed = [&](const CaughtException& caught)
    { m_state->fail("drape::SoftBodySolver::predictMotion", caught); };
    std::vector<StepObstacle> obstacles;
    m_work->m_parts = StepParts();
    guarded([&] { m_work->beginStep(dt, obstacles); }, failed);
    if (!m_state->ready()) return btDefaultSoftBodySolver::predictMotion(dt);
    Stopwatch watch(m_work->hasBodies());
    m_work->predict(m_softBodySet, dt);
    m_work->m_parts.m_predictMs = watch.lapMs();
    const auto cover = [&] { coverMotions(*m_state, m_work->m_taken, obstacles, m_state->threads()); };
    if (!obstacles.empty()) guarded(cover, failed);
    m_work->m_parts.m_mirrorMs += watch.lapMs();
}

void SoftBodySolver::solveConstraints(btScalar dt)
{
    if (!m_work) return btDefaultSoftBodySolver::solveConstraints(dt);
    if (m_work->m_isIdle && !m_work->hasBodies()) return;
    BT_PROFILE("Drape solveConstraints");
    const ThreadWatch::Call call = m_state->beginCall();
    const DefaultFloats floats;
    const auto failed = [&](const CaughtException& caught)
    { m_state->fail("drape::SoftBodySolver::solveConstraints", caught); };
    m_work->m_solved.clear();
    m_work->m_detected = false;
    if (m_work->m_failures == m_state->failures()) guarded([&] { m_work->solveStep(); }, failed);
    if (m_work->m_failures != m_state->failures()) return m_work->endFailedStep();
    if (!m_state->ready()) return;
    // Lines for which there is no memory are lost.
    const auto tell = [&]
    {
        m_work->m_log.endStep(m_softBodySet, m_work->m_meetings.any());
        return true;
    };
    guardedOr(false, tell);
}

void SoftBodySolver::processCollision(btSoftBody* body, const btCollisionObjectWrapper* obstacle)
{
    if (m_work) m_work->readByBullet(*body, *obstacle->getCollisionObject());
    btDefaultSoftBodySolver::processCollision(body, obstacle);
}

void SoftBodySolver::processCollision(btSoftBody* body, btSoftBody* other)
{
    if (m_work && m_work->takesPair(*body, *other)) return;
    if (m_work) m_work->readByBullet(*body, *other);
    if (m_work) m_work->readByBullet(*other, *body);
    btDefaultSoftBodySolver::processCollision(body, other);
}

void SoftBodySolver::updateSoftBodies()
{
    Stopwatch watch(m_softBodySet.size() > 0);
    // Bullet's function does the same on this thread if there is no state.
    if (!m_work) return btDefaultSoftBodySolver::updateSoftBodies();
    if (m_softBodySet.size() == 0) return;
    BT_PROFILE("Drape normals");
    const ThreadWatch::Call call = m_state->beginCall();
    const auto isOnHost = [this](const btSoftBody& body)
    { return body.isActive() && !m_state->m_kept.isOnDevice(body); };
    const auto sizeOf = [&](std::size_t i)
    {
        const btSoftBody& body = *m_softBodySet[int(i)];
        return isOnHost(body) ? static_cast<std::size_t>(body.m_nodes.size()) : 0;
    };
    // Normals are written to the body alone, and nothing else is read: integrateMotion() of Bullet 3.24 only calls
    // updateNormals().
    const auto update = [this](std::size_t i, ThreadTeam*)
    {
        m_softBodySet[int(i)]->integrateMotion();
        // The nodes have moved since a pair of the step read the tree.
        NodeTree* const tree = m_work->m_seesReads ? m_state->nodeTreeOf(this, *m_softBodySet[int(i)]) : nullptr;
        if (tree && *tree == NodeTree::Current) *tree = NodeTree::Behind;
    };
    forBodies(static_cast<std::size_t>(m_softBodySet.size()), m_work->m_threads, sizeOf, update);
    m_state->m_statistics.m_normalsMs = watch.lapMs();
}
}  // namespace drape
