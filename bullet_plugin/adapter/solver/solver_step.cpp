// The order of a step: detection, the solver, and what follows them.
#include <algorithm>
#include <atomic>
#include <unordered_set>

#include "LinearMath/btQuickprof.h"
#include "bullet_plugin/adapter/motion/bounds_guard.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/solver/body_jobs.h"
#include "bullet_plugin/adapter/solver/body_nodes.h"
#include "bullet_plugin/adapter/solver/solver_work.h"
#include "bullet_plugin/core/public_call.h"
#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
namespace
{
// Passes of the guard after which obstacles push cloth back to its distance from them, and the maximum of all passes.
// In between, nodes that guard and obstacles push to and fro only stop earlier on their way. After the last pass cloths
// for which this had no end stand still. Held nodes carry cloth in the first passes alone: where an obstacle leaves no
// room, they go through it, and the pairs are flagged.
constexpr int kClosedGuardRounds = 2, kCarryingGuardRounds = 4, kMostGuardRounds = 8;

// Share of a cloth's nodes above which an impact makes its links correct errors slowly. Free sheets of a few nodes that
// are hooked into each other gained energy without bound; large ones with few nodes in impacts would only get soft.
constexpr float kMostImpactShare = 0.1f;

// Returns the number of elements that the step's memory is proportional to.
std::size_t elementsOf(const StepStatistics& step)
{
    return step.m_clothTriangles + step.m_obstacleTriangles + step.m_contacts +
           static_cast<std::size_t>(step.m_candidates);
}

// Ends the body's step at its start, with the velocities that it would have without gravity. Used for cloth with
// unknown contacts: a cloth at rest passes no resting obstacle. Allocates no memory. contacts: null if none are
// known. substeps: null if Bullet solves the links.
void holdStill(btSoftBody& body, const BodyContacts* contacts, const SubstepBody* substeps)
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
        if (substeps && substeps->isPredicted())
            node.m_v = substeps->velocities()[i];
        else if (node.m_im > 0)
            node.m_v -= fall;
        node.m_x = node.m_q;
    }
}

// Returns the largest speed of a node, m/s.
btScalar fastestOf(const btSoftBody& body)
{
    btScalar most2 = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        most2 = std::max(most2, body.m_nodes[i].m_v.length2());
    return btSqrt(most2);
}
}  // namespace

// Leaves bodies to Bullet for this step that changed since the prediction, or that touch what Bullet's own algorithms
// handle.
void SoftBodySolver::Work::leaveToBullet()
{
    std::vector<unsigned char> leaving(static_cast<std::size_t>(m_bodies.size()));
    const auto sizeOf = [this](std::size_t i)
    {
        const btSoftBody& body = *m_bodies[int(i)];
        return substepsOf(body) ? static_cast<std::size_t>(body.m_nodes.size()) : 0;
    };
    const auto check = [&](std::size_t i, ThreadTeam* threads)
    {
        const btSoftBody& body = *m_bodies[int(i)];
        leaving[i] = !substepsOf(body)->canSolveNow(body, threads);
    };
    forBodies(leaving.size(), m_state.threads(), sizeOf, check);
    for (std::size_t i = 0; i < leaving.size(); ++i)
    {
        if (!leaving[i]) continue;
        btSoftBody& body = *m_bodies[int(i)];
        if (m_state.m_kept.stepOf(body)) bringToHost(body);
        substepsOf(body)->leave(body);
    }
}

// Sets the stage that solves this step's cloths.
void SoftBodySolver::Work::chooseStage()
{
    std::size_t nodes = 0;
    for (int i = 0; i < m_bodies.size(); ++i)
        nodes += substepNodes(*m_bodies[i]);
    if (m_state.m_kept.anyBegun()) nodes = SIZE_MAX;  // wherever others would be solved
    m_meetings.begin(m_bodies, [this](const btSoftBody& body) { return isSteppedBody(body); });
    if (nodes > 0 && !m_meetings.any() && !m_state.m_records.isOn()) m_stage = m_state.pipeline().solveStage(nodes);
}

// Returns the pairs of the step. A dynamic body beside cloth that Bullet solves is not pushed by it.
std::vector<PairNote> SoftBodySolver::Work::takeNotes()
{
    std::vector<PairNote> notes = m_state.takeNotes(&m_owner, m_predicted);
    for (PairNote& note : notes)
        if (substepNodes(*note.m_cloth) == 0) note.m_yields = false;
    return notes;
}

// Finds the contacts of the step.
void SoftBodySolver::Work::detect()
{
    if (!m_state.ready()) return m_step.reset();
    m_state.restart();
    chooseStage();
    if (!m_step) m_step = std::make_unique<CollisionStep>(m_state);
    CollisionStep& step = *m_step;
    StepStatistics& statistics = m_state.m_statistics;
    if (m_usage.hasFallen(elementsOf(statistics))) giveBackRoom(m_state);
    Stopwatch watch(hasBodies());
    {
        BT_PROFILE("Drape mirrors");
        step.begin(takeNotes(), [this](btSoftBody& body) { bringToHost(body); });
        bringFreeToHost(m_bodies);
    }
    m_parts.m_mirrorMs += watch.lapMs();
    BT_PROFILE("Drape detection");
    const bool follows = m_stage && mayFollow();
    if (!follows) bringAllToHost(m_bodies);
    step.submit(follows ? ContactPlace::Device : ContactPlace::Host);
    const double uploadMs = step.uploadMs();
    watch.lapMs();
    const bool submitted = follows && submitBehind(m_bodies, m_state.m_found.source());
    m_parts.m_readMs += watch.lapMs();
    const auto takeSolved = [this](bool hasWaited) { m_onDevice = m_solver->finishBehind(*m_stage, hasWaited); };
    step.finish(submitted ? [&takeSolved] { takeSolved(true); } : CollisionStep::TakeSolved());
    if (submitted && !step.hasPairs()) takeSolved(false);
    if (submitted)
        bringUnsolvedToHost(m_bodies);
    else
        bringAllToHost(m_bodies);
    for (int i = 0; i < m_bodies.size(); ++i)
        step.reportInvalid(*m_bodies[i]);
    m_detected = true;
    statistics.m_clothsSkipped = m_asleep + step.pinnedCloths();
    m_parts.m_writeMs = watch.lapMs() - statistics.m_waitMs - (step.uploadMs() - uploadMs);
}

// Finds the contacts of bodies with themselves and with each other. Returns their rows, null if there are none.
ClothRows* SoftBodySolver::Work::findMeetings()
{
    if (!m_meetings.any()) return nullptr;
    return &m_meetings.find([this](const btSoftBody& body)
                            { return substepNodes(body) > 0 ? &clothOf(body).m_nodes : nullptr; });
}

// Keeps cloth from meeting itself and other cloth on the way to where the solver put it, and checks bodies anew beside
// obstacles whose nodes did not get there. fixed: see ClothMeetings::guard(). Cloth that obstacles stopped, or that was
// knocked out of the bounds in which meshes were looked for, does not go on with what it meets.
void SoftBodySolver::Work::guardMeetings(BodySet fixed)
{
    if (!m_meetings.any()) return;
    for (int round = 1;; ++round)
    {
        std::vector<const btSoftBody*> moved;
        for (btSoftBody* body : m_meetings.guard(round <= kCarryingGuardRounds, fixed))
        {
            // The guard left links stretched that the solver had satisfied. Corrected at the speed of a substep, they
            // would drive the cloth in every step.
            SubstepBody* const substeps = substepsOf(*body);
            if (substeps && m_meetings.impactShare(*body) > kMostImpactShare) substeps->changeOver();
            const bool isOut = holdInBounds(m_state, *body, contactsOf(*body));
            if (isOut)
            {
                fixed.insert(body);
                m_state.m_statistics.m_status |= kStepMotionHeldBack;
            }
            if (isOut || contactsOf(*body)) moved.push_back(body);
        }
        if (moved.empty()) return;
        if (round == kMostGuardRounds) return holdJammed(moved, fixed);
        for (const btSoftBody* body : moved)
            if (contactsOf(*body)) m_step->watch(*body);
        const std::vector<BodyContacts*> offPath = m_step->checkOffPath();
        m_step->addStopped(fixed);
        if (round <= kClosedGuardRounds) closeOffPath(offPath);
    }
}

// Holds bodies that guard and obstacles leave no room, with the cloth and the dynamic obstacles near them.
void SoftBodySolver::Work::holdJammed(const std::vector<const btSoftBody*>& jammed, const BodySet& fixed)
{
    BodySet held;
    for (const btSoftBody* body : jammed)
    {
        if (held.count(body) > 0) continue;
        BodySet bodies = {body};
        for (std::size_t before = 0; before != bodies.size();)
        {
            before = bodies.size();
            m_meetings.addNear(bodies);
            m_step->addSharers(bodies);
        }
        HeldGroup group;
        m_step->addTo(group, bodies);
        m_meetings.addTo(group, bodies);
        for (const btSoftBody* one : bodies)
            if (fixed.count(one) > 0) group.rest();
        group.hold();
        held.insert(bodies.begin(), bodies.end());
    }
    m_step->checkHeld(held);
    m_meetings.endHold();
}

// Writes the results to the bodies. Reports nodes whose positions are not valid: those that the detection left out,
// those of bodies without a pair, and those that the solver lost.
void SoftBodySolver::Work::endSubsteps()
{
    std::atomic<std::size_t> invalid{0};
    forBodies(
        m_ends.size(), m_state.threads(), [&](std::size_t i) { return m_ends[i].second->m_nodes.count(); },
        [&](std::size_t i, ThreadTeam* threads)
        { invalid += substepsOf(*m_ends[i].first)->end(*m_ends[i].second, *m_ends[i].first, threads); });
    if (invalid == 0) return;
    StepStatistics& statistics = m_state.m_statistics;
    statistics.m_status |= kStepInvalidNodes;
    statistics.m_invalidNodes = std::max(statistics.m_invalidNodes, invalid.load());
}

// Records the contacts of the step with what the solver gave.
void SoftBodySolver::Work::recordSolved()
{
    ContactRecords& records = m_state.m_records;
    if (!records.isOn()) return;
    const FoundContacts& found = m_state.m_found;
    const ContactList list = found.source().list();
    records.addDetected(found);
    const auto isListed = [&](const Contact* contact) { return contact >= list.begin() && contact < list.end(); };
    m_solver->forImpulses(
        [&](const Contact* contact, Vec3 impulse)
        {
            if (isListed(contact)) records.add(ContactRecords::pushOf(found, *contact, impulse));
        });
    for (int i = 0; i < m_bodies.size(); ++i)
    {
        const btSoftBody& body = *m_bodies[i];
        const RigidRows* const rows = substepNodes(body) > 0 ? substepsOf(body)->rigidRows() : nullptr;
        if (!rows) continue;
        records.addBullets(body, *rows);
        const BodyContacts* const contacts = contactsOf(body);
        for (std::size_t k = 0; contacts && k < contacts->m_dynamicContacts.size(); ++k)
            records.add(
                ContactRecords::pushOf(found, *contacts->m_dynamicContacts[k].m_contact, rows->featureImpulse(k)));
    }
    m_meetings.record(records);
}

// Returns what the last closing sweeps gave, for ContactRecords::add(). The bodies of its contacts tell whose it is.
std::vector<ContactPush> SoftBodySolver::Work::closingPushes()
{
    std::vector<ContactPush> pushes;
    const FoundContacts& found = m_state.m_found;
    const ContactList list = found.source().list();
    m_solver->forImpulses(
        [&](const Contact* contact, Vec3 impulse)
        {
            if (contact >= list.begin() && contact < list.end())
                pushes.push_back(ContactRecords::pushOf(found, *contact, impulse));
        });
    return pushes;
}

// Solves the bodies that the device has not solved behind the detection, and writes all results back.
void SoftBodySolver::Work::solveBodies()
{
    BT_PROFILE("Drape solver");
    StepParts& parts = m_parts;
    m_bulletLinks.clear();
    m_solved.assign(static_cast<std::size_t>(m_bodies.size()), 0);
    Stopwatch watch(hasBodies());
    readSubsteps(m_bodies);
    ClothRows* const rows = findMeetings();
    takeSubsteps(m_bodies);
    takeBulletsBodies(m_bodies);
    parts.m_readMs += watch.lapMs();
    if (solveByBullet(m_bodies)) parts.m_bulletMs += watch.lapMs();
    // The host solves what the device has refused.
    m_state.m_statistics.m_clothsSolvedOnDevice =
        m_onDevice +
        m_solver->solve(m_touched, m_free, m_state.m_found.source(), m_onDevice > 0 ? nullptr : m_stage, rows);
    recordSolved();
    double linksMs = 0;
    for (const std::unique_ptr<BulletLinks>& links : m_bulletLinks)
        linksMs += links->ms();
    parts.m_solveMs = watch.lapMs() - linksMs;
    parts.m_bulletMs += linksMs;
    endSubsteps();
    for (int i = 0; i < m_bodies.size(); ++i)
    {
        btSoftBody& body = *m_bodies[i];
        if (!isSteppedBody(body) || m_state.m_kept.stepOf(body)) continue;
        if (holdInBounds(m_state, body, contactsOf(body))) m_state.m_statistics.m_status |= kStepMotionHeldBack;
    }
    m_rigidBodies.applyImpulses();
    if (m_step) m_step->followDynamic();
    parts.m_writeBackMs = watch.lapMs();
}

// Keeps bodies that left their predicted paths at their distance from what is near their real ones. A body that
// would pass a surface on the way goes back to where it was checked.
void SoftBodySolver::Work::closeOffPath(const std::vector<BodyContacts*>& bodies)
{
    if (bodies.empty()) return;
    std::vector<SolverCloth> cloths;
    std::vector<SolverNodes> checked;
    for (BodyContacts* body : bodies)
    {
        cloths.push_back({&body->m_contacts, nullptr, nullptr, nullptr, nullptr});
        checked.push_back(body->nodes());
    }
    m_solver->close(cloths, m_state.m_found.source());
    const std::vector<ContactPush> pushes = closingPushes();
    for (BodyContacts* body : bodies)
        writeShifted(body->nodes(), *body->m_body);
    m_step->detectRealPaths();
    std::unordered_set<const btSoftBody*> undone;
    for (std::size_t i = 0; i < bodies.size(); ++i)
    {
        if (!m_step->passesSurface(*bodies[i]) && !leavesBounds(m_state, *bodies[i]->m_body)) continue;
        for (std::size_t node = 0; node < checked[i].count(); ++node)
            writeNode(checked[i], node, bodies[i]->m_body->m_nodes[int(node)]);
        undone.insert(bodies[i]->m_body);
    }
    for (const ContactPush& push : pushes)
        if (undone.count(push.m_contact.m_cloth.m_body) == 0) m_state.m_records.add(push);
}

// Checks the real paths of bodies beside obstacles and other cloth.
void SoftBodySolver::Work::checkPaths(CollisionStep& step)
{
    BT_PROFILE("Drape check");
    const BodySet fixed = m_meetings.any() ? step.listFixed() : BodySet();
    closeOffPath(step.checkOffPath());
    guardMeetings(fixed);
    step.reportLeftSurfaces();
    step.reportMeetingDeformed();
    step.end();
}

void SoftBodySolver::Work::solveStep()
{
    StepParts& parts = m_parts;
    const std::size_t waits = m_state.ready() ? m_state.pipeline().deviceWaits() : 0;
    Stopwatch watch(hasBodies());
    m_begun = false;
    m_onDevice = 0;
    m_stage = nullptr;
    m_meetings.clear();
    m_state.m_records.setOn(m_state.m_asksRecords || m_state.m_listener);
    m_state.m_records.clear();
    m_state.m_flagged.clear();
    m_solver->recordImpulses(m_state.m_records.isOn());
    leaveToBullet();
    parts.m_readMs += watch.lapMs();
    detect();
    solveBodies();
    CollisionStep* const step = m_step.get();
    if (!step) return;
    StepStatistics& statistics = m_state.m_statistics;
    const double waitMs = statistics.m_waitMs, uploadMs = step->uploadMs();
    watch.lapMs();
    checkPaths(*step);
    if (m_state.settings().m_clothSleeps) letSleep();
    m_state.m_records.end();
    statistics.m_clothsKept = endKept(m_bodies);
    parts.m_uploadMs = step->uploadMs();
    parts.m_checkMs = watch.lapMs() - (statistics.m_waitMs - waitMs) - (parts.m_uploadMs - uploadMs);
    parts.m_waitMs = statistics.m_waitMs;
    parts.m_refitMs = statistics.m_refitMs;
    parts.m_broadMs = statistics.m_broadMs;
    parts.m_narrowMs = statistics.m_narrowMs;
    static_cast<StepParts&>(statistics) = parts;
    const std::size_t all = m_state.pipeline().deviceWaits();
    statistics.m_deviceWaits = all > waits ? all - waits : 0;  // a device may have been opened anew
    m_state.tellContacts(&m_owner, double(m_dt));
    m_state.tellJobs();
}

// Lets bodies fall asleep that have been slow for as long as Bullet waits with rigid bodies. Bullet puts them to sleep
// together with the rigid bodies that they touch.
void SoftBodySolver::Work::letSleep()
{
    for (int i = 0; i < m_bodies.size(); ++i)
    {
        btSoftBody& body = *m_bodies[i];
        if (!isSteppedBody(body) || m_state.m_kept.isOnDevice(body) || gDisableDeactivation) continue;
        // Bullet has put it to sleep in this step.
        for (int k = 0; !body.isActive() && k < body.m_nodes.size(); ++k)
            body.m_nodes[k].m_v.setZero();
        if (!body.isActive()) continue;
        const bool isSlow = fastestOf(body) < body.m_sleepingThreshold;
        body.setDeactivationTime(isSlow ? body.getDeactivationTime() + m_dt : btScalar(0));
        body.setActivationState(body.getDeactivationTime() > gDeactivationTime ? WANTS_DEACTIVATION : ACTIVE_TAG);
    }
}

void SoftBodySolver::Work::endFailedStep()
{
    for (int i = 0; i < m_bodies.size(); ++i)
    {
        btSoftBody& body = *m_bodies[i];
        const SubstepBody* const substeps = substepsAt(body);
        const bool isOnDevice = substeps && substeps->isOnDevice();  // its nodes are those of the last step's end
        if (isSolved(i) || !isSteppedBody(body) || isOnDevice) continue;
        if (handlesSteppedCloth(m_state, body))
        {
            const BodyContacts* const contacts = m_detected ? contactsOf(body) : nullptr;
            holdStill(body, contacts && !contacts->m_isOnDevice ? contacts : nullptr, substeps);
        }
        else
            drape::solveByBullet(body);
    }
    m_step.reset();
    m_failures = m_state.failures();
    if (!m_state.ready()) return;
    m_state.m_statistics = StepStatistics();
    m_state.m_statistics.m_status |= kStepOutOfMemory;
    if (m_state.pipeline().deviceFailed()) m_state.m_statistics.m_status |= kStepDeviceFailed;
}

bool SoftBodySolver::Work::takesPair(const btSoftBody& body, const btSoftBody& other)
{
    const auto failed = [&](const CaughtException& caught)
    {
        m_state.fail("drape::SoftBodySolver::processCollision", caught);
        return false;
    };
    if (!m_state.ready() || m_bodies.findLinearSearch2(const_cast<btSoftBody*>(&other)) < 0) return false;
    if (reasonFromSettings(m_state, body) || reasonFromSettings(m_state, other)) return false;
    return guarded([&] { return m_state.m_selfCollision.takes(body, other); }, failed);
}

void SoftBodySolver::Work::readByBullet(btSoftBody& body, const btCollisionObject& object)
{
    const auto failed = [&](const CaughtException& caught)
    { m_state.fail("drape::SoftBodySolver::processCollision", caught); };
    if (m_state.m_kept.stepOf(body) && m_state.m_kept.isRead(body, object)) guarded([&] { bringToHost(body); }, failed);
    m_state.updateNodeTree(body);
}
}  // namespace drape
