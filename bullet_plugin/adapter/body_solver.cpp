#include "bullet_plugin/adapter/body_solver.h"

#include <algorithm>

#include "bullet_plugin/adapter/stopwatch.h"

namespace drape
{
namespace
{
// Bullet's position iterations may be run one by one: each call derives the velocities anew from the step's start, and
// nothing else that a call does adds up.
bool iterationsCanBeSplit(const btSoftBody& body)
{
    return body.m_cfg.viterations == 0 && body.m_cfg.diterations == 0 && body.m_clusters.size() == 0 &&
           body.m_joints.size() == 0;
}

// Returns the time of Bullet's part, ms.
double solveWithBullet(BodyContacts& contacts, ContactRounds& rounds)
{
    btSoftBody& body = *contacts.m_body;
    double bulletMs = 0;
    const int iterations = body.m_cfg.piterations;
    const bool split = iterations > 1 && iterationsCanBeSplit(body);
    if (split) body.m_cfg.piterations = 1;
    for (int i = 0; i < (split ? iterations : 1); ++i)
    {
        if (i > 0) contacts.m_limit.apply(body);
        rounds.restart();  // what contacts pushed before the links' last pull is the links' business now
        rounds.runAndSettle();
        Stopwatch watch;
        body.solveConstraints();
        bulletMs += watch.lapMs();
    }
    body.m_cfg.piterations = iterations;
    return bulletMs;
}

void close(BodyContacts& contacts, ContactRounds& rounds)
{
    btSoftBody& body = *contacts.m_body;
    MotionLimit& limit = contacts.m_limit;
    limit.apply(body);
    if (rounds.empty()) return;
    rounds.restart();
    const btScalar tolerance = kClosingTolerance * contacts.m_leastThickness;
    btScalar worst = rounds.run();
    for (int i = 1; i < kClosingRounds && worst > tolerance; ++i)
    {
        limit.apply(body);
        worst = rounds.run();
    }
    // What does not converge is left to the faces and edges, which a node outside the obstacle keeps from passing in a
    // later step.
    if (worst > tolerance) rounds.runNodes();
    rounds.limitSpeeds();
}
}  // namespace

double solveBody(BodyContacts& contacts, const FoundContacts& found, ContactRounds& rounds)
{
    rounds.start(contacts, found);
    const double bulletMs = solveWithBullet(contacts, rounds);
    close(contacts, rounds);
    return bulletMs;
}
}  // namespace drape
