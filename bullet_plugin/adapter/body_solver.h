// One step of some bodies: Bullet's own solver for everything that Bullet knows (links, anchors, its own contacts), and
// rounds over Drape's contacts between its iterations and after them.
//
// Why not btSoftBody::RContact and SContact: Bullet's solver never takes back what an RContact pushed, and its
// SContact, once it acts, pulls as well as it pushes. Cloth of 33 x 33 nodes draped over a sphere then stirs for ever:
// measured, 17 mm/s (RMS) with both, 6 with RContacts alone, less than 1 so. Bullet's default sequence also ends with
// its links, which pull nodes back in.
//
// Between the iterations, too, nodes go no farther from their paths than the motion limit allows: a contact at the edge
// of detection's reach then has no say, whether it was found or not. Without it links pull nodes of stretched cloth
// several times as far in an iteration, contacts that come and go at the edge of the reach take turns to push, and
// cloth at rest on the bunny stirs at up to 2.6 mm/s (RMS) for ever; with it, at 0.3 over 2,000 steps, a slip of 2.5
// among them.
//
// All bodies do an iteration before any does the next: the rounds of all are shared by the threads of a team, Bullet's
// part is the caller's, a body at a time, those without contacts of Drape's before all others. That differs from
// Bullet's own order only where bodies act on each other: by anchors or rigid contacts on one rigid body, or by soft
// contacts.
//
// Guarantee: at the end no contact is violated by more than kClosingTolerance where kClosingRounds suffice. Where they
// leave as much as the next step would recover, rounds go on: else cloth that hangs on one corner of an obstacle by a
// single face comes nearer to it with every step, and is impaled in the end. The same bits with any number of threads.
// A body with clusters or joints is given to Bullet in one piece, the rounds before and after it.
// Cost: linear in the contacts, piterations + kClosingRounds rounds as a rule, an iteration more with piterations 1,
// mostClosingRounds() instead at most, and those that settle what has pushed.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "bullet_plugin/adapter/body_contacts.h"
#include "bullet_plugin/adapter/contact_rounds.h"
#include "bullet_plugin/adapter/found_contacts.h"

namespace drape
{
constexpr int kClosingRounds = 8;

// Least iterations of Bullet for a body with contacts whose iterations can be run one by one. What a single pass over
// links and contacts leaves becomes velocity, and where a pass overshoots, the next step undoes it and leaves as much
// on the other side: cloth of 33 x 33 nodes on a sphere stirs at 600 mm/s for ever with one pass, at 2 with two.
constexpr int kLeastIterations = 2;

// Beyond these as many rounds as look at that many blocks of contacts, a millisecond or two: a body with few contacts
// may take more rounds. Between the least and the most.
constexpr std::size_t kFurtherLooks = std::size_t(1) << 16;
constexpr std::size_t kLeastFurther = 24, kMostFurther = 120;

// Worst violation that may be left, as a share of the thickness: after fewer than kClosingRounds, and after these. The
// second is less than what the next step recovers, since a round's later contacts may make worse what it met.
constexpr btScalar kClosingTolerance = btScalar(0.01);
constexpr btScalar kMostViolation = btScalar(0.0625);
static_assert(kMostViolation < kRecoveredShare, "else cloth comes nearer from step to step");

// Runs Bullet's own solver for the body, in the floating-point environment of the app.
void solveByBullet(btSoftBody& body);

class BodySolver
{
public:
    explicit BodySolver(ThreadTeam& threads) : m_team(threads) {}

    // Runs the bodies' solveConstraints() with their contacts; their steps have a time above 0. Returns the time of
    // Bullet's part, ms.
    double solve(const std::vector<BodyContacts*>& bodies, const FoundContacts& found);

private:
    using Bodies = RoundsTeam::Bodies;

    void begin(const std::vector<BodyContacts*>& bodies, const FoundContacts& found);
    void applyLimits(const Bodies& bodies);
    double iterate();
    void runAgain(const Bodies& bodies);
    void holdOthers();
    void close();

    RoundsTeam m_team;
    std::vector<std::unique_ptr<ContactRounds>> m_rounds;  // kept for their memory
    // Of the step; of these those with contacts, and those of one iteration or round.
    Bodies m_all, m_touching, m_iterating, m_turn, m_open, m_resting, m_others;
};
}  // namespace drape
