// Removes contacts on the back of obstacles that are solid from one side only (MeshDescription::m_oneSided). The
// winding of an obstacle's triangles defines its front. O(contacts) if there is such an obstacle.
#pragma once

#include "bullet_plugin/core/backends/step_result.h"
#include "bullet_plugin/core/scene/mesh_pool.h"

namespace drape
{
void removeBackContacts(const MeshPool& obstacles, StepResult& result);
}  // namespace drape
