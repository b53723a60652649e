// A step of one triangle over another, for a back end's first launches.
#pragma once

#include "step.h"

namespace drape
{
// scene, pairs: new ones. selfThickness: m, of the cloth with itself, 0 for none.
void makeWarmUpStep(Scene& scene, StepPairs& pairs, float selfThickness);
}  // namespace drape
