// One step of one body: Bullet's own solver for everything that Bullet knows (links, anchors, its own contacts), and
// rounds over Drape's contacts between its iterations and after them.
//
// Why not btSoftBody::RContact and SContact: measured on cloth draped over a sphere, Bullet's solver never takes back
// what an RContact pushed and its SContact, once it acts, pulls as well as it pushes; cloth then stirs for ever, at 20
// mm/s with both and 1 to 7 mm/s with RContacts alone, against less than 1 mm/s so. Bullet's default sequence also ends
// with its links, which pull nodes back in.
//
// Guarantee: at the end no contact is violated by more than kClosingTolerance where kClosingRounds suffice. A body with
// velocity or drift iterations or clusters is given to Bullet in one piece, the rounds before and after it. Cost:
// linear in the contacts, piterations + kClosingRounds rounds at most.
#pragma once

#include "bullet_plugin/adapter/collision_step.h"

namespace drape
{
constexpr int kClosingRounds = 8;

// Worst violation that may be left, as a share of the thickness.
constexpr btScalar kClosingTolerance = btScalar(0.01);

// Runs the body's solveConstraints() with its contacts. Returns the time of all but Bullet's part, ms.
double solveBody(BodyContacts& body);
}  // namespace drape
