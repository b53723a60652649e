// Writes scenes as files that read_scene.h reads, so that a run of the file has the positions of a run of the scene,
// bit for bit.
#pragma once

#include <string>

#include "tools/scene_file/json_reader.h"
#include "tools/scene_file/read_scene.h"

namespace drape
{
// Returns the scene as a document. Motions are written as keyframes at the ends of all steps; between them, and after
// the last frame, they are straight and at rest. Meshes are written as arrays unless the scene names their source;
// files are named relative to `folder` where they lie in it.
SceneJson sceneDocument(const SceneFile& file, const std::string& folder);

// Returns JSON with one line for each short object and array of numbers.
std::string sceneText(const SceneJson& document);

// Maximum number of steps of a scene that is written.
constexpr int kMostWrittenSteps = 10000000;

// Returns false with one line in `error` if the file cannot be written, or if readScene() would refuse it.
bool writeScene(const std::string& path, const SceneFile& file, std::string& error);
}  // namespace drape
