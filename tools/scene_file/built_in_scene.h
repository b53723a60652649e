// The seeded scenes of scenes/cloth_scene.h, by the options of a program.
#pragma once

#include <cstdint>
#include <string>

#include "tools/scene_file/read_scene.h"

namespace drape
{
// Makes a seeded scene. Returns false if the name is unknown.
bool makeBuiltInScene(const std::string& name, const ClothSceneSize& size, std::uint32_t seed, SceneFile& file);

// Returns true if the text is meant as a file, not as a scene's name: it has a dot or a slash, or is a file.
bool isSceneFile(const std::string& text);

// Returns a line for each scene: its name and a text.
std::string sceneTable();
}  // namespace drape
