// Steps a simulation, measures after every step (outside of the step's time), writes frames and tells the caller.
#pragma once

#include <functional>
#include <string>

#include "examples/cloth_drop/run_record.h"

namespace drape
{
struct RunHooks  // any may be empty
{
    std::function<bool()> m_goesOn;                           // asked after each step but the last
    std::function<void(int)> m_beforeStep;                    // step from 1
    std::function<void(int)> m_stepped;                       // stepped, not measured yet
    std::function<void(int, const StepRecord&)> m_afterStep;  // measured too
};

// A run that does not go on is capped at its last step. False, with one line in `error`, when a frame could not be
// written; that ends the run, whose record has the steps done. `framesFolder` empty: no frames.
bool runSimulation(Simulation& simulation, const DropScene& scene, int steps, const std::string& framesFolder,
                   const RunHooks& hooks, RunRecord& record, std::string& error);
}  // namespace drape
