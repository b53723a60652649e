#include "drape/soft_body_solver.h"

#include <algorithm>
#include <iterator>
#include <unordered_map>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/adapter/body_jobs.h"
#include "bullet_plugin/adapter/body_nodes.h"
#include "bullet_plugin/adapter/bullet_links.h"
#include "bullet_plugin/adapter/collision_step.h"
#include "bullet_plugin/adapter/eligibility.h"
#include "bullet_plugin/adapter/motion_bounds.h"
#include "bullet_plugin/adapter/plugin_state.h"
#include "bullet_plugin/adapter/prediction.h"
#include "bullet_plugin/adapter/substep_body.h"
#include "bullet_plugin/core/float_environment.h"
#include "bullet_plugin/core/public_call.h"
#include "bullet_plugin/core/solver/step_solver.h"
#include "bullet_plugin/core/stopwatch.h"
#include "bullet_plugin/core/usage_watch.h"

namespace drape
{
namespace
{
// Predicts the motion as Bullet does, but treats a negative time step as zero. Bullet would derive a negative speed
// bound from it.
void predictByBullet(btSoftBody& body, btScalar dt)
{
    const btScalar timescale = body.m_cfg.timescale;
    const bool passes = dt > 0 && timescale > 0;
    if (!passes) body.m_cfg.timescale = 0;
    body.predictMotion(passes ? dt : btScalar(0));
    body.m_cfg.timescale = timescale;
}

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
            node.m_v = vectorOf(nodes->way(i)) * body.m_sst.isdt;
            node.m_q = vectorOf(nodes->start(i));
        }
        if (node.m_im > 0) node.m_v -= fall;
        node.m_x = node.m_q;
    }
}
}  // namespace

// Working data kept from step to step.
struct SoftBodySolver::Work
{
    Work(PluginState& state, const btSoftBodySolver& owner)
        : m_state(state),
          m_owner(owner),
          m_threads(state.threads()),
          m_solver(new StepSolver(m_threads)),
          m_failures(state.failures())
    {
    }

    bool isPredicted(const btSoftBody& body) const
    {
        return m_listed ? std::binary_search(m_predicted.begin(), m_predicted.end(), &body) : body.isActive();
    }
    bool isSolved(int body) const
    {
        const std::size_t at = static_cast<std::size_t>(body);
        return at < m_solved.size() && m_solved[at];
    }
    // Bullet's links would move the nodes of a body without time, and divide by that time: the result is NaN.
    bool isSteppedBody(const btSoftBody& body) const { return isPredicted(body) && body.m_sst.sdt > 0; }
    // Returns the object that solves the body's links in this step, null if Bullet does.
    SubstepBody* substepsOf(const btSoftBody& body) const
    {
        const auto found = m_substeps.find(&body);
        return found != m_substeps.end() && found->second->isPredicted() ? found->second.get() : nullptr;
    }
    // Runs Bullet's solver for the bodies without contacts. Scenes may have thousands of small bodies: the environment
    // changes once for all of them. Returns whether there were any.
    bool solveByBullet(const btAlignedObjectArray<btSoftBody*>& bodies)
    {
        bool any = false;
        const CallersFloats floats;
        for (int i = 0; i < bodies.size(); ++i)
        {
            if (!isSteppedBody(*bodies[i]) || contactsOf(*bodies[i]) || substepsOf(*bodies[i])) continue;
            any = true;
            m_solved[static_cast<std::size_t>(i)] = 1;
            bodies[i]->solveConstraints();
        }
        return any;
    }
    void predict(const btAlignedObjectArray<btSoftBody*>& bodies, btScalar dt);
    SubstepBody* substepsAt(const btSoftBody& body) const;
    template <class Predict>
    void predictOne(btSoftBody& body, ThreadTeam* threads, const Predict& predict);
    void beginAway(const btAlignedObjectArray<btSoftBody*>& bodies);
    template <class Needed>
    void bringHomeWhere(const btAlignedObjectArray<btSoftBody*>& bodies, const Needed& isNeeded);
    void bringHome(btSoftBody& body);
    void bringHomeInStep(btSoftBody& body);
    void bringFreeHome(const btAlignedObjectArray<btSoftBody*>& bodies);
    void bringUnsolvedHome(const btAlignedObjectArray<btSoftBody*>& bodies);
    ClothContacts& clothOf(const btSoftBody& body);
    void bringAllHome(const btAlignedObjectArray<btSoftBody*>& bodies);
    std::size_t endKept(const btAlignedObjectArray<btSoftBody*>& bodies);
    void predictAndLeaveTree(btSoftBody& body, btScalar dt, ThreadTeam* threads);
    bool seesReads(const btAlignedObjectArray<btSoftBody*>& bodies) const;
    std::size_t substepNodes(const btSoftBody& body) const;
    void beginSubsteps(const btAlignedObjectArray<btSoftBody*>& bodies);
    void readPaths(const btAlignedObjectArray<btSoftBody*>& bodies);
    void takeSubsteps(const btAlignedObjectArray<btSoftBody*>& bodies);
    void takeForeign(const btAlignedObjectArray<btSoftBody*>& bodies);
    bool mayFollow(const btAlignedObjectArray<btSoftBody*>& bodies) const;
    bool submitBehind(const btAlignedObjectArray<btSoftBody*>& bodies, const ContactSource& source);
    BodyContacts* contactsOf(const btSoftBody& body) { return m_step ? m_step->contactsOf(body) : nullptr; }

    // Releases memory that only earlier, larger steps needed. Call before a step's begin().
    void giveBackRoom(PluginState& state)
    {
        m_solver.reset(new StepSolver(state.threads()));
        m_step->giveBackRoom();
        state.m_found.clear();
        state.pipeline().giveBackRoom();
    }

    PluginState& m_state;
    const btSoftBodySolver& m_owner;
    ThreadTeam& m_threads;
    btScalar m_dt = 0;                      // s, of the prediction
    std::unique_ptr<CollisionStep> m_step;  // null until it is needed
    std::unique_ptr<StepSolver> m_solver;
    UsageWatch m_usage;
    std::unordered_map<const btSoftBody*, std::unique_ptr<SubstepBody>> m_substeps;  // bodies whose links Drape solves
    std::vector<const btSoftBody*> m_byBullet;  // bodies whose links Bullet solved last, sorted by address
    // Working memory of solveBodies(): bodies with pairs, those among them whose links Bullet solves, and others whose
    // links the core solves.
    std::vector<SolverCloth> m_touched;
    std::vector<std::unique_ptr<BulletLinks>> m_bulletLinks;
    std::vector<SolverCloth> m_free;
    RigidBodies m_rigidBodies;
    std::vector<std::pair<btSoftBody*, const SolverNodes*>> m_ends;  // results to be written to the bodies
    std::vector<unsigned char> m_solved;                             // by body: solved by Bullet or by its contacts
    std::vector<btSoftBody*> m_taken;                                // bodies that Drape handles in this step
    std::vector<const btSoftBody*> m_predicted;                      // in this step, sorted by address
    bool m_listed = false;                                           // m_predicted is whole
    bool m_seesReads = false;                                        // see seesReads(), in this step
    bool m_detected = false;                                         // the paths of all bodies with a pair are recorded
    bool m_begun = false;                                            // beginSubsteps() was called in this step
    std::size_t m_onDevice = 0;                                      // cloths solved behind the detection
    SolveStage* m_stage = nullptr;                                   // solves this step's cloths; null: the host does
    std::size_t m_asleep = 0;                                        // cloths that are not among them
    StepParts m_parts;                                               // parts of the running step, without its waits
    std::uint64_t m_failures;  // failures of the state that a step of this solver has reported
};

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

SubstepBody* SoftBodySolver::Work::substepsAt(const btSoftBody& body) const
{
    const auto found = m_substeps.find(&body);
    return found == m_substeps.end() ? nullptr : found->second.get();
}

template <class Predict>
void SoftBodySolver::Work::predictOne(btSoftBody& body, ThreadTeam* threads, const Predict& predict)
{
    SubstepBody* const substeps = substepsAt(body);
    if (substeps) substeps->beforePrediction(body, threads);
    predict(body);
    if (substeps) substeps->afterPrediction(body, threads);
}

// Begins the steps of bodies whose nodes are on the device, or gives them the nodes of the last step's end.
void SoftBodySolver::Work::beginAway(const btAlignedObjectArray<btSoftBody*>& bodies)
{
    if (!m_state.m_kept.any()) return;
    const auto isAway = [&](int i) { return bodies[i]->isActive() && m_state.m_kept.isAway(*bodies[i]); };
    for (int i = 0; i < bodies.size(); ++i)
    {
        if (!isAway(i)) continue;
        SubstepBody* const substeps = substepsAt(*bodies[i]);
        if (substeps && m_state.m_kept.begin(*bodies[i], m_dt))
            substeps->predictAway();
        else
            m_state.m_kept.callHome(*bodies[i]);
    }
    for (int i = 0; i < bodies.size(); ++i)
        if (isAway(i) && !m_state.m_kept.stepOf(*bodies[i])) m_state.bringHome(*bodies[i]);
}

// Brings a body home whose step has begun without its nodes, and predicts them. The broad phase keeps the bounds.
void SoftBodySolver::Work::bringHome(btSoftBody& body)
{
    m_state.bringHome(body);
    const btVector3 bounds[2] = {body.m_bounds[0], body.m_bounds[1]};
    predictOne(body, &m_threads, [this](btSoftBody& plain) { predictAndLeaveTree(plain, m_dt, &m_threads); });
    std::copy(bounds, bounds + 2, body.m_bounds);
}

// Returns whether Bullet's collision reads the node trees through this solver alone.
bool SoftBodySolver::Work::seesReads(const btAlignedObjectArray<btSoftBody*>& bodies) const
{
    for (int i = 0; i < bodies.size(); ++i)
        if (bodies[i]->getSoftBodySolver() != &m_owner) return false;
    return true;
}

// Predicts the body, and updates its node tree unless that can wait until something reads it.
void SoftBodySolver::Work::predictAndLeaveTree(btSoftBody& body, btScalar dt, ThreadTeam* threads)
{
    predictPlain(body, dt, threads);
    NodeTree* const tree = m_state.nodeTreeOf(&m_owner, body);
    if (tree) *tree = m_seesReads ? NodeTree::Behind : NodeTree::Current;
    if (!tree || !m_seesReads) updateNodeTree(body, threads);
}

// Predicts the bodies, plain ones side by side, and keeps what substeps need of the step's start. Bullet predicts the
// others on this thread: its function may allocate memory and call the app. The broad phase gets all bounds in the
// order of the bodies. Allocates no memory.
void SoftBodySolver::Work::predict(const btAlignedObjectArray<btSoftBody*>& bodies, btScalar dt)
{
    m_dt = dt;
    m_seesReads = seesReads(bodies);
    beginAway(bodies);
    const auto isAway = [this](const btSoftBody& body) { return m_state.m_kept.isAway(body); };
    const auto isPlainAt = [&](int i)
    { return bodies[i]->isActive() && !isAway(*bodies[i]) && isPlain(*bodies[i], dt); };
    const auto sizeOf = [&](std::size_t i)
    { return isPlainAt(int(i)) ? static_cast<std::size_t>(bodies[int(i)]->m_nodes.size()) : 0; };
    const auto predictAt = [&](std::size_t i, ThreadTeam* threads)
    { predictOne(*bodies[int(i)], threads, [&](btSoftBody& body) { predictAndLeaveTree(body, dt, threads); }); };
    const auto byBullet = [&](btSoftBody& body)
    {
        if (NodeTree* const tree = m_state.nodeTreeOf(&m_owner, body)) *tree = NodeTree::Bullets;
        predictByBullet(body, dt);
    };
    // Trees of bodies that sleep are read, too.
    for (int i = 0; i < bodies.size() && !m_seesReads; ++i)
        m_state.updateNodeTree(*bodies[i]);
    forBodies(static_cast<std::size_t>(bodies.size()), m_threads, sizeOf, predictAt);
    for (int i = 0; i < bodies.size(); ++i)
    {
        if (!bodies[i]->isActive()) continue;
        if (isPlainAt(i) || isAway(*bodies[i]))
            updateBroadphase(*bodies[i]);
        else
            predictOne(*bodies[i], nullptr, byBullet);
    }
}

// Runs the part of predictMotion() before the prediction.
void SoftBodySolver::beginStep(btScalar dt, std::vector<StepObstacle>& obstacles)
{
    m_work->m_listed = false;
    m_work->m_taken.clear();
    m_state->dropNotes(this);  // notes of a dispatch that no solve followed
    m_state->setStepped(this, m_softBodySet);
    if (!m_state->ready()) return listPredicted();
    m_state->m_kept.forgetRemoved(this, m_softBodySet);
    Stopwatch watch;
    KinematicMotions& motions = m_state->motionsOf(this);
    listTaken();
    motions.beginStep(dt, [this](const btCollisionObject& object, const btTransform& map, btScalar slack)
                      { return m_state->movedAlong(m_work->m_taken, object, map, slack); });
    obstacles = wakeReached(motions);
    listPredicted();
    m_work->m_parts.m_mirrorMs = watch.lapMs();
    reserveSubsteps();
    m_work->m_parts.m_readMs = watch.lapMs();
}

// Prepares the bodies whose links Drape solves in the coming step, and forgets all others.
void SoftBodySolver::reserveSubsteps()
{
    auto& all = m_work->m_substeps;
    std::size_t solved = 0;
    const std::vector<const btSoftBody*> before = std::move(m_work->m_byBullet);
    std::vector<const btSoftBody*>& byBullet = m_work->m_byBullet;
    byBullet.clear();
    for (int i = 0; i < m_softBodySet.size(); ++i)
    {
        const btSoftBody& body = *m_softBodySet[i];
        auto at = all.find(&body);
        const bool wasByBullet = std::binary_search(before.begin(), before.end(), &body);
        // Sleeping bodies are not examined: a world at rest may have thousands.
        const bool isSolved = body.isActive() ? !reasonFromSettings(*m_state, body) : at != all.end();
        if (isSolved && at == all.end())
        {
            at = all.emplace(&body, std::make_unique<SubstepBody>()).first;
            if (wasByBullet) at->second->changeOver();
        }
        if (isSolved)
        {
            at->second->reserve(body);
            ++solved;
        }
        else
        {
            if (body.isActive() || wasByBullet) byBullet.push_back(&body);
            if (at != all.end()) all.erase(at);
        }
    }
    std::sort(byBullet.begin(), byBullet.end());
    if (solved < all.size()) forgetRemoved();
}

// Forgets bodies that are not in the world any more.
void SoftBodySolver::forgetRemoved()
{
    std::vector<const btSoftBody*> bodies;
    for (int i = 0; i < m_softBodySet.size(); ++i)
        bodies.push_back(m_softBodySet[i]);
    std::sort(bodies.begin(), bodies.end());
    auto& all = m_work->m_substeps;
    for (auto at = all.begin(); at != all.end();)
        at = std::binary_search(bodies.begin(), bodies.end(), at->first) ? std::next(at) : all.erase(at);
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
        if (m_state->m_kept.stepOf(body)) m_work->bringHome(body);
        m_work->substepsOf(body)->leave(body);
    }
}

// Lists the bodies that Drape takes.
void SoftBodySolver::listTaken()
{
    m_work->m_taken.clear();
    for (int i = 0; i < m_softBodySet.size(); ++i)
        if (handlesCloth(*m_state, *m_softBodySet[i])) m_work->m_taken.push_back(m_softBodySet[i]);
}

// Wakes bodies that a moving obstacle reaches. Returns the obstacles of the step, without resting ones if no such
// body is awake.
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

// Lists the bodies that were predicted. Bullet's islands and callbacks may wake cloth, or put it to sleep, before it
// is solved. Predicted bodies are solved with the contacts along their paths; others wait for the next step.
void SoftBodySolver::listPredicted()
{
    std::vector<const btSoftBody*>& predicted = m_work->m_predicted;
    predicted.clear();
    for (int i = 0; i < m_softBodySet.size(); ++i)
        if (m_softBodySet[i]->isActive()) predicted.push_back(m_softBodySet[i]);
    std::sort(predicted.begin(), predicted.end());
    m_work->m_listed = true;
    m_work->m_asleep = static_cast<std::size_t>(m_softBodySet.size()) - predicted.size();
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
    step.begin(m_state->takeNotes(this, work.m_predicted), [&work](btSoftBody& body) { work.bringHome(body); });
    work.bringFreeHome(m_softBodySet);
    work.m_parts.m_mirrorMs += watch.lapMs();
    const bool follows = work.m_stage && work.mayFollow(m_softBodySet);
    if (!follows) work.bringAllHome(m_softBodySet);
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
        work.bringUnsolvedHome(m_softBodySet);
    else
        work.bringAllHome(m_softBodySet);
    for (int i = 0; i < m_softBodySet.size(); ++i)
        step.reportInvalid(*m_softBodySet[i]);
    work.m_detected = true;
    statistics.m_clothsSkipped = work.m_asleep + step.pinnedCloths();
    work.m_parts.m_writeMs = watch.lapMs() - statistics.m_waitMs - (step.uploadMs() - uploadMs);
}

// Returns the number of nodes of a body whose links the core solves in this step; 0 for others.
std::size_t SoftBodySolver::Work::substepNodes(const btSoftBody& body) const
{
    return isSteppedBody(body) && substepsOf(body) ? static_cast<std::size_t>(body.m_nodes.size()) : 0;
}

// Prepares the steps of all bodies whose links the core solves.
void SoftBodySolver::Work::beginSubsteps(const btAlignedObjectArray<btSoftBody*>& bodies)
{
    m_begun = true;
    const auto begin = [&](std::size_t i, ThreadTeam* threads)
    {
        const btSoftBody& body = *bodies[int(i)];
        BodyContacts* const contacts = contactsOf(body);
        substepsOf(body)->begin(body, contacts ? &contacts->m_contacts : nullptr, m_state.mirrorOf(body), threads);
    };
    forBodies(
        static_cast<std::size_t>(bodies.size()), m_threads,
        [&](std::size_t i) { return substepNodes(*bodies[int(i)]); }, begin);
}

// Reads the paths of these bodies.
void SoftBodySolver::Work::readPaths(const btAlignedObjectArray<btSoftBody*>& bodies)
{
    const auto read = [&](std::size_t i, ThreadTeam* threads)
    {
        const btSoftBody& body = *bodies[int(i)];
        BodyContacts* const contacts = contactsOf(body);
        if (clothOf(body).m_isSolved) return;
        substepsOf(body)->readPaths(body, contacts ? &contacts->m_contacts : nullptr, threads);
    };
    forBodies(
        static_cast<std::size_t>(bodies.size()), m_threads,
        [&](std::size_t i) { return substepNodes(*bodies[int(i)]); }, read);
}

// Returns the cloth of a body whose links the core solves.
ClothContacts& SoftBodySolver::Work::clothOf(const btSoftBody& body)
{
    BodyContacts* const contacts = contactsOf(body);
    return contacts ? contacts->m_contacts : substepsOf(body)->alone();
}

// Hands the bodies whose links the core solves to the solver, with their paths, unless they are solved.
void SoftBodySolver::Work::takeSubsteps(const btAlignedObjectArray<btSoftBody*>& bodies)
{
    m_touched.clear();
    m_free.clear();
    m_ends.clear();
    m_rigidBodies.clear();
    if (!m_begun) beginSubsteps(bodies);
    readPaths(bodies);
    for (int i = 0; i < bodies.size(); ++i)
    {
        btSoftBody& body = *bodies[i];
        if (substepNodes(body) == 0) continue;
        const KeptStep* const kept = m_state.m_kept.stepOf(body);
        SubstepBody& substeps = *substepsOf(body);
        ClothContacts& cloth = clothOf(body);
        if (!kept) m_ends.emplace_back(&body, &cloth.m_nodes);
        if (cloth.m_isSolved) continue;
        substeps.addRows(body, cloth.m_nodes, m_rigidBodies);
        const bool isFree = !contactsOf(body) && !substeps.rigidRows();
        (isFree ? m_free : m_touched).push_back({&cloth, &substeps.substeps(), nullptr, substeps.rigidRows(), kept});
    }
}

// Hands the bodies with a pair whose links Bullet solves to the solver.
void SoftBodySolver::Work::takeForeign(const btAlignedObjectArray<btSoftBody*>& bodies)
{
    m_bulletLinks.clear();
    for (int i = 0; i < bodies.size(); ++i)
    {
        btSoftBody& body = *bodies[i];
        BodyContacts* const contacts = contactsOf(body);
        if (!contacts || !isSteppedBody(body) || substepsOf(body)) continue;
        m_bulletLinks.emplace_back(new BulletLinks(body, !contacts->m_contacts.m_features.empty()));
        m_touched.push_back({&contacts->m_contacts, nullptr, m_bulletLinks.back().get(), nullptr, nullptr});
    }
}

// Returns whether the device may solve the step behind the detection, whose contacts then stay there: it is likely to
// solve all bodies with a pair. A path that meets a surface has to end there before.
bool SoftBodySolver::Work::mayFollow(const btAlignedObjectArray<btSoftBody*>& bodies) const
{
    if (!m_stage || m_step->neededHost() || !(m_step->hasPairs() || m_state.m_kept.anyBegun())) return false;
    const auto fits = [this](const BodyContacts& body)
    { return substepNodes(*body.m_body) > 0 && !body.m_contacts.m_isFiltered && !body.m_hasDeformedPair; };
    const auto isRigid = [](const btSoftBody* body)
    { return body->m_rcontacts.size() > 0 || body->m_anchors.size() > 0; };
    return std::all_of(m_step->bodies().begin(), m_step->bodies().end(), fits) &&
           std::none_of(&bodies[0], &bodies[0] + bodies.size(), isRigid);
}

// Brings bodies home whose step has begun away and for which isNeeded(body) is true, with one wait.
template <class Needed>
void SoftBodySolver::Work::bringHomeWhere(const btAlignedObjectArray<btSoftBody*>& bodies, const Needed& isNeeded)
{
    if (!m_state.m_kept.any()) return;
    std::vector<btSoftBody*> called;
    for (int i = 0; i < bodies.size(); ++i)
    {
        if (!m_state.m_kept.stepOf(*bodies[i]) || !isNeeded(*bodies[i])) continue;
        m_state.m_kept.callHome(*bodies[i]);
        called.push_back(bodies[i]);
    }
    for (btSoftBody* body : called)
        bringHomeInStep(*body);
}

// Brings bodies home that nothing holds, whose momentum the host keeps.
void SoftBodySolver::Work::bringFreeHome(const btAlignedObjectArray<btSoftBody*>& bodies)
{
    bringHomeWhere(bodies,
                   [this](const btSoftBody& body) { return !contactsOf(body) && !m_state.m_kept.hasPins(body); });
}

void SoftBodySolver::Work::bringAllHome(const btAlignedObjectArray<btSoftBody*>& bodies)
{
    bringHomeWhere(bodies, [](const btSoftBody&) { return true; });
}

// Brings a body home after the step's begin(), which knows whether it is away.
void SoftBodySolver::Work::bringHomeInStep(btSoftBody& body)
{
    if (BodyContacts* const contacts = contactsOf(body))
        m_step->bringHome(*contacts);
    else
        bringHome(body);
}

// Brings bodies home that the device has not solved.
void SoftBodySolver::Work::bringUnsolvedHome(const btAlignedObjectArray<btSoftBody*>& bodies)
{
    bringHomeWhere(bodies, [this](const btSoftBody& body) { return !clothOf(body).m_isSolved; });
}

// Stores the nodes of kept bodies that are at home. Returns the number of bodies whose step began and ended away.
std::size_t SoftBodySolver::Work::endKept(const btAlignedObjectArray<btSoftBody*>& bodies)
{
    std::size_t away = 0;
    for (int i = 0; i < bodies.size(); ++i)
    {
        if (!isSteppedBody(*bodies[i])) continue;
        away += m_state.m_kept.isAway(*bodies[i]);
        m_state.m_kept.endStep(*bodies[i], &m_owner, contactsOf(*bodies[i]) != nullptr);
    }
    return away;
}

// Enqueues the step of all bodies behind the detection. Returns false, with nothing enqueued, if that is not possible.
bool SoftBodySolver::Work::submitBehind(const btAlignedObjectArray<btSoftBody*>& bodies, const ContactSource& source)
{
    if (m_step->hasPairs() && !source.onDevice().m_list) return false;
    takeSubsteps(bodies);
    return m_solver->submitBehind(m_touched, m_free, source, *m_stage);
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
    work.takeForeign(m_softBodySet);
    parts.m_readMs += watch.lapMs();
    if (work.solveByBullet(m_softBodySet)) parts.m_bulletMs += watch.lapMs();
    // The host solves what the device has refused.
    m_state->m_statistics.m_clothsOnDevice =
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
    step->end();
    statistics.m_clothsAway = m_work->endKept(m_softBodySet);
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
        const bool isAway = substeps && substeps->isAway();  // its nodes are those of the last step's end
        if (work.isSolved(i) || !work.isSteppedBody(body) || isAway) continue;
        if (handlesSteppedCloth(*m_state, body))
        {
            const BodyContacts* const contacts = work.m_detected ? work.contactsOf(body) : nullptr;
            holdStill(body, contacts && !contacts->m_isAway ? contacts : nullptr);
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
        guarded([&] { m_work->bringHome(body); }, failed);
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
    const auto isAtHome = [this](const btSoftBody& body) { return body.isActive() && !m_state->m_kept.isAway(body); };
    const auto sizeOf = [&](std::size_t i)
    {
        const btSoftBody& body = *m_softBodySet[int(i)];
        return isAtHome(body) ? static_cast<std::size_t>(body.m_nodes.size()) : 0;
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
