// Runs a trial in a child process and turns what it streamed into a row.
//
// Every trial has a process of its own: Bullet's own collision can stall for minutes and take minutes to be
// destroyed.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/error_vs_time/trial.h"
#include "benchmarks/support/arguments.h"
#include "benchmarks/support/table.h"

namespace drape::bench
{
inline constexpr const char* kProgram = "error_vs_time";
inline constexpr const char* kDetectorPart = "detector";
inline constexpr const char* kSimulationPart = "simulation";
// The column with the reference of a row's hash: "defaults" of its scene on the host, or the "same" query.
inline constexpr const char* kMustMatch = "must_match";

struct ErrorOptions : CommonOptions
{
    std::string m_part;   // empty: all
    std::string m_truth;  // folder
    std::vector<std::string> m_scenes;
    std::vector<std::string> m_knobs;  // empty: all
    double m_capSeconds = 45;          // limit of the stepping time of one trial
    int m_frames = 0;                  // 0: as many as the kind of run has
    std::string m_childScene;          // in a child: what to run
    int m_childTrial = -1;
    bool m_childHasDevice = false;  // in a child: the parent's hasDevice(), so that both number the same list of trials

    int frames() const { return m_frames > 0 ? m_frames : m_quick ? 40 : 120; }
    std::vector<Trial> trials(bool withDevice) const { return makeTrials(m_quick, withDevice, frames()); }
};

// Returns true if Drape would run on a device and not on the host.
bool hasDevice(const ErrorOptions& options);

// Describes a trial that has not run or has failed. `why` says how it ended.
Row describeTrial(const std::string& scene, const Trial& trial, const std::string& why);

// A trial's row, and the cloth's positions at the end (x y z per node; empty if the trial did not reach it).
struct TrialResult
{
    Row m_row;
    std::vector<float> m_final;
    std::string m_hash;   // hash of the whole trajectory
    std::string m_error;  // one line when it could not be run
};

// Runs in the parent. `number` is the index of the trial; the child makes the same list.
TrialResult runTrial(const ErrorOptions& options, const std::string& scene, const Trial& trial, int number,
                     double capSeconds);

// Runs in the child, with the scene before the trial's changes. Returns only if the trial could not be started, with an
// exit code.
int streamTrial(const ErrorOptions& options, const ErrorScene& scene, const Trial& trial);

// Returns the RMS distance of the last positions of two runs, m.
double shapeDistance(const std::vector<float>& a, const std::vector<float>& b);
}  // namespace drape::bench
