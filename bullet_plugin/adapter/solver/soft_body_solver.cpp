#include "drape/soft_body_solver.h"

#include <algorithm>

#include "bullet_plugin/adapter/solver/body_jobs.h"
#include "bullet_plugin/adapter/solver/body_nodes.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/motion/bounds_guard.h"
#include "bullet_plugin/adapter/motion/motion_bounds.h"
#include "bullet_plugin/adapter/solver/solver_work.h"
#include "bullet_plugin/core/float_environment.h"
#include "bullet_plugin/core/public_call.h"
#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
namespace
{
// Returns the number of elements that the step's memory is proportional to.
std::size_t elementsOf(const StepStatistics& step)
{
    return step.m_clothTriangles + step.m_obstacleTriangles + step.m_contacts +
           static_cast<std::size_t>(step.m_candidates);
}

// Ends the body's step at its start, with the velocities that it would have without gravity. Used for cloth with
// unknown contacts: a cloth at rest passes no resting obstacle. Allocates no memory. contacts: null if none are
// known.
void holdStill(btSoftBody& body, const BodyContacts* contacts)
{
    const std::size_t count = static_cast<std::size_t>(body.m_nodes.size());
    const SolverNodes* const nodes = contacts ? &contacts->nodes() : nullptr;
    const btVector3 fall = body.m_worldInfo->m_gravity * body.m_sst.sdt;
    for (std::size_t i = 0; i < count; ++i)
    {
        btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
        if (nodes)
        {
            node.m_v = vectorOf(nodes->pathVector(i)) * body.m_sst.isdt;
            node.m_q = vectorOf(nodes->start(i));
        }
        if (node.m_im > 0) node.m_v -= fall;
        node.m_x = node.m_q;
    }
}
}  // namespace

SoftBodySolver::SoftBodySolver(Plugin& plugin) : m_state(plugin.state())
{
    if (!m_state) return;
    const auto start = [&]
    {
        m_work.reset(new Work(*m_state, *this));
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
    const auto failed = [&](const CaughtException& caught)
    { m_state->fail("drape::SoftBodySolver::predictMotion", caught); };
    std::vector<StepObstacle> obstacles;
    m_work->m_parts = StepParts();
    guarded([&] { beginStep(dt, obstacles); }, failed);
    if (!m_state->ready()) return btDefaultSoftBodySolver::predictMotion(dt);
    Stopwatch watch;
    m_work->predict(m_softBodySet, dt);
    m_work->m_parts.m_predictMs = watch.lapMs();
    guarded([&] { coverMotions(*m_state, m_work->m_taken, obstacles, m_state->threads()); }, failed);
    m_work->m_parts.m_mirrorMs += watch.lapMs();
}

// Leaves bodies to Bullet for this step that changed since the prediction, or that touch what Bullet's own algorithms
// handle.
void SoftBodySolver::leaveToBullet()
{
    std::vector<unsigned char> leaving(static_cast<std::size_t>(m_softBodySet.size()));
    const auto sizeOf = [this](std::size_t i)
    {
        const btSoftBody& body = *m_softBodySet[int(i)];
        return m_work->substepsOf(body) ? static_cast<std::size_t>(body.m_nodes.size()) : 0;
    };
    const auto check = [&](std::size_t i, ThreadTeam* threads)
    {
        const btSoftBody& body = *m_softBodySet[int(i)];
        leaving[i] = !m_work->substepsOf(body)->canSolveNow(body, threads);
    };
    forBodies(leaving.size(), m_state->threads(), sizeOf, check);
    for (std::size_t i = 0; i < leaving.size(); ++i)
    {
        if (!leaving[i]) continue;
        btSoftBody& body = *m_softBodySet[int(i)];
        if (m_state->m_kept.stepOf(body)) m_work->bringToHost(body);
        m_work->substepsOf(body)->leave(body);
    }
}

// Finds the contacts of the step.
void SoftBodySolver::detect()
{
    Work& work = *m_work;
    if (!m_state->ready()) return work.m_step.reset();
    m_state->restart();
    chooseStage();
    if (!work.m_step) work.m_step = std::make_unique<CollisionStep>(*m_state);
    CollisionStep& step = *work.m_step;
    StepStatistics& statistics = m_state->m_statistics;
    if (work.m_usage.hasFallen(elementsOf(statistics))) work.giveBackRoom(*m_state);
    Stopwatch watch;
    step.begin(m_state->takeNotes(this, work.m_predicted), [&work](btSoftBody& body) { work.bringToHost(body); });
    work.bringFreeToHost(m_softBodySet);
    work.m_parts.m_mirrorMs += watch.lapMs();
    const bool follows = work.m_stage && work.mayFollow();
    if (!follows) work.bringAllToHost(m_softBodySet);
    step.submit(follows ? ContactPlace::Device : ContactPlace::Host);
    const double uploadMs = step.uploadMs();
    watch.lapMs();
    const bool submitted = follows && work.submitBehind(m_softBodySet, m_state->m_found.source());
    work.m_parts.m_readMs += watch.lapMs();
    const auto takeSolved = [&work](bool hasWaited)
    { work.m_onDevice = work.m_solver->finishBehind(*work.m_stage, hasWaited); };
    step.finish(submitted ? [&takeSolved] { takeSolved(true); } : CollisionStep::TakeSolved());
    if (submitted && !step.hasPairs()) takeSolved(false);
    if (submitted)
        work.bringUnsolvedToHost(m_softBodySet);
    else
        work.bringAllToHost(m_softBodySet);
    for (int i = 0; i < m_softBodySet.size(); ++i)
        step.reportInvalid(*m_softBodySet[i]);
    work.m_detected = true;
    statistics.m_clothsSkipped = work.m_asleep + step.pinnedCloths();
    work.m_parts.m_writeMs = watch.lapMs() - statistics.m_waitMs - (step.uploadMs() - uploadMs);
}

// Sets the stage that solves this step's cloths.
void SoftBodySolver::chooseStage()
{
    std::size_t nodes = 0;
    for (int i = 0; i < m_softBodySet.size(); ++i)
        nodes += m_work->substepNodes(*m_softBodySet[i]);
    if (m_state->m_kept.anyBegun()) nodes = SIZE_MAX;  // wherever others would be solved
    if (nodes > 0) m_work->m_stage = m_state->pipeline().solveStage(nodes);
}

// Solves the bodies that the device has not solved behind the detection, and writes all results back.
void SoftBodySolver::solveBodies(StepParts& parts)
{
    Work& work = *m_work;
    work.m_bulletLinks.clear();
    work.m_solved.assign(static_cast<std::size_t>(m_softBodySet.size()), 0);
    Stopwatch watch;
    work.takeSubsteps(m_softBodySet);
    work.takeBulletsBodies(m_softBodySet);
    parts.m_readMs += watch.lapMs();
    if (work.solveByBullet(m_softBodySet)) parts.m_bulletMs += watch.lapMs();
    // The host solves what the device has refused.
    m_state->m_statistics.m_clothsSolvedOnDevice =
        work.m_onDevice + work.m_solver->solve(work.m_touched, work.m_free, m_state->m_found.source(),
                                               work.m_onDevice > 0 ? nullptr : work.m_stage);
    double linksMs = 0;
    for (const std::unique_ptr<BulletLinks>& links : work.m_bulletLinks)
        linksMs += links->ms();
    parts.m_solveMs = watch.lapMs() - linksMs;
    parts.m_bulletMs += linksMs;
    forBodies(
        work.m_ends.size(), m_state->threads(), [&](std::size_t i) { return work.m_ends[i].second->count(); },
        [&](std::size_t i, ThreadTeam* threads)
        { SubstepBody::end(*work.m_ends[i].second, *work.m_ends[i].first, threads); });
    for (int i = 0; i < m_softBodySet.size(); ++i)
    {
        btSoftBody& body = *m_softBodySet[i];
        if (!work.isSteppedBody(body) || m_state->m_kept.stepOf(body)) continue;
        if (holdInBounds(*m_state, body, work.contactsOf(body))) m_state->m_statistics.m_status |= kStepMotionHeldBack;
    }
    work.m_rigidBodies.applyImpulses();
    parts.m_writeBackMs = watch.lapMs();
}

// Keeps bodies that strayed from their predicted paths at their distance from what is near their real ones. A body that
// would pass a surface on the way goes back to where it was checked.
void SoftBodySolver::closeOffPath(const std::vector<BodyContacts*>& bodies)
{
    if (bodies.empty()) return;
    std::vector<SolverCloth> cloths;
    std::vector<SolverNodes> checked;
    for (BodyContacts* body : bodies)
    {
        cloths.push_back({&body->m_contacts, nullptr, nullptr, nullptr, nullptr});
        checked.push_back(body->nodes());
    }
    m_work->m_solver->close(cloths, m_state->m_found.source());
    for (BodyContacts* body : bodies)
        writeShifted(body->nodes(), *body->m_body);
    m_work->m_step->detectRealPaths();
    for (std::size_t i = 0; i < bodies.size(); ++i)
    {
        if (!m_work->m_step->passesSurface(*bodies[i])) continue;
        for (std::size_t node = 0; node < checked[i].count(); ++node)
            writeNode(checked[i], node, bodies[i]->m_body->m_nodes[int(node)]);
    }
}

void SoftBodySolver::solveStep()
{
    StepParts& parts = m_work->m_parts;
    const std::size_t waits = m_state->ready() ? m_state->pipeline().deviceWaits() : 0;
    Stopwatch watch;
    m_work->m_begun = false;
    m_work->m_onDevice = 0;
    m_work->m_stage = nullptr;
    leaveToBullet();
    parts.m_readMs += watch.lapMs();
    detect();
    solveBodies(parts);
    CollisionStep* const step = m_work->m_step.get();
    if (!step) return;
    StepStatistics& statistics = m_state->m_statistics;
    const double waitMs = statistics.m_waitMs, uploadMs = step->uploadMs();
    watch.lapMs();
    closeOffPath(step->checkOffPath());
    step->reportMeetingDeformed();
    step->end();
    statistics.m_clothsKept = m_work->endKept(m_softBodySet);
    parts.m_uploadMs = step->uploadMs();
    parts.m_checkMs = watch.lapMs() - (statistics.m_waitMs - waitMs) - (parts.m_uploadMs - uploadMs);
    parts.m_waitMs = statistics.m_waitMs;
    parts.m_refitMs = statistics.m_refitMs;
    parts.m_broadMs = statistics.m_broadMs;
    parts.m_narrowMs = statistics.m_narrowMs;
    static_cast<StepParts&>(statistics) = parts;
    const std::size_t all = m_state->pipeline().deviceWaits();
    statistics.m_deviceWaits = all > waits ? all - waits : 0;  // a device may have been opened anew
}

// Ends a step in which an exception was caught: Bullet solves the bodies that Drape does not handle, and Drape's cloths
// stand still. Allocates no memory.
void SoftBodySolver::endFailedStep()
{
    Work& work = *m_work;
    for (int i = 0; i < m_softBodySet.size(); ++i)
    {
        btSoftBody& body = *m_softBodySet[i];
        const SubstepBody* const substeps = work.substepsAt(body);
        const bool isOnDevice = substeps && substeps->isOnDevice();  // its nodes are those of the last step's end
        if (work.isSolved(i) || !work.isSteppedBody(body) || isOnDevice) continue;
        if (handlesSteppedCloth(*m_state, body))
        {
            const BodyContacts* const contacts = work.m_detected ? work.contactsOf(body) : nullptr;
            holdStill(body, contacts && !contacts->m_isOnDevice ? contacts : nullptr);
        }
        else
            drape::solveByBullet(body);
    }
    work.m_step.reset();
    work.m_failures = m_state->failures();
    if (!m_state->ready()) return;
    m_state->m_statistics = StepStatistics();
    m_state->m_statistics.m_status |= kStepOutOfMemory;
    if (m_state->pipeline().deviceFailed()) m_state->m_statistics.m_status |= kStepDeviceFailed;
}

void SoftBodySolver::solveConstraints(btScalar dt)
{
    if (!m_work) return btDefaultSoftBodySolver::solveConstraints(dt);
    const DefaultFloats floats;
    const auto failed = [&](const CaughtException& caught)
    { m_state->fail("drape::SoftBodySolver::solveConstraints", caught); };
    m_work->m_solved.clear();
    m_work->m_detected = false;
    if (m_work->m_failures == m_state->failures()) guarded([&] { solveStep(); }, failed);
    if (m_work->m_failures != m_state->failures()) endFailedStep();
}

// Prepares a body for Bullet's collision with an object, which reads the nodes and their tree. The object may have
// moved since the step began.
void SoftBodySolver::readByBullet(btSoftBody& body, const btCollisionObject& object)
{
    if (!m_work) return;
    const auto failed = [&](const CaughtException& caught)
    { m_state->fail("drape::SoftBodySolver::processCollision", caught); };
    if (m_state->m_kept.stepOf(body) && m_state->m_kept.isRead(body, object))
        guarded([&] { m_work->bringToHost(body); }, failed);
    m_state->updateNodeTree(body);
}

void SoftBodySolver::processCollision(btSoftBody* body, const btCollisionObjectWrapper* obstacle)
{
    readByBullet(*body, *obstacle->getCollisionObject());
    btDefaultSoftBodySolver::processCollision(body, obstacle);
}

void SoftBodySolver::processCollision(btSoftBody* body, btSoftBody* other)
{
    readByBullet(*body, *other);
    readByBullet(*other, *body);
    btDefaultSoftBodySolver::processCollision(body, other);
}

void SoftBodySolver::updateSoftBodies()
{
    Stopwatch watch;
    // Without a state Bullet's function does the same on this thread.
    if (!m_work) return btDefaultSoftBodySolver::updateSoftBodies();
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
