// Boxes around a kept body's nodes in its coming step (KeptBoxes).
#pragma once

#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/core/lists/kept_step.h"

namespace drape
{
// Returns the boxes of the coming step, for the time and the gravity of the step before. nodes: the body's, as they are
// stored. Linear in the nodes.
KeptBoxes boxesAround(const btSoftBody& body, const KeptStep& step, const std::vector<KeptNode>& nodes);
}  // namespace drape
