// Scenes (scenes/cloth_scene.h) as simulations of cloth_drop.
#pragma once

#include <memory>
#include <string>

#include "scenes/cloth_scene.h"
#include "tools/cloth_drop/simulation.h"

namespace drape
{
// Returns what is measured of a run of the scene.
RunSubject subjectOf(const ClothScene& scene);

// Make the simulation like makeDrapeSimulation() and makeBulletSimulation(). A step of it is a frame of the scene,
// which must outlive it. Bullet's mode for two soft bodies has no scenes: stock is taken.
std::unique_ptr<Simulation> makeDrapeScene(const ClothScene& scene, const Options& options, std::string& error,
                                           int& exitCode);
std::unique_ptr<Simulation> makeBulletScene(const ClothScene& scene, BulletMode mode);
}  // namespace drape
