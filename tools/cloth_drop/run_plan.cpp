#include "tools/cloth_drop/run_plan.h"

#include <cmath>
#include <filesystem>

#include "tools/cloth_drop/drop_scene.h"
#include "tools/cloth_drop/drop_as_scene.h"
#include "tools/cloth_drop/scene_simulation.h"
#include "tools/common/suggestion.h"
#include "tools/scene_file/built_in_scene.h"

namespace drape
{
namespace
{
bool planDrop(const Options& options, RunPlan& plan, std::string& error)
{
    const auto scene = std::make_shared<DropScene>();
    if (!makeDropScene(options, *scene, error)) return false;
    plan.m_subject = subjectOf(*scene);
    plan.m_notes = scene->m_notes;
    plan.m_inputs = {{"--obstacle", options.m_obstacle}};
    plan.m_title = std::filesystem::path(options.m_obstacle).filename().string();
    plan.m_makeDrape = [scene](const Options& own, std::string& problem, int& exitCode)
    { return makeDrapeSimulation(*scene, own, problem, exitCode); };
    plan.m_makeBullet = [scene](BulletMode mode) { return makeBulletSimulation(*scene, mode); };
    return true;
}

bool loadScene(const Options& options, SceneFile& file, std::string& error)
{
    if (isSceneFile(options.m_scene)) return readScene(options.m_scene, file, error);
    const ClothSceneSize size = {options.m_detail, options.m_sheets};
    if (makeBuiltInScene(options.m_scene, size, std::uint32_t(options.m_seed), file)) return true;
    error = "--scene: " + unknownWord(options.m_scene, clothSceneNames()) + "; a file's name ends in .json";
    return false;
}

void takeOutputs(const SceneOutputs& outputs, Options& options)
{
    const std::pair<std::string&, const std::string&> all[] = {
        {options.m_csv, outputs.m_csv},       {options.m_json, outputs.m_json},
        {options.m_frames, outputs.m_frames}, {options.m_picture, outputs.m_picture},
        {options.m_replay, outputs.m_replay}, {options.m_animation, outputs.m_animation},
        {options.m_gltf, outputs.m_gltf},     {options.m_pointCache, outputs.m_pointCache}};
    for (const auto& [own, given] : all)
        if (own.empty()) own = given;
}

// Lets the command line have its way over the file, and takes the rest into the options.
void join(SceneFile& file, Options& options)
{
    if (options.m_stepsGiven) file.m_frames = options.m_steps;
    if (options.m_dtGiven) file.m_scene.m_frameTime = options.m_dt;
    options.m_steps = file.m_frames;
    options.m_dt = file.m_scene.m_frameTime;
    options.m_thickness = file.m_scene.m_thickness;
    takeOutputs(file.m_outputs, options);
}
}  // namespace

bool makePlan(Options& options, RunPlan& plan, std::string& error)
{
    if (options.m_scene.empty()) return planDrop(options, plan, error);
    const auto file = std::make_shared<SceneFile>();
    if (!loadScene(options, *file, error)) return false;
    join(*file, options);
    plan.m_subject = subjectOf(file->m_scene);
    plan.m_notes = file->m_notes;
    if (isSceneFile(options.m_scene)) plan.m_inputs = {{"--scene", options.m_scene}};
    for (const std::string& mesh : file->m_meshes)
        plan.m_inputs.emplace_back("the scene", mesh);
    plan.m_title = file->m_scene.m_name;
    plan.m_makeDrape = [file](const Options& own, std::string& problem, int& exitCode)
    { return makeDrapeScene(file->m_scene, own, problem, exitCode); };
    plan.m_makeBullet = [file](BulletMode mode) { return makeBulletScene(file->m_scene, mode); };
    return true;
}

bool makeSceneOf(const Options& options, SceneFile& file, std::string& error)
{
    if (options.m_scene.empty()) return dropAsScene(options, file, error);
    Options own = options;
    if (!loadScene(own, file, error)) return false;
    join(file, own);
    return true;
}
}  // namespace drape
