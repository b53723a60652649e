// error_vs_time: what a frame costs against how wrong the cloth is, scene by scene, for Drape's knobs and for Bullet's
// built-in collision at equal simulated time.
//
// Each trial runs the whole scene in Bullet. Times are of stepSimulation, a frame of 1/60 s at a time, without
// measuring. Errors come from the independent check (scenes/measure.h). Drape on a device must give the host's course,
// bit for bit: a row whose hash differs is void, and the program ends with 3.
#include <algorithm>
#include <iostream>

#include "benchmarks/error_vs_time/trial_run.h"
#include "benchmarks/support/models.h"
#include "benchmarks/support/samples.h"
#include "drape/report.h"

namespace drape::bench
{
namespace
{
const char* const kProgram = "error_vs_time";

// Whether Drape would run on a device, and not on the host.
bool hasDevice(const ErrorOptions& options)
{
    return options.m_backend != "host" && options.m_device != "host" && !listDevices().empty();
}

bool contains(const std::vector<std::string>& list, const std::string& text)
{
    return std::find(list.begin(), list.end(), text) != list.end();
}

// Defaults are always run: the others are compared with them.
bool wanted(const ErrorOptions& options, const Trial& trial)
{
    return options.m_knobs.empty() || trial.m_knob == "defaults" || contains(options.m_knobs, trial.m_knob);
}

// What the trials of a scene are judged by.
struct SceneState
{
    std::string m_name;
    bool m_symmetric = false;
    std::string m_hash;              // of the host's defaults
    std::vector<float> m_reference;  // positions at the end of the reference
    std::vector<TrialResult> m_results;
};

void judge(SceneState& state)
{
    for (TrialResult& result : state.m_results)
    {
        const bool defaults = result.m_row["knob"] == "defaults" && result.m_row["method"] != "bullet";
        if (defaults && !result.m_hash.empty()) judgeRow(result.m_row, state.m_hash);
        if (state.m_symmetric && result.m_final.size() == state.m_reference.size() && !result.m_final.empty())
            result.m_row["shape_error"] = shapeDistance(result.m_final, state.m_reference) / kThickness;
    }
}

void say(const TrialResult& result)
{
    const Row& row = result.m_row;
    const auto text = [&](const char* key) { return row.contains(key) ? row.at(key).dump() : std::string("-"); };
    std::cerr << text("scene") << ' ' << text("method") << ' ' << text("knob") << ' ' << text("value") << ": "
              << text("ended") << ", frame " << text("frame_median_ms") << " ms, penetration "
              << text("penetration_max") << ", pairs " << text("intersecting_end") << ", through "
              << text("nodes_through") << ", rest " << text("rest_speed_mm_s") << " mm/s " << result.m_error
              << std::endl;
}

int measure(const ErrorOptions& options)
{
    const Clock::time_point begin = Clock::now();
    const std::vector<Trial> trials = makeTrials(options.m_quick, hasDevice(options));
    const std::vector<std::string> folders = modelFolders(options.m_models);
    std::vector<SceneState> scenes;
    bool good = true;
    for (const std::string& name : options.m_scenes.empty() ? errorSceneNames(options.m_quick) : options.m_scenes)
    {
        ErrorScene scene;
        std::string error;
        if (makeErrorScene(name, options.m_quick, folders, scene, error))
        {
            scenes.emplace_back();
            scenes.back().m_name = name;
            scenes.back().m_symmetric = scene.m_symmetric;
        }
        else
            good = fail(kProgram, kExitFailed, error) == kExitGood;
    }
    // A trial on every scene, then the next: what does not fit into the time is left out everywhere alike.
    for (std::size_t i = 0; i < trials.size(); ++i)
    {
        for (SceneState& scene : scenes)
        {
            if (!wanted(options, trials[i])) continue;
            const double left = 60 * options.m_minutes - millisecondsSince(begin) / 1000;
            if (left < 1)
            {
                std::cerr << kProgram << ": left out, the time is used up: " << scene.m_name << ' '
                          << trials[i].method() << ' ' << trials[i].m_knob << ' ' << trials[i].m_value << std::endl;
                good = false;
                continue;
            }
            TrialResult result =
                runTrial(options, scene.m_name, trials[i], int(i), std::min(options.m_capSeconds, left));
            if (trials[i].m_method == Method::DrapeHost && trials[i].m_knob == "defaults") scene.m_hash = result.m_hash;
            if (trials[i].m_knob == "reference") scene.m_reference = result.m_final;
            say(result);
            good = good && result.m_error.empty();
            scene.m_results.push_back(std::move(result));
        }
    }
    Table table;
    for (SceneState& scene : scenes)
    {
        judge(scene);
        for (const TrialResult& result : scene.m_results)
            table.add(result.m_row);
    }
    const int code = finishTable(kProgram, table, options);
    return code != kExitGood ? code : good ? kExitGood : kExitFailed;
}

int runChild(const ErrorOptions& options)
{
    const std::vector<Trial> trials = makeTrials(options.m_quick, hasDevice(options));
    ErrorScene scene;
    std::string error;
    if (std::size_t(options.m_childTrial) >= trials.size()) return fail(kProgram, kExitBadInput, "no such trial");
    if (!makeErrorScene(options.m_childScene, options.m_quick, modelFolders(options.m_models), scene, error))
        return fail(kProgram, kExitBadInput, error);
    return streamTrial(options, scene, trials[std::size_t(options.m_childTrial)]);
}

int list(const ErrorOptions& options)
{
    for (const std::string& name : errorSceneNames(options.m_quick))
        std::cout << "scene " << name << "\n";
    for (const Trial& trial : makeTrials(options.m_quick, hasDevice(options)))
        std::cout << "trial " << trial.method() << ' ' << trial.m_knob << ' ' << trial.m_value << "\n";
    return kExitGood;
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    using namespace drape::bench;
    CLI::App app("What a frame costs against how wrong the cloth is.", kProgram);
    ErrorOptions options;
    addCommonOptions(app, options);
    app.add_option("--scene", options.m_scenes, "only these (repeat it); --list names them");
    app.add_option("--knob", options.m_knobs, "only these besides the defaults (repeat it); --list names them");
    app.add_option("--cap", options.m_capSeconds, "seconds of stepping for one trial")->check(CLI::PositiveNumber);
    app.add_option("--frames", options.m_frames, "frames of 1/60 s; 0: 240, or 40 of a quick run")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--child-scene", options.m_childScene)->group("");
    app.add_option("--child-trial", options.m_childTrial)->group("");
    int exitCode = kExitGood;
    if (!parseArguments(app, argc, argv, exitCode)) return exitCode;
    return guarded(kProgram,
                   [&]
                   {
                       if (options.m_list) return list(options);
                       return options.m_childScene.empty() ? measure(options) : runChild(options);
                   });
}
