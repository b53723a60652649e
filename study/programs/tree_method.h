// A step over trees of triangles (study/step/tree_step.h) as a way of doing a benchmark's step.
#pragma once

#include <memory>
#include <string>

#include "benchmarks/support/step_method.h"
#include "study/methods.h"

namespace drape::bench
{
// On the host or on the device that the settings name; cloths do not collide with themselves. Null, with error filled,
// where the device cannot be had. The scene outlives the method.
std::unique_ptr<StepMethod> makeTreeMethod(const StepScene& scene, const Settings& settings, const Methods& methods,
                                           std::string& error);
}  // namespace drape::bench
