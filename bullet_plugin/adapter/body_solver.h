// One step of one body: Bullet's own solver for everything that Bullet knows (links, anchors, its own contacts), and
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
// Guarantee: at the end no contact is violated by more than kClosingTolerance where kClosingRounds suffice. A body with
// velocity or drift iterations or clusters is given to Bullet in one piece, the rounds before and after it. Cost:
// linear in the contacts, piterations + kClosingRounds rounds at most, and those that settle what has pushed.
#pragma once

#include "bullet_plugin/adapter/body_contacts.h"
#include "bullet_plugin/adapter/contact_rounds.h"
#include "bullet_plugin/adapter/found_contacts.h"

namespace drape
{
constexpr int kClosingRounds = 8;

// Worst violation that may be left, as a share of the thickness.
constexpr btScalar kClosingTolerance = btScalar(0.01);

// Runs the body's solveConstraints() with its contacts; its step has a time above 0. Returns the time of Bullet's part,
// ms.
double solveBody(BodyContacts& contacts, const FoundContacts& found, ContactRounds& rounds);
}  // namespace drape
