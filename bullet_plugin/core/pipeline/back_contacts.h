// Removes contacts on the back of obstacles that are solid from one side only (MeshDescription::m_oneSided). The
// winding of an obstacle's triangles defines its front. A contact is on the back if its normal points there, or if the
// cloth meets the surface on a path that leads away from the front. O(contacts) if there is such an obstacle.
#pragma once

#include "bullet_plugin/core/backends/step_result.h"
#include "bullet_plugin/core/scene/scene.h"

namespace drape
{
// Returns whether there is such an obstacle. O(obstacles).
bool hasOneSided(const Scene& scene);
void removeBackContacts(const Scene& scene, StepResult& result);
}  // namespace drape
