// Keeps the momentum of cloth that no obstacle touches.
//
// Links correct positions along their current direction, which takes angular momentum from a cloth that turns. Rounding
// of small corrections takes a little of both momenta. At the end of a step keepMomentum() gives the nodes' velocities
// the missing momentum, as a motion of a rigid body. Output: velocities; positions stay. The same bits on any number of
// threads. Cost: two passes over the nodes. Reasons: docs/design_notes/momentum.md.
#pragma once

#include "bullet_plugin/core/solver/solver_cloth.h"

namespace drape
{
// Returns whether keepMomentum() applies to the cloth. The core must solve its links, no obstacle may be so near that
// it limits the motion, and rigid bodies that the cloth touches or hangs on must be dynamic.
bool keepsMomentum(const SolverCloth& cloth);

// Corrects the momentum after a step, if keepsMomentum(). Does nothing if a node is fixed or a velocity is not finite.
void keepMomentum(const SolverCloth& cloth);
}  // namespace drape
