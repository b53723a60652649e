// The begin of a solver's step: which bodies take part, and their prediction.
#include <algorithm>
#include <iterator>

#include "LinearMath/btAabbUtil2.h"
#include "bullet_plugin/adapter/cloth_cloth/soft_body_filters.h"
#include "bullet_plugin/adapter/motion/motion_bounds.h"
#include "bullet_plugin/adapter/motion/node_tree.h"
#include "bullet_plugin/adapter/motion/prediction.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/solver/body_jobs.h"
#include "bullet_plugin/adapter/solver/solver_work.h"
#include "bullet_plugin/adapter/wiring/wiring.h"
#include "bullet_plugin/core/stopwatch.h"

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
}  // namespace

SubstepBody* SoftBodySolver::Work::substepsAt(const btSoftBody& body) const
{
    const auto found = m_substeps.find(&body);
    return found == m_substeps.end() ? nullptr : found->second.get();
}

template <class Predict>
void SoftBodySolver::Work::predictOne(btSoftBody& body, ThreadTeam* threads, const Predict& predict)
{
    SubstepBody* const substeps = substepsAt(body);
    m_state.m_kept.giveSupports(body, substeps);
    if (substeps) substeps->beforePrediction(body, threads);
    predict(body);
    if (substeps) substeps->afterPrediction(body, threads);
}

// Begins the steps of bodies whose nodes are on the device, or gives them the nodes of the last step's end.
void SoftBodySolver::Work::beginOnDevice(const Bodies& bodies)
{
    if (!m_state.m_kept.any()) return;
    const auto isOnDevice = [&](int i) { return bodies[i]->isActive() && m_state.m_kept.isOnDevice(*bodies[i]); };
    for (int i = 0; i < bodies.size(); ++i)
    {
        if (!isOnDevice(i)) continue;
        SubstepBody* const substeps = substepsAt(*bodies[i]);
        if (substeps && m_state.m_kept.begin(*bodies[i], substeps->count(), m_dt))
            substeps->predictOnDevice();
        else
            m_state.m_kept.beginBringing(*bodies[i]);
    }
    for (int i = 0; i < bodies.size(); ++i)
        if (isOnDevice(i) && !m_state.m_kept.stepOf(*bodies[i])) m_state.bringToHost(*bodies[i]);
}

// Brings a body to the host whose step has begun without its nodes, and predicts them. The broad phase keeps the
// bounds.
void SoftBodySolver::Work::bringToHost(btSoftBody& body)
{
    m_state.bringToHost(body);
    const btVector3 bounds[2] = {body.m_bounds[0], body.m_bounds[1]};
    predictOne(body, &m_threads, [this](btSoftBody& plain) { predictAndLeaveTree(plain, m_dt, &m_threads); });
    std::copy(bounds, bounds + 2, body.m_bounds);
}

// Returns whether Bullet's collision reads the node trees through this solver alone.
bool SoftBodySolver::Work::seesReads(const Bodies& bodies) const
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
void SoftBodySolver::Work::predict(const Bodies& bodies, btScalar dt)
{
    m_dt = dt;
    m_seesReads = seesReads(bodies);
    beginOnDevice(bodies);
    const auto isOnDevice = [this](const btSoftBody& body) { return m_state.m_kept.isOnDevice(body); };
    const auto isPlainAt = [&](int i)
    { return bodies[i]->isActive() && !isOnDevice(*bodies[i]) && isPlain(*bodies[i], dt); };
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
        if (isPlainAt(i) || isOnDevice(*bodies[i]))
            updateBroadphase(*bodies[i]);
        else
            predictOne(*bodies[i], nullptr, byBullet);
    }
}

bool SoftBodySolver::Work::isIdle()
{
    if (hasBodies())
        m_emptySteps = 0;
    else if (m_emptySteps < kIdleAfter)
        ++m_emptySteps;
    else if (m_failures == m_state.failures() && m_state.isSettled())
    {
        m_listed = true;  // no body
        m_predicted.clear();
        return true;
    }
    return false;
}

void SoftBodySolver::Work::beginStep(btScalar dt, std::vector<StepObstacle>& obstacles)
{
    m_listed = false;
    m_taken.clear();
    m_state.dropNotes(&m_owner);  // notes of a dispatch that no solve followed
    m_state.beginStep(&m_owner, m_bodies);
    if (!m_state.ready()) return listPredicted();
    m_state.m_kept.forgetRemoved(&m_owner, m_bodies);
    Stopwatch watch(hasBodies());
    KinematicMotions& motions = m_state.motionsOf(&m_owner);
    listTaken();
    motions.beginStep(dt, [this](const btCollisionObject& object, const btTransform& map, btScalar slack)
                      { return m_state.movedAlong(m_taken, object, map, slack); });
    wakeHit(dt);
    obstacles = wakeReached(motions);
    listPredicted();
    m_parts.m_mirrorMs = watch.lapMs();
    reserveSubsteps();
    shareSubsteps(dt);
    m_parts.m_readMs = watch.lapMs();
}

// Prepares the bodies whose links Drape solves in the coming step, and forgets all others.
void SoftBodySolver::Work::reserveSubsteps()
{
    auto& all = m_substeps;
    std::size_t solved = 0;
    const std::vector<const btSoftBody*> before = std::move(m_byBullet);
    std::vector<const btSoftBody*>& byBullet = m_byBullet;
    byBullet.clear();
    for (int i = 0; i < m_bodies.size(); ++i)
    {
        const btSoftBody& body = *m_bodies[i];
        auto at = all.find(&body);
        const bool wasByBullet = std::binary_search(before.begin(), before.end(), &body);
        // Sleeping bodies are not examined: a world at rest may have thousands.
        const bool isSolved = body.isActive() ? !reasonFromSettings(m_state, body) : at != all.end();
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

// Gives the bodies that collide with cloth one number of substeps, so that their contacts push both sides at the same
// time: the largest of theirs. dt: s.
void SoftBodySolver::Work::shareSubsteps(btScalar dt)
{
    int most = 0;
    std::vector<SubstepBody*> meeting;
    for (int i = 0; i < m_bodies.size(); ++i)
    {
        const btSoftBody& body = *m_bodies[i];
        if (!body.isActive() || !(dt > 0 && body.m_cfg.timescale > 0)) continue;
        SubstepBody* const substeps = substepsAt(body);
        if (!substeps || !m_state.m_selfCollision.has(body)) continue;
        meeting.push_back(substeps);
        most = std::max(most, substeps->count());
    }
    for (SubstepBody* substeps : meeting)
        substeps->setSubsteps(most);
}

// Forgets bodies that are not in the world any more.
void SoftBodySolver::Work::forgetRemoved()
{
    std::vector<const btSoftBody*> bodies;
    for (int i = 0; i < m_bodies.size(); ++i)
        bodies.push_back(m_bodies[i]);
    std::sort(bodies.begin(), bodies.end());
    auto& all = m_substeps;
    for (auto at = all.begin(); at != all.end();)
        at = std::binary_search(bodies.begin(), bodies.end(), at->first) ? std::next(at) : all.erase(at);
}

// Lists the bodies that Drape takes.
void SoftBodySolver::Work::listTaken()
{
    m_taken.clear();
    for (int i = 0; i < m_bodies.size(); ++i)
        if (handlesCloth(m_state, *m_bodies[i])) m_taken.push_back(m_bodies[i]);
}

// Wakes bodies that a moving obstacle reaches. Returns the obstacles of the step, without resting ones if no such
// body is awake.
std::vector<StepObstacle> SoftBodySolver::Work::wakeReached(KinematicMotions& motions)
{
    const std::vector<btSoftBody*>& taken = m_taken;
    if (taken.empty()) return {};
    const bool anyAwake =
        std::any_of(taken.begin(), taken.end(), [](const btSoftBody* body) { return body->isActive(); });
    std::vector<StepObstacle> obstacles = stepObstacles(m_state, *taken[0], motions, anyAwake);
    for (const StepObstacle& obstacle : obstacles)
        if (takeGImpactBack(m_state, *taken[0], *obstacle.m_object, *obstacle.m_object->getCollisionShape())) break;
    bool anyWoken = false;
    for (btSoftBody* body : taken)
    {
        if (body->isActive() || !isReached(m_state, *body, obstacles)) continue;
        body->activate();
        anyWoken = true;
    }
    return anyWoken && !anyAwake ? stepObstacles(m_state, *taken[0], motions, true) : obstacles;
}

// Wakes cloth that faster cloth is about to hit. Cloth that sleeps in that step would take its momentum.
void SoftBodySolver::Work::wakeHit(btScalar dt)
{
    std::vector<btSoftBody*> asleep, awake;
    const auto listMembers = [&](bool active, std::vector<btSoftBody*>& members)
    {
        for (int i = 0; i < m_bodies.size(); ++i)
        {
            if (m_bodies[i]->isActive() != active) continue;
            const SelfColliding* const self = m_state.m_selfCollision.find(*m_bodies[i]);
            if (self && self->m_meetsOthers) members.push_back(m_bodies[i]);
        }
    };
    listMembers(false, asleep);
    if (!asleep.empty()) listMembers(true, awake);
    for (const btSoftBody* body : awake)
    {
        const btScalar thickness = SelfCollision::thicknessOf(*body, *m_state.m_selfCollision.find(*body));
        btVector3 least = body->m_bounds[0], greatest = body->m_bounds[1];
        btScalar farthest2 = 0;
        for (int i = 0; i < body->m_nodes.size(); ++i)
        {
            const btVector3 way = dt * body->m_nodes[i].m_v, end = body->m_nodes[i].m_x + way;
            farthest2 = std::max(farthest2, way.length2());
            least.setMin(end);
            greatest.setMax(end);
        }
        if (!(farthest2 > thickness * thickness)) continue;
        const btVector3 reach(thickness, thickness, thickness);
        for (btSoftBody* other : asleep)
            if (TestAabbAgainstAabb2(least - reach, greatest + reach, other->m_bounds[0], other->m_bounds[1]) &&
                filtersLetMeet(*body, *other))
                other->activate();
    }
}

// Lists the bodies that were predicted. Bullet's islands and callbacks may wake cloth, or put it to sleep, before it
// is solved. Predicted bodies are solved with the contacts along their paths; others wait for the next step.
void SoftBodySolver::Work::listPredicted()
{
    std::vector<const btSoftBody*>& predicted = m_predicted;
    predicted.clear();
    for (int i = 0; i < m_bodies.size(); ++i)
        if (m_bodies[i]->isActive()) predicted.push_back(m_bodies[i]);
    std::sort(predicted.begin(), predicted.end());
    m_listed = true;
    m_asleep = static_cast<std::size_t>(m_bodies.size()) - predicted.size();
}
}  // namespace drape
