// Runs a trial in a child process and turns what it streamed into a row.
//
// Every trial has a process of its own: Bullet's built-in collision can stall for minutes and take minutes to be
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
// Column: whose hash on the host a row must have, "defaults" of its scene or the "same" query's.
inline constexpr const char* kMustMatch = "must_match";

struct ErrorOptions : CommonOptions
{
    std::string m_part;   // empty: all
    std::string m_truth;  // folder
    std::vector<std::string> m_scenes;
    std::vector<std::string> m_knobs;  // empty: all
    double m_capSeconds = 45;          // of stepping, for one trial
    int m_frames = 0;                  // 0: as many as the kind of run has
    std::string m_childScene;          // in a child: what to run
    int m_childTrial = -1;

    int frames() const { return m_frames > 0 ? m_frames : m_quick ? 40 : 120; }
    std::vector<Trial> trials(bool withDevice) const { return makeTrials(m_quick, withDevice, frames()); }
};

// Whether Drape would run on a device, and not on the host.
bool hasDevice(const ErrorOptions& options);

// What a row says of itself before, and instead of, being run. why: how it ended.
Row describeTrial(const std::string& scene, const Trial& trial, const std::string& why);

// A trial's row, and where the cloth was at the end (x y z per node; empty when the trial did not get there).
struct TrialResult
{
    Row m_row;
    std::vector<float> m_final;
    std::string m_hash;   // of the whole course
    std::string m_error;  // one line when it could not be run
};

// In the parent. number: of the trial, as the child makes the same list.
TrialResult runTrial(const ErrorOptions& options, const std::string& scene, const Trial& trial, int number,
                     double capSeconds);

// In the child, with the scene as it is without the trial: does not return but with an exit code for what could not be
// started.
int streamTrial(const ErrorOptions& options, const ErrorScene& scene, const Trial& trial);

// RMS distance of two courses' last positions, m.
double shapeDistance(const std::vector<float>& a, const std::vector<float>& b);
}  // namespace drape::bench
