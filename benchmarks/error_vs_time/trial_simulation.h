// A scene under a trial's method and knobs in a Bullet world, a substep at a time.
//
// Beside what every simulation tells (see simulation.h): how fast the cloth still is at the end, and what energy it
// has. Places are as the obstacle sees them, whether it moves or not.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "benchmarks/error_vs_time/trial.h"
#include "drape/settings.h"
#include "tools/cloth_drop/simulation.h"

namespace drape::bench
{
// The energies of a cloth after a step, J.
struct ClothEnergy
{
    double m_motion = 0;  // kinetic and of height
    // Upper bound of the energy that the links can turn into motion. Links are no springs with an energy of their own.
    // In each iteration Bullet's solver moves a link's ends together by a share of its stretch. In a step of dt the
    // ends get at most the speed (1 - (1 - stiffness)^iterations) stretch / dt.
    double m_links = 0;
};

// Applies a trial to its scene: fall, thickness and time step.
ErrorScene sceneOf(const ErrorScene& scene, const Trial& trial);

class TrialSimulation : public Simulation
{
public:
    // Returns the RMS speed (m/s) of the nodes after each step, relative to the obstacle.
    virtual const std::vector<double>& speeds() const = 0;
    // Returns the energies after each step.
    virtual const std::vector<ClothEnergy>& energies() const = 0;
    // Returns the number of nodes that went through the obstacle's surface in any step so far.
    virtual std::size_t crossed() const = 0;
};

// Makes the simulation of a scene from sceneOf(). `settings` are Drape's, apart from the trial's own. Returns null with
// one line in `error` if Drape cannot start.
std::unique_ptr<TrialSimulation> makeTrialSimulation(const ErrorScene& scene, const Trial& trial, Settings settings,
                                                     std::string& error);
}  // namespace drape::bench
