// Steps a simulation, measures after every step (outside of the step's time), writes frames and tells the caller.
#pragma once

#include <functional>
#include <string>

#include "tools/cloth_drop/run_record.h"

namespace drape
{
struct RunHooks  // any may be empty
{
    std::function<bool()> m_goesOn;                           // asked after each step but the last
    std::function<void(int)> m_beforeStep;                    // step from 1
    std::function<void(int)> m_stepped;                       // stepped, not measured yet
    std::function<void(int, const StepRecord&)> m_afterStep;  // measured too
    std::function<void(const Recording&)> m_recorded;         // with m_records: a frame more, before m_afterStep
    bool m_records = false;                                   // keeps the run's frames in RunRecord::m_recording
};

// Returns a record without steps: the sizes of the run, and its obstacles at the start.
RunRecord recordOf(const RunSubject& subject);

// Runs the simulation. A run that is stopped is capped at its last step. Returns false, with one line in `error`, if a
// frame could not be written; the record then has the steps until that frame. An empty `framesFolder` writes no frames.
// It gets obstacle.ply for the start, cloth_NNNN.ply for every step, and obstacle_NNNN.ply if obstacles move.
bool runSimulation(Simulation& simulation, const RunSubject& subject, int steps, const std::string& framesFolder,
                   const RunHooks& hooks, RunRecord& record, std::string& error);
}  // namespace drape
