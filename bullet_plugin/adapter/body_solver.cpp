#include "bullet_plugin/adapter/body_solver.h"

#include <algorithm>
#include <iterator>

#include "bullet_plugin/core/float_environment.h"
#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
namespace
{
// Minimum nodes for sharing bodies among threads; a substep takes 50 ns a node.
constexpr std::size_t kLeastNodesShared = 2048;

// Bullet's iterations may be run part by part: those on velocities first, those on positions one by one, those
// against drift last. Each call on positions derives the velocities anew from the step's start, and nothing else in a
// call accumulates. Clusters and joints do accumulate.
bool iterationsCanBeSplit(const btSoftBody& body)
{
    return body.m_clusters.size() == 0 && body.m_joints.size() == 0;
}

btSoftBody& bodyOf(const ContactRounds* rounds)
{
    return *rounds->contacts().m_body;
}

bool hasContacts(const ContactRounds* rounds)
{
    return !rounds->contacts().m_features.empty();
}

// Returns how many of Bullet's iterations on positions the body gets.
int positionIterations(const ContactRounds* rounds)
{
    const int iterations = std::max(0, bodyOf(rounds).m_cfg.piterations);
    return iterations > 0 && hasContacts(rounds) ? std::max(kLeastIterations, iterations) : iterations;
}

SubstepBody* substepsOf(const ContactRounds* rounds)
{
    return rounds->contacts().m_substeps;
}

// Returns the number of substeps, or of calls of Bullet's solver, at least one.
int callsFor(const ContactRounds* rounds)
{
    const btSoftBody& body = bodyOf(rounds);
    if (substepsOf(rounds)) return SubstepBody::substepsOf(body);
    if (!iterationsCanBeSplit(body)) return 1;
    return std::max(1, (body.m_cfg.viterations > 0) + positionIterations(rounds) + (body.m_cfg.diterations > 0));
}

// Sets the iterations of one call; the first call is 0. positions: iterations on positions in all calls.
void keepIterationsOf(int call, int positions, btSoftBody::Config& config)
{
    const int velocities = config.viterations > 0 ? 1 : 0;
    if (call >= velocities) config.viterations = 0;
    config.piterations = call >= velocities && call < velocities + positions ? 1 : 0;
    if (call < velocities + positions) config.diterations = 0;
}

// Calls Bullet's solver once. Returns its time, ms.
double callBullet(const ContactRounds* rounds, int call)
{
    btSoftBody& body = bodyOf(rounds);
    const int velocities = body.m_cfg.viterations, positions = body.m_cfg.piterations, drift = body.m_cfg.diterations;
    if (iterationsCanBeSplit(body)) keepIterationsOf(call, positionIterations(rounds), body.m_cfg);
    Stopwatch watch;
    solveByBullet(body);
    const double ms = watch.lapMs();
    body.m_cfg.viterations = velocities;
    body.m_cfg.piterations = positions;
    body.m_cfg.diterations = drift;
    return ms;
}

// Returns whether the last sweep met a violation worse than `share` of the thickness.
bool isViolated(const ContactRounds* rounds, btScalar share)
{
    return RoundsTeam::worst(*rounds) > share * rounds->contacts().m_leastThickness;
}

int mostClosingRounds(const ContactRounds* rounds)
{
    const std::size_t affordable = kFurtherLooks / std::max<std::size_t>(1, RoundsTeam::blockCount(*rounds));
    return kClosingRounds + static_cast<int>(std::min(kMostFurther, std::max(kLeastFurther, affordable)));
}

// Returns whether the body needs another closing sweep after `done` sweeps.
bool isOpen(const ContactRounds* rounds, int done)
{
    if (done < kClosingRounds) return isViolated(rounds, kClosingTolerance);
    return done < mostClosingRounds(rounds) && isViolated(rounds, kMostViolation);
}

// Returns whether threads take bodies side by side: several bodies, none of which has most of many nodes.
template <class NodesOf>
bool sharesBodies(std::size_t count, const NodesOf& nodesOf)
{
    std::size_t all = 0, most = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
        const std::size_t nodes = static_cast<std::size_t>(nodesOf(i));
        all += nodes;
        most = std::max(most, nodes);
    }
    return all >= kLeastNodesShared && 2 * most <= all;
}

bool obstaclesRest(const ContactRounds* rounds)
{
    return rounds->contacts().m_limit.obstaclesRest();
}

// Copies the bodies of `from` for which holds(body) is true to `to`, another list.
template <class Holds>
void select(const RoundsTeam::Bodies& from, RoundsTeam::Bodies& to, const Holds& holds)
{
    to.clear();
    std::copy_if(from.begin(), from.end(), std::back_inserter(to), holds);
}

// Keeps the bodies for which holds(body) is true.
template <class Holds>
void keep(RoundsTeam::Bodies& bodies, const Holds& holds)
{
    const auto drops = [&](const ContactRounds* rounds) { return !holds(rounds); };
    bodies.erase(std::remove_if(bodies.begin(), bodies.end(), drops), bodies.end());
}
}  // namespace

void solveByBullet(btSoftBody& body)
{
    const CallersFloats floats;
    body.solveConstraints();
}

void BodySolver::begin(const std::vector<BodyContacts*>& bodies, const FoundContacts& found)
{
    while (m_rounds.size() < bodies.size())
        m_rounds.emplace_back(new ContactRounds);
    m_all.clear();
    for (std::size_t i = 0; i < bodies.size(); ++i)
    {
        m_rounds[i]->assign(*bodies[i], found);
        m_all.push_back(m_rounds[i].get());
    }
    m_team.forBodies(m_all, [](ContactRounds& rounds) { rounds.begin(); });
    select(m_all, m_touching, hasContacts);
    m_team.start(m_touching);
}

void BodySolver::applyLimits(const Bodies& bodies)
{
    m_team.forBodies(bodies, [](ContactRounds& rounds) { rounds.contacts().m_limit.apply(bodyOf(&rounds)); });
}

// Calls job(body, substeps, threads) for each body of the turn whose links Drape solves: side by side where there are
// several and they are large, else one after the other with all threads.
template <class Job>
void BodySolver::forSubsteps(const Job& job)
{
    m_own.clear();
    std::copy_if(m_iterating.begin(), m_iterating.end(), std::back_inserter(m_own), substepsOf);
    const auto one = [&](std::size_t i, ThreadTeam* threads) { job(bodyOf(m_own[i]), *substepsOf(m_own[i]), threads); };
    if (sharesBodies(m_own.size(), [&](std::size_t i) { return bodyOf(m_own[i]).m_nodes.size(); }))
        return m_threads.run(m_own.size(), [&](std::size_t i) { one(i, nullptr); });
    for (std::size_t i = 0; i < m_own.size(); ++i)
        one(i, &m_threads);
}

// Ends an iteration. Returns the time of Bullet's part, ms.
double BodySolver::solveLinks(int iteration)
{
    double bulletMs = 0;
    forSubsteps([](btSoftBody& body, SubstepBody& substeps, ThreadTeam* threads)
                { substeps.endSubstep(body, threads); });
    for (const ContactRounds* rounds : m_iterating)
        if (!substepsOf(rounds)) bulletMs += callBullet(rounds, iteration);
    return bulletMs;
}

void BodySolver::solveFree(const std::vector<std::pair<btSoftBody*, SubstepBody*>>& bodies)
{
    const auto one = [&](std::size_t i, ThreadTeam* threads)
    { bodies[i].second->solveAlone(*bodies[i].first, threads); };
    if (sharesBodies(bodies.size(), [&](std::size_t i) { return bodies[i].first->m_nodes.size(); }))
        return m_threads.run(bodies.size(), [&](std::size_t i) { one(i, nullptr); });
    for (std::size_t i = 0; i < bodies.size(); ++i)
        one(i, &m_threads);
}

double BodySolver::iterate()
{
    double bulletMs = 0;
    m_iterating = m_all;
    forSubsteps([](btSoftBody& body, SubstepBody& substeps, ThreadTeam* threads) { substeps.begin(body, threads); });
    for (int i = 0; !m_iterating.empty(); ++i)
    {
        forSubsteps([](btSoftBody& body, SubstepBody& substeps, ThreadTeam* threads)
                    { substeps.advance(body, threads); });
        if (i > 0) applyLimits(m_iterating);
        select(m_iterating, m_turn, hasContacts);
        for (ContactRounds* rounds : m_turn)
            rounds->restart();  // the links' last pull takes over what contacts pushed before it
        m_team.gather(m_turn);
        m_team.runAndSettle(m_turn);
        m_team.scatter(m_turn);
        bulletMs += solveLinks(i);
        keep(m_iterating, [i](const ContactRounds* rounds) { return i + 1 < callsFor(rounds); });
    }
    return bulletMs;
}

// Runs a sweep after the first. Nodes whose obstacles all rest stay with the threads. For the other bodies the motion
// limit reads every node's position.
void BodySolver::runAgain(const Bodies& bodies)
{
    select(bodies, m_resting, obstaclesRest);
    select(bodies, m_others, [](const ContactRounds* rounds) { return !obstaclesRest(rounds); });
    m_team.limitAndRun(m_resting);
    m_team.scatter(m_others);
    applyLimits(m_others);
    m_team.gather(m_others);
    m_team.run(m_others);
}

// Limits nodes without contacts. A sweep does not move them, but it moves their faces, which may have come near an
// obstacle. No contact depends on these nodes' positions.
void BodySolver::holdOthers()
{
    m_team.forBodies(m_touching,
                     [](ContactRounds& rounds)
                     {
                         MotionLimit& limit = rounds.contacts().m_limit;
                         if (limit.obstaclesRest()) limit.applyToOthers(bodyOf(&rounds));
                     });
}

void BodySolver::close()
{
    applyLimits(m_all);
    for (ContactRounds* rounds : m_touching)
        rounds->restart();
    m_team.gather(m_touching);
    m_team.run(m_touching);
    m_open = m_touching;
    for (int done = 1;; ++done)
    {
        keep(m_open, [done](const ContactRounds* rounds) { return isOpen(rounds, done); });
        if (m_open.empty()) break;
        runAgain(m_open);
    }
    select(m_touching, m_open, [](const ContactRounds* rounds) { return isViolated(rounds, kClosingTolerance); });
    // Nodes go last: contacts that do not converge leave their violation with faces and edges. A node outside the
    // obstacle keeps its faces and edges from passing it in a later step.
    m_team.runNodes(m_open);
    m_team.scatter(m_touching);
    holdOthers();
    m_team.limitSpeeds(m_touching);
    for (ContactRounds* rounds : m_touching)
        rounds->contacts().m_mayHavePassed = RoundsTeam::mayHavePassed(*rounds);
}

double BodySolver::solve(const std::vector<BodyContacts*>& bodies, const FoundContacts& found)
{
    if (bodies.empty()) return 0;
    begin(bodies, found);
    const double bulletMs = iterate();
    close();
    return bulletMs;
}
}  // namespace drape
