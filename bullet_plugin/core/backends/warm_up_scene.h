// Makes a scene of one triangle that falls onto another, for a back end's first launches.
#pragma once

#include "bullet_plugin/core/lists/step_pairs.h"
#include "bullet_plugin/core/scene/scene.h"

namespace drape
{
// scene: a new one. selfThickness: m, of the cloth with itself, 0 for none.
void makeWarmUpScene(Scene& scene, StepPairs& pairs, float selfThickness);
}  // namespace drape
