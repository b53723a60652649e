// The whole stepSimulation as a method of bench_step. Built where Bullet is there.
#pragma once

#include <memory>
#include <string>

#include "benchmarks/support/step_method.h"

namespace drape::bench
{
// Makes the method that steps a Bullet world with the scene's cloths and obstacle, with Bullet's default links. Its
// stages are the whole step and its parts as cloth_drop names them. It has no hash: the cloths move freely.
std::unique_ptr<StepMethod> makeWorldMethod(const StepScene& scene, const Settings& settings, std::string& error);
}  // namespace drape::bench
