// A scene under a trial's method and knobs in a Bullet world, a substep at a time.
//
// Beside what every simulation tells (see simulation.h): how fast the cloth still is at the end, and what energy came
// in.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "benchmarks/error_vs_time/trial.h"
#include "drape/settings.h"
#include "examples/cloth_drop/simulation.h"

namespace drape::bench
{
// What a trial does to its scene: thickness and time step.
DropScene sceneOf(const ErrorScene& scene, const Trial& trial);

class TrialSimulation : public Simulation
{
public:
    // RMS speed (m/s) of the nodes after each step.
    virtual const std::vector<double>& speeds() const = 0;
    // Kinetic energy and that of height (J) after each step; what the springs hold is not in it.
    virtual const std::vector<double>& energies() const = 0;
    // Nodes that went through the obstacle's surface in any step so far.
    virtual std::size_t crossed() const = 0;
};

// settings: of Drape, but for what the trial sets. Null with one line in `error` when Drape cannot start.
std::unique_ptr<TrialSimulation> makeTrialSimulation(const ErrorScene& scene, const Trial& trial, Settings settings,
                                                     std::string& error);
}  // namespace drape::bench
