// The closing pass: after Bullet's solver, moves cloth that is too close to an obstacle out to its resting distance.
//
// Why: Bullet's default sequence solves links after contacts, so that it ends with links having pulled nodes back in,
// and contacts that its solver was not given (not violated at the predicted end) may be violated by then. Input: a body
// that Bullet has solved, all its contacts, violated or not, and the limit of its motion, which is applied before each
// round. Method: Gauss-Seidel rounds of exact unilateral projection, C = n.(sum w_i x_i - p) - thickness - target >= 0,
// weighted by inverse mass (Müller et al. 2007, Position Based Dynamics, section 3.3, with unilateral constraints).
// Velocities follow as in Bullet's own update, (x change)/dt (1 - kDP), but no contact leaves faster along its normal
// than it did before the pass: the pass adds no energy. Pinned, massless and anchored nodes stay. Cost: linear in the
// contacts, at most kClosingRounds rounds.
#pragma once

#include <vector>

#include "bullet_plugin/adapter/motion_limit.h"
#include "bullet_plugin/adapter/step_contact.h"

namespace drape
{
constexpr int kClosingRounds = 8;

// Worst violation that may be left, as a share of the thickness.
constexpr btScalar kClosingTolerance = btScalar(0.01);

// Returns the worst violation met in the last round, m; at most the tolerance when the rounds sufficed.
btScalar closeContacts(btSoftBody& body, std::vector<StepContact>& contacts, const MotionLimit& limit);
}  // namespace drape
