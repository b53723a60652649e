#include "benchmarks/error_vs_time/simulation_part.h"

#include <algorithm>
#include <iostream>

#include "scenes/models.h"
#include "benchmarks/support/samples.h"

namespace drape::bench
{
namespace
{
// The remaining runs of Bullet's collision on a scene are left out after this many consecutive runs that stalled.
constexpr int kHopeless = 3;
// Drape's rest trials have twenty times the frames of others, and get this multiple of their time.
constexpr double kRestCaps = 3;

// The reference data that the trials of a scene are judged by.
struct SceneState
{
    std::string m_name;
    bool m_symmetric = false;
    bool m_moves = false;            // the obstacle does
    std::string m_hash;              // hash of Drape's defaults, on the host if that run was complete
    std::vector<float> m_reference;  // positions at the end of the reference
    std::vector<TrialResult> m_results;
    std::vector<bool> m_sameContacts;  // one flag for each of m_results
    int m_stalled = 0;                 // Bullet's latest trials that stalled, without one that did not

    void add(TrialResult result, const Trial& trial)
    {
        m_results.push_back(std::move(result));
        m_sameContacts.push_back(trial.isDrape() && trial.m_sameContacts);
    }
};

bool contains(const std::vector<std::string>& list, const std::string& text)
{
    return std::find(list.begin(), list.end(), text) != list.end();
}

// Defaults are always run, and the reference where shapes are compared: the others are compared with them. On what goes
// on rising nothing comes to rest: after 2,000 frames of the plate's a float's last place is worth millimetres a
// second.
bool wanted(const ErrorOptions& options, const SceneState& scene, const Trial& trial)
{
    if (scene.m_moves && trial.m_knob == "rest") return false;
    if (trial.m_knob == "defaults" || (trial.m_knob == "reference" && scene.m_symmetric)) return true;
    return options.m_knobs.empty() || contains(options.m_knobs, trial.m_knob);
}

void judge(SceneState& state)
{
    for (std::size_t i = 0; i < state.m_results.size(); ++i)
    {
        TrialResult& result = state.m_results[i];
        // The runs have equal time steps and the same fall.
        const bool comparable =
            state.m_symmetric && !result.m_row.value("seed", 0) && result.m_row.value("knob", "") != "rest";
        if (comparable && result.m_final.size() == state.m_reference.size() && !result.m_final.empty())
            result.m_row["shape_error"] = shapeDistance(result.m_final, state.m_reference) / kThickness;
        if (state.m_sameContacts[i] && !result.m_hash.empty()) judgeRow(result.m_row, state.m_hash);
    }
}

void say(const TrialResult& result)
{
    const Row& row = result.m_row;
    const auto text = [&](const char* key) { return row.contains(key) ? row.at(key).dump() : std::string("-"); };
    std::cerr << text("scene") << ' ' << text("method") << ' ' << text("knob") << ' ' << text("value") << ' '
              << text("setting") << ": " << text("ended") << ", frame " << text("frame_median_ms")
              << " ms, penetration " << text("penetration_max") << ", pairs " << text("intersecting_max")
              << ", through " << text("nodes_through") << ' ' << result.m_error << std::endl;
}

// Runs the trial, or says why not. False when something went wrong.
bool runOrLeave(const ErrorOptions& options, SceneState& scene, const Trial& trial, int number, double secondsLeft)
{
    TrialResult result;
    const double cap = options.m_capSeconds * (trial.isDrape() && trial.m_knob == "rest" ? kRestCaps : 1);
    const bool hopeless = !trial.isDrape() && scene.m_stalled >= kHopeless;
    bool fits = secondsLeft >= 1;
    if (!hopeless && fits)
    {
        result = runTrial(options, scene.m_name, trial, number, std::min(cap, secondsLeft));
        // The trial did not stall: the time of the whole program ended.
        fits = secondsLeft >= cap || result.m_row["ended"] != "capped";
    }
    if (hopeless || !fits) result.m_row = describeTrial(scene.m_name, trial, hopeless ? "left out" : "no time");
    const bool capped = result.m_row["ended"] == "capped";
    if (!trial.isDrape() && !hopeless) scene.m_stalled = capped ? scene.m_stalled + 1 : 0;
    if (trial.m_knob == "defaults" && trial.isDrape() && scene.m_hash.empty()) scene.m_hash = result.m_hash;
    if (trial.m_knob == "reference") scene.m_reference = result.m_final;
    say(result);
    const bool good = result.m_error.empty() && (hopeless || fits);
    scene.add(std::move(result), trial);
    return good;
}

bool makeStates(const ErrorOptions& options, std::vector<SceneState>& scenes)
{
    bool good = true;
    for (const std::string& name : options.m_scenes.empty() ? errorSceneNames(options.m_quick) : options.m_scenes)
    {
        ErrorScene scene;
        std::string error;
        if (makeErrorScene(name, options.m_quick, modelFolders(options.m_models), scene, error))
        {
            scenes.emplace_back();
            scenes.back().m_name = name;
            scenes.back().m_symmetric = scene.m_symmetric;
            scenes.back().m_moves = scene.m_rise != 0;
        }
        else
            good = fail(kProgram, kExitFailed, error) == kExitGood;
    }
    return good;
}
}  // namespace

bool measureSimulations(const ErrorOptions& options, Table& table)
{
    const Clock::time_point begin = Clock::now();
    const std::vector<Trial> trials = options.trials(hasDevice(options));
    std::vector<SceneState> scenes;
    bool good = makeStates(options, scenes);
    // Each round runs on one scene after the other. If the time is short, the later values of every setting are left
    // out before a scene or a setting.
    for (int round = 0; round < roundsOf(trials); ++round)
    {
        for (SceneState& scene : scenes)
        {
            for (std::size_t i = 0; i < trials.size(); ++i)
            {
                if (trials[i].m_round != round || !wanted(options, scene, trials[i])) continue;
                const double left = 60 * options.m_minutes - millisecondsSince(begin) / 1000;
                good = runOrLeave(options, scene, trials[i], int(i), left) && good;
            }
        }
    }
    for (SceneState& scene : scenes)
    {
        judge(scene);
        for (const TrialResult& result : scene.m_results)
            table.add(result.m_row);
    }
    return good;
}
}  // namespace drape::bench
