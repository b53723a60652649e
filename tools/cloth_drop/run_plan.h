// The run that cloth_drop's options ask for: the drop on one obstacle, a scene file, or a built-in scene.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tools/cloth_drop/options.h"
#include "tools/cloth_drop/run_subject.h"
#include "tools/cloth_drop/simulation.h"
#include "tools/scene_file/read_scene.h"

namespace drape
{
struct RunPlan
{
    RunSubject m_subject;
    std::string m_title;                                        // page's title
    std::vector<std::pair<std::string, std::string>> m_inputs;  // files that outputs must spare: option and path
    std::vector<std::string> m_notes;                           // remarks about the files, one line each
    // These make the simulation like makeDrapeSimulation() and makeBulletSimulation().
    std::function<std::unique_ptr<Simulation>(const Options&, std::string& error, int& exitCode)> m_makeDrape;
    std::function<std::unique_ptr<Simulation>(BulletMode)> m_makeBullet;
};

// Makes the plan. Takes the scene's steps, time step, thickness and outputs into the options, as far as the command
// line does not say otherwise. Returns false, with one line in `error`, if a file or name cannot be used.
bool makePlan(Options& options, RunPlan& plan, std::string& error);

// Makes the scene of the options as a scene file has it, the drop among them. Returns false like makePlan().
bool makeSceneOf(const Options& options, SceneFile& file, std::string& error);
}  // namespace drape
