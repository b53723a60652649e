// cloth_drop: drops a cloth on an obstacle in Bullet, with Drape or Bullet's own collision, and reports.
#include <algorithm>
#include <chrono>
#include <iostream>

#include "scenes/atomic_file.h"
#include "tools/cloth_drop/animation.h"
#include "tools/cloth_drop/built_in_child.h"
#include "tools/cloth_drop/interruption.h"
#include "tools/cloth_drop/outputs.h"
#include "tools/cloth_drop/picture.h"
#include "tools/cloth_drop/progress.h"
#include "tools/cloth_drop/drop_scene.h"
#include "tools/cloth_drop/run_plan.h"
#include "tools/cloth_drop/runner.h"
#include "tools/common/arguments.h"
#include "tools/common/device_option.h"
#include "tools/scene_file/built_in_scene.h"
#include "tools/scene_file/materials.h"
#include "tools/scene_file/write_scene.h"

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
    const std::string remark = options.m_scene.empty() ? thicknessRemark(options) : "";
    if (!remark.empty()) std::cerr << "cloth_drop: warning: " << remark << std::endl;
    listenToSignals();
}

// Runs Bullet's own collision with a time limit in a child, which can be ended within a step that does not end.
bool runLimitedBuiltIn(const Options& options, const RunPlan& plan, NamedRun& run, std::string& error)
{
    beginRun(options);
    const ChildCap cap = {options.m_timeLimit, true};
    return runBuiltInChild(options, options.m_bulletMode, cap, plan, run.m_record, error);
}

// Runs the chosen back end. A built-in world is left alive: Bullet's clean-up of its distance field can take minutes.
bool runChosen(const Options& options, const RunPlan& plan, NamedRun& run, std::string& error, int& exitCode)
{
    exitCode = kExitFailed;
    if (!options.usesDrape() && options.m_timeLimit > 0) return runLimitedBuiltIn(options, plan, run, error);
    std::unique_ptr<Simulation> simulation =
        options.usesDrape() ? plan.m_makeDrape(options, error, exitCode) : plan.m_makeBullet(options.m_bulletMode);
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
    const bool ran =
        runSimulation(*simulation, plan.m_subject, options.m_steps, options.m_frames, hooks, run.m_record, error);
    if (!options.usesDrape()) static_cast<void>(simulation.release());
    return ran;
}

void runBuiltIns(const Options& options, const RunPlan& plan, std::vector<NamedRun>& runs, std::string& error)
{
    std::vector<std::pair<const char*, BulletMode>> modes = {{"bullet_stock", BulletMode::Stock},
                                                             {"bullet_tuned", BulletMode::Tuned}};
    if (options.m_compareSoftPair) modes.emplace_back("bullet_vfss", BulletMode::SoftPair);
    for (const auto& mode : modes)
    {
        if (!interruption().empty()) break;
        NamedRun run{mode.first, {}};
        std::string problem;
        if (!runBuiltInChild(options, mode.second, {options.m_compareCap}, plan, run.m_record, problem))
            error = problem;
        run.m_record.m_trouble = problem.empty() ? interruption() : problem;
        runs.push_back(std::move(run));
    }
}

// Runs what the options ask for. Returns false when it failed or a signal came; its record has the steps done so far.
bool runFirst(const Options& options, const RunPlan& plan, NamedRun& run, std::string& error, int& exitCode)
{
    if (runChosen(options, plan, run, error, exitCode)) error = interruption();
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

PicturePanel panelOf(const NamedRun& run, const RunPlan& plan)
{
    PicturePanel panel;
    panel.m_cloth = plan.m_subject.m_cloths;
    panel.m_lines = plan.m_subject.m_lines;
    if (!run.m_record.m_lastPositions.empty()) panel.m_cloth.m_positions = run.m_record.m_lastPositions;
    panel.m_title = titleOf(run);
    if (run.m_record.m_capped) panel.m_title += ", step " + std::to_string(run.m_record.m_steps.size());
    panel.m_remark = remarkOf(run);
    return panel;
}

// Gives a recording's bodies the names of the scene. The world has the obstacles first, and so has the recording.
void nameBodies(const RunSubject& subject, Recording& recording)
{
    if (subject.m_names.size() != recording.m_bodies.size()) return;
    for (std::size_t i = 0; i < subject.m_names.size(); ++i)
        if (!subject.m_names[i].empty()) recording.m_bodies[i].m_name = subject.m_names[i];
}

// Writes what is made of all frames: the page, the point cache and glTF. The latter two have the first run alone.
bool writeRecordings(const Options& options, const RunPlan& plan, std::vector<NamedRun>& runs, std::string& error)
{
    std::vector<const Recording*> recordings;
    for (NamedRun& run : runs)
    {
        nameBodies(plan.m_subject, run.m_record.m_recording);
        run.m_record.m_recording.m_title = titleOf(run);
        run.m_record.m_recording.m_remark = "at the end: " + remarkOf(run);
        if (run.m_record.m_recording.m_frameCount > 0) recordings.push_back(&run.m_record.m_recording);
    }
    ReplaySettings settings;
    settings.m_title = "cloth_drop: " + plan.m_title;
    const Recording& first = runs.front().m_record.m_recording;
    return (options.m_replay.empty() || writeReplay(options.m_replay, recordings, settings, error)) &&
           (options.m_pointCache.empty() || writePointCaches(options.m_pointCache, first, error)) &&
           (options.m_gltf.empty() || writeGltf(options.m_gltf, first, kMostTargets, error));
}

// Draws all frames, and stops when a signal comes. Keeps an error that is there already.
void drawAnimation(const Options& options, const RunPlan& plan, const std::vector<NamedRun>& runs, std::string& error)
{
    std::vector<const Recording*> recordings;
    for (const NamedRun& run : runs)
        if (run.m_record.m_recording.m_frameCount > 0) recordings.push_back(&run.m_record.m_recording);
    Progress progress("animation", animationRows(recordings), options.m_quiet, "row");
    const PictureHooks hooks = {[&](int rows) { progress.show(rows); }, [] { return interruption().empty(); }};
    std::string problem;
    // The first run's obstacles are drawn.
    const auto& frames = runs.front().m_record.m_obstacles;
    const auto obstacleAt = [&](std::size_t frame)
    { return plan.m_subject.shown(frames[std::min(frame, frames.size() - 1)]); };
    if (writeAnimation(options.m_animation, recordings, obstacleAt, hooks, problem)) return;
    if (problem.empty()) problem = interruption() + "; no animation is written";
    if (error.empty()) error = problem;
}

// Draws the runs' last frames, and stops when a signal comes. Keeps an error that is there already.
void drawLastFrames(const Options& options, const RunPlan& plan, const std::vector<NamedRun>& runs, std::string& error)
{
    std::vector<PicturePanel> panels;
    for (const NamedRun& run : runs)
        panels.push_back(panelOf(run, plan));
    Progress progress("picture", pictureRows(panels.size()), options.m_quiet, "row");
    PictureHooks hooks;
    hooks.m_progress = [&](int rows) { progress.show(rows); };
    hooks.m_goesOn = [] { return interruption().empty(); };
    std::string problem;
    const TriangleMesh obstacle = plan.m_subject.shown(runs.front().m_record.m_obstacles.back());
    if (writePicture(options.m_picture, panels, obstacle, hooks, problem)) return;
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

// Prints a list that an option asks for.
bool printed(const Options& options, std::string& error)
{
    if (options.m_listDevices) return printDevices(error);
    if (options.m_listScenes) std::cout << sceneTable();
    if (options.m_listMaterials) std::cout << materialTable();
    return flushOutput(error);
}

int writeSceneOf(const Options& options)
{
    SceneFile file;
    std::string error;
    if (!makeSceneOf(options, file, error)) return fail(kExitBadInput, error);
    if (isSceneFile(options.m_scene) && areOneFile(options.m_scene, options.m_writeScene))
        return fail(kExitBadInput, "--write-scene would write over the file of --scene, " + options.m_scene);
    std::vector<std::string> read = file.m_meshes;
    read.push_back(options.m_obstacle);
    for (const std::string& mesh : read)
        if (areOneFile(mesh, options.m_writeScene))
            return fail(kExitBadInput, "--write-scene would write over the mesh " + mesh);
    return writeScene(options.m_writeScene, file, error) ? kExitGood : fail(kExitFailed, error);
}

int runPlan(const Options& options, const RunPlan& plan)
{
    std::string error;
    if (options.m_streamSteps) streamBuiltIn(options, plan);
    for (const std::string& note : plan.m_notes)
        std::cerr << "cloth_drop: " << note << "\n";
    if (!prepareOutputs(options, plan.m_inputs, error)) return fail(kExitBadInput, error);
    std::vector<NamedRun> runs(1);
    runs[0].m_name = options.usesDrape() ? "drape" : "bullet";
    int exitCode = kExitFailed;
    const bool ran = runFirst(options, plan, runs[0], error, exitCode);
    if (ran && options.m_compare) runBuiltIns(options, plan, runs, error);
    if (error.empty()) error = interruption();
    const bool draws = ran && !(options.m_picture.empty() && options.m_animation.empty()) && interruption().empty();
    if (!draws) stopListening();
    if (!ran && runs[0].m_record.m_steps.empty()) return fail(exitCode, error);
    // The results are written first: the picture takes seconds and may be given up.
    std::string writeError;
    const bool written = writeOutputs(options, runs, writeError) && writeRecordings(options, plan, runs, writeError);
    if (draws && !options.m_picture.empty()) drawLastFrames(options, plan, runs, error);
    if (draws && !options.m_animation.empty()) drawAnimation(options, plan, runs, error);
    stopListening();
    if (!written) return fail(kExitFailed, writeError);
    return error.empty() ? judge(options, runs) : fail(exitCode, error);
}
int run(const Options& given)
{
    std::string error;
    if (given.m_listDevices || given.m_listScenes || given.m_listMaterials)
        return printed(given, error) ? kExitGood : fail(kExitFailed, error);
    if (!given.m_writeScene.empty()) return writeSceneOf(given);
    Options options = given;
    RunPlan plan;
    if (!makePlan(options, plan, error)) return fail(kExitBadInput, error);
    return runPlan(options, plan);
}
}  // namespace
}  // namespace drape

int main(int argc, char** argv)
{
    return drape::runProgram("cloth_drop", argc, argv, drape::parseOptions, drape::run);
}
