#include "drape/soft_body_solver.h"

#include <algorithm>
#include <exception>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/body_solver.h"
#include "bullet_plugin/adapter/collision_step.h"
#include "bullet_plugin/adapter/eligibility.h"
#include "bullet_plugin/adapter/motion_bounds.h"
#include "bullet_plugin/adapter/plugin_state.h"
#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
namespace
{
// As Bullet does, but that time which runs backwards stands still: Bullet bounds a node's speed by what is negative
// then.
void predict(btSoftBody& body, btScalar dt)
{
    const btScalar timescale = body.m_cfg.timescale;
    const bool passes = dt > 0 && timescale > 0;
    if (!passes) body.m_cfg.timescale = 0;
    body.predictMotion(passes ? dt : btScalar(0));
    body.m_cfg.timescale = timescale;
}
}  // namespace

// What is kept from step to step.
struct SoftBodySolver::Work
{
    explicit Work(PluginState& state) : m_step(state), m_solver(state.threads()) {}

    CollisionStep m_step;
    BodySolver m_solver;
    std::vector<BodyContacts*> m_touched;        // of solveBodies()
    std::vector<btSoftBody*> m_taken;            // bodies that Drape takes, in this step
    std::vector<const btSoftBody*> m_predicted;  // in this step, sorted by address
    std::size_t m_asleep = 0;                    // cloths that are not among them
    double m_predictMs = 0;                      // of this class's share in predictMotion
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
    m_state->setStepped(this, m_softBodySet);
    if (!m_state->ready())
    {
        listPredicted();
        btDefaultSoftBodySolver::predictMotion(dt);
        return;
    }
    Stopwatch watch;
    KinematicMotions& motions = m_state->motionsOf(this);
    listTaken();
    motions.beginStep(dt, [this](const btTransform& map, btScalar slack)
                      { return m_state->movedAlong(m_work->m_taken, map, slack); });
    const std::vector<StepObstacle> obstacles = wakeReached(motions);
    listPredicted();
    m_work->m_predictMs = watch.lapMs();
    for (int i = 0; i < m_softBodySet.size(); ++i)
        if (m_softBodySet[i]->isActive()) predict(*m_softBodySet[i], dt);
    watch.lapMs();
    for (btSoftBody* body : m_work->m_taken)
        if (body->isActive()) coverMotion(*m_state, *body, obstacles);
    m_work->m_predictMs += watch.lapMs();
}

// Lists the bodies that Drape takes.
void SoftBodySolver::listTaken()
{
    m_work->m_taken.clear();
    for (int i = 0; i < m_softBodySet.size(); ++i)
        if (handlesCloth(*m_state, *m_softBodySet[i])) m_work->m_taken.push_back(m_softBodySet[i]);
}

// Wakes those of the bodies taken that a moving obstacle comes to. Returns the obstacles of the step; without those
// that rest where no such body is awake.
std::vector<StepObstacle> SoftBodySolver::wakeReached(KinematicMotions& motions)
{
    const std::vector<btSoftBody*>& taken = m_work->m_taken;
    if (taken.empty()) return {};
    const bool anyAwake =
        std::any_of(taken.begin(), taken.end(), [](const btSoftBody* body) { return body->isActive(); });
    std::vector<StepObstacle> obstacles = stepObstacles(*m_state, *taken[0], motions, anyAwake);
    bool anyWoken = false;
    for (btSoftBody* body : taken)
    {
        if (body->isActive() || !isReached(*m_state, *body, obstacles)) continue;
        body->activate();
        anyWoken = true;
    }
    return anyWoken && !anyAwake ? stepObstacles(*m_state, *taken[0], motions, true) : obstacles;
}

// Bullet's islands and callbacks may wake cloth, or put it to sleep, before it is solved. What was predicted is solved,
// with the contacts along its path; what was not waits for the next step.
void SoftBodySolver::listPredicted()
{
    std::vector<const btSoftBody*>& predicted = m_work->m_predicted;
    predicted.clear();
    for (int i = 0; i < m_softBodySet.size(); ++i)
        if (m_softBodySet[i]->isActive()) predicted.push_back(m_softBodySet[i]);
    std::sort(predicted.begin(), predicted.end());
    m_work->m_asleep = static_cast<std::size_t>(m_softBodySet.size()) - predicted.size();
}

void SoftBodySolver::detect()
{
    m_work->m_step.clear();
    if (!m_state->ready()) return;
    try
    {
        StepStatistics& statistics = m_state->m_statistics;
        Stopwatch watch;
        m_work->m_step.begin(m_state->takeNotes(this, m_work->m_predicted));
        const double beginMs = watch.lapMs();
        m_work->m_step.finish();
        for (int i = 0; i < m_softBodySet.size(); ++i)
            m_work->m_step.reportInvalid(*m_softBodySet[i]);
        statistics.m_clothsSkipped = m_work->m_asleep + m_work->m_step.pinnedCloths();
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
    const std::vector<const btSoftBody*>& predicted = m_work->m_predicted;
    double bulletMs = 0;
    m_work->m_touched.clear();
    for (int i = 0; i < m_softBodySet.size(); ++i)
    {
        btSoftBody* body = m_softBodySet[i];
        // Bullet's links would move the nodes and its velocities are what they moved over the time: not numbers.
        if (!std::binary_search(predicted.begin(), predicted.end(), body) || !(body->m_sst.sdt > 0)) continue;
        if (BodyContacts* contacts = m_work->m_step.contactsOf(*body))
        {
            m_work->m_touched.push_back(contacts);
            continue;
        }
        Stopwatch watch;
        body->solveConstraints();
        bulletMs += watch.lapMs();
    }
    return bulletMs + m_work->m_solver.solve(m_work->m_touched, m_state->m_found);
}

void SoftBodySolver::checkStrayed()
{
    try
    {
        m_work->m_step.checkStrayed();
        m_work->m_step.end();
    }
    catch (const std::exception& exception)
    {
        m_work->m_step.clear();
        m_state->fail("drape::SoftBodySolver::solveConstraints", exception.what());
    }
}

void SoftBodySolver::solveConstraints(btScalar)
{
    detect();
    StepStatistics& statistics = m_state->m_statistics;
    const double waitMs = statistics.m_waitMs;
    Stopwatch watch;
    double bulletMs = 0;
    try
    {
        bulletMs = solveBodies();
    }
    catch (const std::exception& exception)
    {
        m_work->m_step.clear();
        m_state->fail("drape::SoftBodySolver::solveConstraints", exception.what());
    }
    checkStrayed();
    statistics.m_finishMs = watch.lapMs() - bulletMs - (statistics.m_waitMs - waitMs);
}
}  // namespace drape
