// Solves one step of some bodies. Bullet's own solver handles links, anchors and its own contacts; Gauss-Seidel
// sweeps over Drape's contacts run between its iterations and after them.
//
// Input: bodies after predictMotion and their contacts. Output: their positions and velocities at the step's end.
//
// Guarantee: no contact ends violated by more than kClosingTolerance if kClosingRounds sweeps suffice. Sweeps
// continue while a violation exceeds what the next step would recover. Results are the same bits with any number of
// threads. A body with clusters or joints is given to Bullet in one piece, with sweeps before and after.
//
// Cost: linear in the contacts; usually piterations + kClosingRounds sweeps, one iteration more with piterations 1,
// at most mostClosingRounds() closing sweeps, and the settling passes. Reasons: docs/design_notes/contact_sweeps.md.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_plugin/adapter/body_contacts.h"
#include "bullet_plugin/adapter/contact_rounds.h"
#include "bullet_plugin/adapter/found_contacts.h"

namespace drape
{
constexpr int kClosingRounds = 8;

// Minimum iterations of Bullet for a body with contacts whose iterations can be run one by one. The error left by a
// single pass over links and contacts becomes velocity. Where the pass overshoots, the next step corrects it and
// overshoots on the other side. A cloth of 33 x 33 nodes on a sphere keeps moving at 600 mm/s with one pass, at 2
// mm/s with two.
constexpr int kLeastIterations = 2;

// Budget of further sweeps, in contact blocks examined: a millisecond or two. A body with few contacts may take more
// sweeps, between the minimum and the maximum below.
constexpr std::size_t kFurtherLooks = std::size_t(1) << 16;
constexpr std::size_t kLeastFurther = 24, kMostFurther = 120;

// Worst violation that may remain, as a share of the thickness: before kClosingRounds sweeps are done, and after. The
// second is less than what the next step recovers, since later contacts of a sweep may increase a violation that was
// measured earlier in it.
constexpr btScalar kClosingTolerance = btScalar(0.01);
constexpr btScalar kMostViolation = btScalar(0.0625);
static_assert(kMostViolation < kRecoveredShare, "else cloth comes nearer from step to step");

// Runs Bullet's own solver for the body, in the floating-point environment of the app.
void solveByBullet(btSoftBody& body);

class BodySolver
{
public:
    explicit BodySolver(ThreadTeam& threads) : m_team(threads), m_threads(threads) {}

    // Runs the bodies' solveConstraints() with their contacts; their steps have a time above 0. Returns the time of
    // Bullet's part, ms.
    double solve(const std::vector<BodyContacts*>& bodies, const FoundContacts& found);
    // Solves bodies without contacts, whose links Drape solves.
    void solveFree(const std::vector<std::pair<btSoftBody*, SubstepBody*>>& bodies);

private:
    using Bodies = RoundsTeam::Bodies;

    void begin(const std::vector<BodyContacts*>& bodies, const FoundContacts& found);
    void applyLimits(const Bodies& bodies);
    double iterate();
    double solveLinks(int iteration);
    template <class Job>
    void forSubsteps(const Job& job);
    void runAgain(const Bodies& bodies);
    void holdOthers();
    void close();

    RoundsTeam m_team;
    ThreadTeam& m_threads;
    std::vector<std::unique_ptr<ContactRounds>> m_rounds;  // kept for their memory
    // Bodies of the step, bodies with contacts, and subsets of one iteration or sweep.
    Bodies m_all, m_touching, m_iterating, m_turn, m_open, m_resting, m_others, m_own;
};
}  // namespace drape
