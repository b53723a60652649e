// Wind on cloth. Bullet's own (btSoftBody::setWindVelocity) gives a node no more speed than it has, so that it never
// moves cloth at rest.
#pragma once

#include <BulletSoftBody/btSoftBody.h>

#include "scenes/cloth_scene.h"

namespace drape
{
// Adds the forces of the wind for a step of dt seconds. A face feels the pressure of the relative wind along its normal
// (m/s), ½ ρ c v², as a flat plate does. No face is made faster than the wind. Cost: linear in the faces.
void addWind(btSoftBody& body, const SceneWind& wind, double dt);
}  // namespace drape
