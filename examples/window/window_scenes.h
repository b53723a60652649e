// The scenes of drape_window: a cloth on the bunny or on a ball, those of scenes/cloth_scene.h, and scene files.
#pragma once

#include <string>
#include <vector>

#include "scenes/cloth_scene.h"

namespace drape::window
{
const std::vector<std::string>& windowSceneNames();
bool isWindowScene(const std::string& name);

// Returns whether the scene's last obstacle is a floor at y = 0.
bool hasFloor(const std::string& name);
// Makes the named scene, or reads the scene file. detail: of a built-in scene; 1 is coarse, twice as much has four
// times as many triangles. models: folder with model files, may be empty. Returns false with one line in `error` if the
// name is unknown, a model is missing, or the file cannot be used.
bool makeWindowScene(const std::string& name, int detail, const std::string& models, ClothScene& scene,
                     std::string& error);
}  // namespace drape::window
