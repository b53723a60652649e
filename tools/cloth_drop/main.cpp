// cloth_drop: drops a cloth on an obstacle in Bullet, with Drape or Bullet's own collision, and reports.
#include <chrono>
#include <filesystem>
#include <iostream>

#include "tools/cloth_drop/animation.h"
#include "tools/cloth_drop/built_in_child.h"
#include "tools/cloth_drop/interruption.h"
#include "tools/cloth_drop/outputs.h"
#include "tools/cloth_drop/picture.h"
#include "tools/cloth_drop/progress.h"
#include "tools/cloth_drop/runner.h"
#include "tools/common/arguments.h"
#include "tools/common/device_option.h"

namespace drape
{
namespace
{
constexpr std::size_t kMostTargets = 60;  // for --gltf: a frame in four of the default run

int fail(int exitCode, const std::string& reason)
{
    return drape::fail("cloth_drop", exitCode, reason);
}

// Warns and listens to signals. Called once nothing can refuse the arguments any more, before the first step.
void beginRun(const Options& options)
{
    const std::string remark = thicknessRemark(options);
    if (!remark.empty()) std::cerr << "cloth_drop: warning: " << remark << std::endl;
    listenToSignals();
}

// Runs Bullet's own collision with a time limit in a child, which can be ended within a step that does not end.
bool runLimitedBuiltIn(const Options& options, const DropScene& scene, NamedRun& run, std::string& error)
{
    beginRun(options);
    const ChildCap cap = {options.m_timeLimit, true};
    return runBuiltInChild(options, options.m_bulletMode, cap, scene, run.m_record, error);
}

// Runs the chosen back end. A built-in world is left alive: Bullet's clean-up of its distance field can take minutes.
bool runChosen(const Options& options, const DropScene& scene, NamedRun& run, std::string& error, int& exitCode)
{
    exitCode = kExitFailed;
    if (!options.usesDrape() && options.m_timeLimit > 0) return runLimitedBuiltIn(options, scene, run, error);
    std::unique_ptr<Simulation> simulation = options.usesDrape() ? makeDrapeSimulation(scene, options, error, exitCode)
                                                                 : makeBulletSimulation(scene, options.m_bulletMode);
    if (!simulation) return false;
    exitCode = kExitFailed;
    beginRun(options);
    Progress progress(run.m_name, options.m_steps, options.m_quiet);
    RunHooks hooks;
    hooks.m_afterStep = [&](int number, const StepRecord&) { progress.show(number); };
    hooks.m_records = options.records();
    const auto start = std::chrono::steady_clock::now();
    const bool limited = options.m_timeLimit > 0;
    const std::chrono::duration<double> limit(options.m_timeLimit);
    hooks.m_goesOn = [=]
    { return interruption().empty() && !(limited && std::chrono::steady_clock::now() - start >= limit); };
    const bool ran = runSimulation(*simulation, scene, options.m_steps, options.m_frames, hooks, run.m_record, error);
    if (!options.usesDrape()) static_cast<void>(simulation.release());
    return ran;
}

void runBuiltIns(const Options& options, const DropScene& scene, std::vector<NamedRun>& runs, std::string& error)
{
    std::vector<std::pair<const char*, BulletMode>> modes = {{"bullet_stock", BulletMode::Stock},
                                                             {"bullet_tuned", BulletMode::Tuned}};
    if (options.m_compareSoftPair) modes.emplace_back("bullet_vfss", BulletMode::SoftPair);
    for (const auto& mode : modes)
    {
        if (!interruption().empty()) break;
        NamedRun run{mode.first, {}};
        std::string problem;
        if (!runBuiltInChild(options, mode.second, {options.m_compareCap}, scene, run.m_record, problem))
            error = problem;
        run.m_record.m_trouble = problem.empty() ? interruption() : problem;
        runs.push_back(std::move(run));
    }
}

// Runs what the options ask for. Returns false when it failed or a signal came; its record has the steps done so far.
bool runFirst(const Options& options, const DropScene& scene, NamedRun& run, std::string& error, int& exitCode)
{
    if (runChosen(options, scene, run, error, exitCode)) error = interruption();
    if (error.empty()) return true;
    std::string& trouble = run.m_record.m_trouble;
    trouble += (trouble.empty() ? "" : "; ") + error;
    return false;
}

std::string titleOf(const NamedRun& run)
{
    if (run.m_name == "drape") return "Drape, " + run.m_record.m_backend;
    return "Bullet" + run.m_record.m_backend.substr(std::string("bullet").size());
}

std::string remarkOf(const NamedRun& run)
{
    const RunSummary summary = summarise(run.m_record);
    return std::to_string(summary.m_intersectingPairsEnd) + " pairs intersect, " +
           std::to_string(summary.m_nodesThrough) + " nodes through";
}

PicturePanel panelOf(const NamedRun& run, const DropScene& scene)
{
    PicturePanel panel;
    panel.m_cloth = sheetsOf(scene);
    if (!run.m_record.m_lastPositions.empty()) panel.m_cloth.m_positions = run.m_record.m_lastPositions;
    panel.m_title = titleOf(run);
    if (run.m_record.m_capped) panel.m_title += ", step " + std::to_string(run.m_record.m_steps.size());
    panel.m_remark = remarkOf(run);
    return panel;
}

// Writes what is made of all frames: the page, the point cache and glTF. The latter two have the first run alone.
bool writeRecordings(const Options& options, std::vector<NamedRun>& runs, std::string& error)
{
    std::vector<const Recording*> recordings;
    for (NamedRun& run : runs)
    {
        run.m_record.m_recording.m_title = titleOf(run);
        run.m_record.m_recording.m_remark = "at the end: " + remarkOf(run);
        if (run.m_record.m_recording.m_frameCount > 0) recordings.push_back(&run.m_record.m_recording);
    }
    ReplaySettings settings;
    settings.m_title = "cloth_drop: " + std::filesystem::path(options.m_obstacle).filename().string();
    const Recording& first = runs.front().m_record.m_recording;
    return (options.m_replay.empty() || writeReplay(options.m_replay, recordings, settings, error)) &&
           (options.m_pointCache.empty() || writePointCaches(options.m_pointCache, first, error)) &&
           (options.m_gltf.empty() || writeGltf(options.m_gltf, first, kMostTargets, error));
}

// Draws all frames, and stops when a signal comes. Keeps an error that is there already.
void drawAnimation(const Options& options, const DropScene& scene, const std::vector<NamedRun>& runs,
                   std::string& error)
{
    std::vector<const Recording*> recordings;
    for (const NamedRun& run : runs)
        if (run.m_record.m_recording.m_frameCount > 0) recordings.push_back(&run.m_record.m_recording);
    Progress progress("animation", animationRows(recordings), options.m_quiet, "row");
    const PictureHooks hooks = {[&](int rows) { progress.show(rows); }, [] { return interruption().empty(); }};
    std::string problem;
    if (writeAnimation(options.m_animation, recordings, scene.m_obstacle, hooks, problem)) return;
    if (problem.empty()) problem = interruption() + "; no animation is written";
    if (error.empty()) error = problem;
}

// Draws the runs' last frames, and stops when a signal comes. Keeps an error that is there already.
void drawLastFrames(const Options& options, const DropScene& scene, const std::vector<NamedRun>& runs,
                    std::string& error)
{
    std::vector<PicturePanel> panels;
    for (const NamedRun& run : runs)
        panels.push_back(panelOf(run, scene));
    Progress progress("picture", pictureRows(panels.size()), options.m_quiet, "row");
    PictureHooks hooks;
    hooks.m_progress = [&](int rows) { progress.show(rows); };
    hooks.m_goesOn = [] { return interruption().empty(); };
    std::string problem;
    if (writePicture(options.m_picture, panels, scene.m_obstacle, hooks, problem)) return;
    if (problem.empty()) problem = interruption() + "; no picture is written";
    if (error.empty()) error = problem;
}

int judge(const Options& options, const std::vector<NamedRun>& runs)
{
    const RunSummary summary = summarise(runs.front().m_record);
    if (!options.m_validateHash.empty() && hashText(summary.m_hash) != options.m_validateHash)
        return fail(kExitOtherHash, "hash is " + hashText(summary.m_hash) + ", not " + options.m_validateHash);
    if (summary.m_invalidNodes > 0)
        return fail(kExitFailed, std::to_string(summary.m_invalidNodes) + " cloth nodes became NaN or infinite");
    return kExitGood;
}

int run(const Options& options)
{
    std::string error;
    if (options.m_listDevices) return printDevices(error) ? kExitGood : fail(kExitFailed, error);
    DropScene scene;
    if (!makeDropScene(options, scene, error)) return fail(kExitBadInput, error);
    if (options.m_streamSteps) streamBuiltIn(options, scene);
    for (const std::string& note : scene.m_notes)
        std::cerr << "cloth_drop: " << note << "\n";
    if (!prepareOutputs(options, error)) return fail(kExitBadInput, error);
    std::vector<NamedRun> runs(1);
    runs[0].m_name = options.usesDrape() ? "drape" : "bullet";
    int exitCode = kExitFailed;
    const bool ran = runFirst(options, scene, runs[0], error, exitCode);
    if (ran && options.m_compare) runBuiltIns(options, scene, runs, error);
    if (error.empty()) error = interruption();
    const bool draws = ran && !(options.m_picture.empty() && options.m_animation.empty()) && interruption().empty();
    if (!draws) stopListening();
    if (!ran && runs[0].m_record.m_steps.empty()) return fail(exitCode, error);
    // The results are written first: the picture takes seconds and may be given up.
    std::string writeError;
    const bool written = writeOutputs(options, runs, writeError) && writeRecordings(options, runs, writeError);
    if (draws && !options.m_picture.empty()) drawLastFrames(options, scene, runs, error);
    if (draws && !options.m_animation.empty()) drawAnimation(options, scene, runs, error);
    stopListening();
    if (!written) return fail(kExitFailed, writeError);
    return error.empty() ? judge(options, runs) : fail(exitCode, error);
}
}  // namespace
}  // namespace drape

int main(int argc, char** argv)
{
    return drape::runProgram("cloth_drop", argc, argv, drape::parseOptions, drape::run);
}
