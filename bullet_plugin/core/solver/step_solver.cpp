#include "step_solver.h"

#include <algorithm>
#include <functional>
#include <iterator>

#include "bullet_plugin/core/solver/host/cloth_rows.h"
#include "bullet_plugin/core/solver/host/momentum.h"
#include "kernels/lib/solver/closing_sweeps.h"
#include "rigid_rows.h"

namespace drape
{
namespace
{
// Minimum nodes for sharing cloths among threads; a substep takes 50 ns a node.
constexpr std::size_t kLeastNodesShared = 2048;
// Sweeps over rows of cloth with cloth, and of features beside rigid bodies, after each sweep over links. Then those of
// cloth with cloth after the last substep.
constexpr int kRowSweeps = 8, kClosingRowSweeps = 16;
// Minimum nodes for sharing keepMomenta() among threads: it takes 20 ns a node.
constexpr std::size_t kLeastKeepingShared = 8192;

bool hasContacts(const ContactSweep* sweep)
{
    return !sweep->contacts().m_features.empty();
}

int iterationsOf(const SolverCloth& cloth)
{
    return cloth.m_substeps ? cloth.m_substeps->count() : cloth.m_links->iterations();
}

// Returns the share of the step that has passed after an iteration, for what constraints ask.
float passedAfter(const SolverCloth& cloth, int iteration)
{
    return cloth.m_substeps ? std::min(1.0f, float(iteration + 1) / float(cloth.m_substeps->count())) : 1.0f;
}

// Returns the time of the cloth's substeps, s; 0 if it has none.
float substepTime(const SolverCloth& cloth)
{
    return cloth.m_substeps ? cloth.m_substeps->time() / float(cloth.m_substeps->count()) : 0.0f;
}

// Returns whether the last sweep met a violation worse than `share` of the thickness.
bool isViolated(const ContactSweep* sweep, float share)
{
    return SweepTeam::worst(*sweep) > share * sweep->contacts().m_leastThickness;
}

// Returns whether the cloth needs another closing sweep after `done` sweeps.
bool isOpen(const ContactSweep* sweep, int done)
{
    const float thickness = sweep->contacts().m_leastThickness;
    return needsClosing(std::uint32_t(done), std::uint32_t(SweepTeam::blockCount(*sweep)), SweepTeam::worst(*sweep),
                        kClosingTolerance * thickness, kMostViolation * thickness) != 0;
}

bool obstaclesRest(const ContactSweep* sweep)
{
    return sweep->contacts().m_limit.obstaclesRest();
}

// Calls call(rows) for all cloths with rows beside rigid bodies.
template <class Call>
void forRigid(const SweepTeam::Cloths& cloths, const Call& call)
{
    for (const ContactSweep* sweep : cloths)
        if (RigidRows* rigid = sweep->cloth().m_rigid) call(*rigid);
}

// Copies the cloths of `from` for which predicate(cloth) is true to `to`, another list.
template <class Predicate>
void select(const SweepTeam::Cloths& from, SweepTeam::Cloths& to, const Predicate& predicate)
{
    to.clear();
    std::copy_if(from.begin(), from.end(), std::back_inserter(to), predicate);
}

// Keeps the cloths for which predicate(cloth) is true.
template <class Predicate>
void keep(SweepTeam::Cloths& cloths, const Predicate& predicate)
{
    const auto drops = [&](const ContactSweep* sweep) { return !predicate(sweep); };
    cloths.erase(std::remove_if(cloths.begin(), cloths.end(), drops), cloths.end());
}

void rememberAll(SolverNodes& nodes)
{
    for (std::size_t i = 0; i < nodes.count(); ++i)
        nodes.remember(i);
}

// Returns the velocity that a shift after substeps or between Bullet's iterations gives per metre, 1/s.
float perShift(const ClothContacts& contacts)
{
    return contacts.m_perSecond * contacts.m_undamped;
}

void addShifts(ClothContacts& contacts)
{
    const float perSecond = perShift(contacts);
    for (std::size_t i = 0; i < contacts.m_nodes.count(); ++i)
        contacts.m_nodes.addShift(i, perSecond);
}

// Bounds the velocities that the motion limit gave in a substep.
void boundShifts(ContactSweep& sweep)
{
    const Substeps* const substeps = sweep.cloth().m_substeps;
    if (!substeps) return;
    for (std::size_t i = 0; i < sweep.nodes().count(); ++i)
        sweep.nodes().limitShift(i, 1 / substeps->correctionTime(), sweep.contacts().m_perSecond);
}
}  // namespace

void StepSolver::begin(const ContactSource& source)
{
    while (m_sweeps.size() < m_cloths.size())
        m_sweeps.emplace_back(new ContactSweep);
    m_all.clear();
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
    {
        m_sweeps[i]->assign(m_cloths[i], source, m_records);
        m_all.push_back(m_sweeps[i].get());
    }
    m_team.forCloths(m_all, [](ContactSweep& sweep) { sweep.begin(); });
    select(m_all, m_touching, hasContacts);
    m_team.start(m_touching);
}

void StepSolver::applyLimits(const Cloths& cloths)
{
    m_team.forCloths(cloths, [](ContactSweep& sweep) { sweep.contacts().m_limit.apply(sweep.nodes()); });
}

// Calls job(cloth, threads) for each cloth: side by side if there are several, none of which has most of many nodes,
// else one after the other with all threads.
template <class Job>
void StepSolver::forEach(const std::vector<LinkedNodes>& cloths, const Job& job)
{
    std::size_t all = 0, most = 0;
    for (const LinkedNodes& cloth : cloths)
    {
        all += cloth.m_nodes->count();
        most = std::max(most, cloth.m_nodes->count());
    }
    if (all >= kLeastNodesShared && 2 * most <= all)
        return m_threads.run(cloths.size(), [&](std::size_t i) { job(cloths[i], nullptr); });
    for (const LinkedNodes& cloth : cloths)
        job(cloth, &m_threads);
}

// Calls job(nodes, substeps, threads) for each cloth of the iteration whose links are the core's.
template <class Job>
void StepSolver::forSubsteps(const Job& job)
{
    m_own.clear();
    for (const ContactSweep* sweep : m_iterating)
        if (Substeps* substeps = sweep->cloth().m_substeps) m_own.push_back({&sweep->nodes(), substeps});
    forEach(m_own,
            [&](const LinkedNodes& cloth, ThreadTeam* threads) { job(*cloth.m_nodes, *cloth.m_substeps, threads); });
}

// Begins an iteration's rows. The links' last pull takes over what contacts pushed before it.
void StepSolver::restart(int iteration)
{
    for (ContactSweep* sweep : m_turn)
    {
        const SolverCloth& cloth = sweep->cloth();
        sweep->restart(passedAfter(cloth, iteration), cloth.m_substeps ? actingSweepsOf(cloth.m_substeps->count()) : 0,
                       0, cloth.m_substeps ? 1 / cloth.m_substeps->correctionTime() : perShift(sweep->contacts()));
        if (cloth.m_rigid) cloth.m_rigid->begin(sweep->nodes(), *cloth.m_substeps, iteration);
    }
}

// Sweeps over links and contacts in turns.
void StepSolver::sweepInTurns()
{
    select(m_turn, m_meeting, hasContacts);
    for (int i = 0; i < kContactSweeps; ++i)
    {
        forSubsteps([](SolverNodes& nodes, Substeps& substeps, ThreadTeam* threads)
                    { substeps.sweepLinks(nodes, threads); });
        m_team.run(m_meeting);
        forRigid(m_turn, [](RigidRows& rigid) { rigid.project(); });
        for (int k = 0; k < kRowSweeps; ++k)
        {
            forRigid(m_turn, [](RigidRows& rigid) { rigid.projectFeatures(DRAPE_TURN_RELAXATION); });
            if (m_rows) m_rows->project(1, DRAPE_TURN_RELAXATION);
        }
    }
    if (m_rows) m_rows->end(1 / m_slowest->m_substeps->correctionTime());
}

// Lets rows of cloth with cloth give both sides the same impulse: a push becomes velocity as in the slowest cloth.
// Cloths differ after a longer step or one of Bullet's solver, and by their time scales.
void StepSolver::shareRows(bool closing)
{
    const auto time = [closing](const SolverCloth& cloth)
    { return closing ? 1 / cloth.m_contacts->m_perSecond : cloth.m_substeps->correctionTime(); };
    m_slowest = nullptr;
    for (const SolverCloth& cloth : m_cloths)
        if (cloth.m_meetsCloth && (!m_slowest || time(cloth) > time(*m_slowest))) m_slowest = &cloth;
    for (const SolverCloth& cloth : m_cloths)
        if (cloth.m_meetsCloth) cloth.m_contacts->m_nodes.setPushShare(time(cloth) / time(*m_slowest));
}

void StepSolver::beginRows(int iteration)
{
    m_rows->begin(passedAfter(*m_slowest, iteration), substepTime(*m_slowest));
}

// Projects rows of cloth with cloth until they hold, or kClosingRowSweeps times. Contacts with obstacles follow.
void StepSolver::closeRows()
{
    if (!m_rows) return;
    shareRows(true);
    m_rows->begin(1, 0);
    m_rows->project(kClosingRowSweeps, 1, kTolerated, kClosingTolerance);
    m_rows->end(perShift(*m_slowest->m_contacts));
}

// Runs an iteration's limits and contact sweeps.
void StepSolver::sweepContacts(int iteration)
{
    const auto isCallers = [](const ContactSweep* sweep) { return sweep->cloth().m_links != nullptr; };
    select(m_iterating, m_turn, isCallers);
    const auto read = [](ContactSweep& sweep)
    {
        sweep.cloth().m_links->read(sweep.nodes());
        rememberAll(sweep.nodes());
    };
    m_team.forCloths(m_turn, read);
    // Limits beside a moving obstacle hold at the step's end alone.
    const auto isLimited = [iteration](const ContactSweep* sweep)
    {
        const Substeps* const substeps = sweep->cloth().m_substeps;
        return iteration > 0 && (!substeps || obstaclesRest(sweep) || iteration + 1 == substeps->count());
    };
    select(m_iterating, m_turn, isLimited);
    applyLimits(m_turn);
    m_team.forCloths(m_turn, boundShifts);
    select(m_iterating, m_turn, [](const ContactSweep* sweep) { return hasContacts(sweep) || sweep->cloth().m_rigid; });
    restart(iteration);
    if (m_rows) beginRows(iteration);
    sweepInTurns();
    forRigid(m_iterating, [](RigidRows& rigid) { rigid.end(); });
    select(m_iterating, m_turn, isCallers);
    const auto write = [](ContactSweep& sweep)
    {
        addShifts(sweep.contacts());
        sweep.cloth().m_links->write(sweep.nodes());
    };
    m_team.forCloths(m_turn, write);
}

void StepSolver::endIteration(int iteration)
{
    forSubsteps([](SolverNodes& nodes, Substeps& substeps, ThreadTeam* threads) { substeps.end(nodes, threads); });
    for (const ContactSweep* sweep : m_iterating)
        if (CallersLinks* links = sweep->cloth().m_links) links->solve(iteration);
}

void StepSolver::iterate()
{
    m_iterating = m_all;
    if (m_rows) shareRows(false);
    forSubsteps([](SolverNodes& nodes, Substeps& substeps, ThreadTeam* threads) { substeps.begin(nodes, threads); });
    for (int i = 0; !m_iterating.empty(); ++i)
    {
        forSubsteps([](SolverNodes& nodes, Substeps& substeps, ThreadTeam* threads)
                    { substeps.advance(nodes, threads); });
        sweepContacts(i);
        endIteration(i);
        keep(m_iterating, [&](const ContactSweep* sweep) { return i + 1 < iterationsOf(sweep->cloth()); });
    }
}

// Runs a sweep after the first. Nodes whose obstacles all rest stay with the threads. For the other cloths the motion
// limit reads every node's position.
void StepSolver::runAgain(const Cloths& cloths)
{
    select(cloths, m_resting, obstaclesRest);
    select(cloths, m_others, [](const ContactSweep* sweep) { return !obstaclesRest(sweep); });
    m_team.limitAndRun(m_resting);
    applyLimits(m_others);
    m_team.run(m_others);
}

// Limits nodes without contacts. A sweep does not move them, but it moves their faces, which may have come near an
// obstacle. No contact depends on these nodes' positions.
void StepSolver::holdOthers()
{
    m_team.forCloths(m_touching,
                     [](ContactSweep& sweep)
                     {
                         MotionLimit& limit = sweep.contacts().m_limit;
                         if (limit.obstaclesRest()) limit.applyToOthers(sweep.nodes());
                     });
}

// Brings nodes to rest that hardly moved. Only for cloths that a contact pushed in this step, all of whose obstacles
// rest, and that touch no rigid body: momentum goes to the obstacle. Closing sweeps follow, so that the contacts hold.
void StepSolver::settle()
{
    const auto isSettled = [](const ContactSweep* sweep)
    {
        const SolverCloth& cloth = sweep->cloth();
        return cloth.m_substeps && cloth.m_substeps->settles() && !cloth.m_rigid && obstaclesRest(sweep) &&
               sweep->hasPushed();
    };
    select(m_touching, m_turn, isSettled);
    const auto settleNodes = [](ContactSweep& sweep)
    {
        SolverNodes& nodes = sweep.nodes();
        const Substeps& substeps = *sweep.cloth().m_substeps;
        for (std::size_t i = 0; i < nodes.count(); ++i)
            if (nodes.inverseMass(i) > 0)
                nodeSettle(nodes.nodes() + i, nodes.states() + i, substeps.accelerations()[i], substeps.perStep());
    };
    m_team.forCloths(m_turn, settleNodes);
}

void StepSolver::beginClosing()
{
    const auto begin = [](ContactSweep& sweep)
    {
        if (CallersLinks* links = sweep.cloth().m_links) links->read(sweep.nodes());
        rememberAll(sweep.nodes());
    };
    m_team.forCloths(m_all, begin);
}

void StepSolver::close()
{
    beginClosing();
    closeRows();
    applyLimits(m_all);
    for (ContactSweep* sweep : m_touching)
        sweep->restart(1, 0, sweep->cloth().m_substeps ? toleratedViolation(sweep->contacts()) : 0.0f,
                       sweep->contacts().m_movesOnly ? 0.0f : perShift(sweep->contacts()));
    m_team.run(m_touching);
    m_open = m_touching;
    for (int done = 1;; ++done)
    {
        keep(m_open, [done](const ContactSweep* sweep) { return isOpen(sweep, done); });
        if (m_open.empty()) break;
        runAgain(m_open);
    }
    select(m_touching, m_open, [](const ContactSweep* sweep) { return isViolated(sweep, kClosingTolerance); });
    // Nodes go last: contacts that do not converge leave their violation with faces and edges. A node outside the
    // obstacle keeps its faces and edges from passing it in a later step.
    m_team.runNodes(m_open);
    holdOthers();
    const auto gainsSpeed = [](const ContactSweep* sweep) { return !sweep->contacts().m_movesOnly; };
    select(m_all, m_turn, gainsSpeed);
    m_team.forCloths(m_turn, [](ContactSweep& sweep) { addShifts(sweep.contacts()); });
    select(m_touching, m_turn, gainsSpeed);
    m_team.limitSpeeds(m_turn);
    forRigid(m_all, [](RigidRows& rigid) { rigid.limitSpeeds(); });
    if (m_rows) m_rows->limitSpeeds(m_slowest->m_contacts->m_perSecond);
    for (ContactSweep* sweep : m_touching)
        sweep->contacts().m_mayHavePassed = SweepTeam::mayHavePassed(*sweep);
    const auto end = [](ContactSweep& sweep)
    {
        if (CallersLinks* links = sweep.cloth().m_links) links->write(sweep.nodes());
    };
    m_team.forCloths(m_all, end);
}

void StepSolver::solveOnHost(const std::vector<SolverCloth>& cloths, const std::vector<SolverCloth>& free,
                             const ContactSource& source)
{
    m_own.clear();
    for (const SolverCloth& cloth : free)
        m_own.push_back({&cloth.m_contacts->m_nodes, cloth.m_substeps});
    forEach(m_own,
            [](const LinkedNodes& cloth, ThreadTeam* threads) { cloth.m_substeps->run(*cloth.m_nodes, threads); });
    if (!cloths.empty())
    {
        m_cloths = cloths;
        begin(source);
        iterate();
        settle();
        close();
    }
    for (const std::vector<SolverCloth>* all : {&cloths, &free})
    {
        for (const SolverCloth& cloth : *all)
            cloth.m_contacts->m_isSolved = true;
        keepMomenta(*all);
    }
}

// Keeps the momentum of cloths that are solved and that no obstacle touches.
void StepSolver::keepMomenta(const std::vector<SolverCloth>& cloths)
{
    m_keeping.clear();
    std::size_t nodes = 0;
    for (const SolverCloth& cloth : cloths)
    {
        if (cloth.m_kept || cloth.m_meetsCloth || !cloth.m_contacts->m_isSolved || !keepsMomentum(cloth)) continue;
        m_keeping.push_back(&cloth);
        nodes += cloth.m_contacts->m_nodes.count();
    }
    if (nodes >= kLeastKeepingShared)
        return m_threads.run(m_keeping.size(), [&](std::size_t i) { keepMomentum(*m_keeping[i]); });
    for (const SolverCloth* cloth : m_keeping)
        keepMomentum(*cloth);
}

void StepSolver::divide(const std::vector<SolverCloth>& cloths, const std::vector<SolverCloth>& free,
                        const SolveStage* stage)
{
    m_onDevice.clear();
    m_onHost.clear();
    m_freeOnHost.clear();
    const auto movingRows = [](const SolverCloth& cloth) { return cloth.m_rigid ? cloth.m_rigid->movingRows() : 0; };
    // Cloths beside bodies that move may share these, so that they stay together.
    bool takesMoved = true;
    std::size_t rows = 0, nodes = 0;
    for (std::size_t i = 0; i < cloths.size(); ++i)
    {
        if (cloths[i].m_rigid) cloths[i].m_rigid->setTurn(i);
        const std::size_t moving = movingRows(cloths[i]);
        if (moving > 0 && !PackedStep::fits(cloths[i])) takesMoved = false;
        rows += moving;
        nodes += cloths[i].m_contacts->m_nodes.count();
    }
    takesMoved = takesMoved && PackedRigid::isWorthwhile(rows, nodes);
    const auto fits = [&](const SolverCloth& cloth)
    { return stage && PackedStep::fits(cloth) && (takesMoved || movingRows(cloth) == 0); };
    for (const SolverCloth& cloth : cloths)
        (fits(cloth) ? m_onDevice : m_onHost).push_back(cloth);
    for (const SolverCloth& cloth : free)
        (fits(cloth) ? m_onDevice : m_freeOnHost).push_back(cloth);
    // In an order that does not depend on contacts, so that less is packed anew.
    std::sort(m_onDevice.begin(), m_onDevice.end(),
              [](const SolverCloth& a, const SolverCloth& b)
              { return std::less<const Substeps*>()(a.m_substeps, b.m_substeps); });
}

// Accepts results of the device. Returns the number of cloths that it has solved.
std::size_t StepSolver::takeResults(const SolveWorkWord* words, SolveStage& stage, bool behind)
{
    if (words) m_packed.unpack(words, stage, behind);
    keepMomenta(m_onDevice);
    return std::size_t(std::count_if(m_onDevice.begin(), m_onDevice.end(),
                                     [](const SolverCloth& cloth) { return cloth.m_contacts->m_isSolved; }));
}

bool StepSolver::submitBehind(const std::vector<SolverCloth>& cloths, const std::vector<SolverCloth>& free,
                              const ContactSource& source, SolveStage& stage)
{
    divide(cloths, free, &stage);
    if (m_onDevice.empty() || !m_onHost.empty() || !m_freeOnHost.empty()) return false;
    m_packed.pack(m_onDevice, source, stage);
    stage.submit(m_packed.step());
    return true;
}

std::size_t StepSolver::finishBehind(SolveStage& stage, bool hasWaited)
{
    return takeResults(stage.finish(hasWaited), stage, true);
}

std::size_t StepSolver::solve(const std::vector<SolverCloth>& cloths, const std::vector<SolverCloth>& free,
                              const ContactSource& source, SolveStage* stage, ClothRows* rows)
{
    m_touching.clear();
    divide(cloths, free, stage);
    const auto meets = [](const SolverCloth& cloth) { return cloth.m_meetsCloth; };
    m_rows = rows && !rows->empty() && std::any_of(cloths.begin(), cloths.end(), meets) ? rows : nullptr;
    if (!m_onDevice.empty())
    {
        m_packed.pack(m_onDevice, source, *stage);
        stage->submit(m_packed.step());
    }
    solveOnHost(m_onHost, m_freeOnHost, source);
    m_rows = nullptr;
    if (m_onDevice.empty()) return 0;
    const std::size_t solved = takeResults(stage->finish(), *stage, false);
    m_refused.clear();
    std::copy_if(m_onDevice.begin(), m_onDevice.end(), std::back_inserter(m_refused),
                 [](const SolverCloth& cloth) { return !cloth.m_contacts->m_isSolved; });
    // In the caller's order, in which rows take turns at bodies that cloths share.
    const auto turnOf = [](const SolverCloth& cloth) { return cloth.m_rigid ? cloth.m_rigid->turn() : std::size_t(0); };
    std::sort(m_refused.begin(), m_refused.end(),
              [&](const SolverCloth& a, const SolverCloth& b) { return turnOf(a) < turnOf(b); });
    solveOnHost(m_refused, {}, source);
    return solved;
}

void StepSolver::close(const std::vector<SolverCloth>& cloths, const ContactSource& source)
{
    m_touching.clear();
    if (cloths.empty()) return;
    m_cloths = cloths;
    begin(source);
    close();
}
}  // namespace drape
