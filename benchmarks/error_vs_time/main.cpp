// error_vs_time: measures the cost of a frame against the error of the cloth, and the cost of a query against the error
// of its answer.
//
// Measures each scene with Drape's settings and with Bullet's own collision at equal simulated time. Each trial
// runs the whole scene in Bullet. Times are of stepSimulation, a frame of 1/60 s at a time, without the checks. Errors
// of cloth come from the independent check (oracle/measure.h), errors of queries from exact answers. Drape on a device
// must give the host's trajectory and answers, bit for bit. A row whose hash differs is void, and the program ends with
// 3.
#include <algorithm>
#include <iostream>

#include <CLI/CLI.hpp>

#include "benchmarks/error_vs_time/detector_part.h"
#include "benchmarks/error_vs_time/simulation_part.h"
#include "scenes/models.h"
#include "benchmarks/support/samples.h"

namespace drape::bench
{
namespace
{
// Scenes and knobs are the simulations'.
bool partWanted(const ErrorOptions& options, const std::string& part)
{
    if (!options.m_part.empty()) return options.m_part == part;
    return part == kSimulationPart || (options.m_scenes.empty() && options.m_knobs.empty());
}

int measure(ErrorOptions options)
{
    const Clock::time_point begin = Clock::now();
    Table table;
    bool good = true;
    if (partWanted(options, kDetectorPart)) good = measureDetector(options, table);
    options.m_minutes -= millisecondsSince(begin) / 60000;
    if (partWanted(options, kSimulationPart)) good = measureSimulations(options, table) && good;
    const int code = finishTable(kProgram, table, options);
    return code != kExitGood ? code : good ? kExitGood : kExitFailed;
}

std::string nameProblem(const ErrorOptions& options)
{
    std::vector<std::string> knobs;
    for (const Trial& trial : options.trials(true))
        if (std::find(knobs.begin(), knobs.end(), trial.m_knob) == knobs.end()) knobs.push_back(trial.m_knob);
    const std::string problem = unknownName("--scene", options.m_scenes, errorSceneNames(false));
    return problem.empty() ? unknownName("--knob", options.m_knobs, knobs) : problem;
}

int runChild(const ErrorOptions& options)
{
    const std::vector<Trial> trials = options.trials(options.m_childHasDevice);
    ErrorScene scene;
    std::string error;
    if (std::size_t(options.m_childTrial) >= trials.size())
        return fail(kProgram, kExitBadInput, "there is no trial of this number");
    if (!makeErrorScene(options.m_childScene, options.m_quick, modelFolders(options.m_models), scene, error))
        return fail(kProgram, kExitBadInput, error);
    return streamTrial(options, scene, trials[std::size_t(options.m_childTrial)]);
}

int list(const ErrorOptions& options)
{
    for (const std::string& name : errorSceneNames(options.m_quick))
        std::cout << "scene " << name << "\n";
    for (const Trial& trial : options.trials(hasDevice(options)))
        std::cout << "trial " << trial.method() << ' ' << trial.m_knob << ' ' << trial.m_value << ' ' << trial.m_setting
                  << "\n";
    return kExitGood;
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    using namespace drape;
    using namespace drape::bench;
    CLI::App app(
        "Measures the cost of a frame against the error of the cloth, and of a query against the error of its answer.",
        kProgram);
    ErrorOptions options;
    addCommonOptions(app, options);
    acceptOnly(app.add_option("--part", options.m_part,
                              "measure only this part (default: both; with --scene or --knob the simulations)"),
               {kDetectorPart, kSimulationPart});
    app.add_option("--scene", options.m_scenes, "measure only these scenes; --list names them");
    app.add_option("--knob", options.m_knobs, "measure only these settings besides the defaults; --list names them");
    app.add_option("--cap", options.m_capSeconds, "time limit for the stepping of one trial, s")
        ->check(CLI::Validator(numberAbove(0, false, "more than 0"), ""));
    app.add_option("--frames", options.m_frames,
                   "number of frames of 1/60 s; 0: 120, or 40 with --quick; rest trials have a number of their own")
        ->check(CLI::Validator(wholeNumber(0, 1000000000), ""));
    app.add_option("--truth", options.m_truth,
                   "folder of ccd_queries.bin and triangle_pairs.bin (default: DRAPE_TRUTH_DIR); without it only "
                   "queries made by this program are answered")
        ->type_name("DIR")
        ->check(CLI::ExistingDirectory);
    app.add_option("--child-scene", options.m_childScene)->group("");
    app.add_option("--child-trial", options.m_childTrial)->group("");
    app.add_flag("--child-device", options.m_childHasDevice)->group("");
    int exitCode = kExitGood;
    if (!parseArguments(
            app, argc, argv, [&options] { return nameProblem(options); }, exitCode))
        return exitCode;
    return runGuarded(kProgram,
                      [&]
                      {
                          if (options.m_list) return list(options);
                          return options.m_childScene.empty() ? measure(options) : runChild(options);
                      });
}
