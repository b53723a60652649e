// Reads scene files of cloth_drop: JSON, which docs/scene.schema.json describes and docs/scene_files.md explains.
//
// A file has metres, kilograms, seconds and radians, y up. Paths of meshes are relative to the file.
#pragma once

#include <string>
#include <vector>

#include "scenes/cloth_scene.h"

namespace drape
{
// Files that a run writes; paths are relative to the working folder. Empty: none.
struct SceneOutputs
{
    std::string m_csv, m_json, m_frames, m_picture, m_replay, m_animation, m_pointCache, m_gltf;
};

struct SceneFile
{
    ClothScene m_scene;
    std::string m_description;
    int m_frames = 240;
    SceneOutputs m_outputs;
    std::vector<std::string> m_meshes;  // paths of the meshes that were read
    std::vector<std::string> m_notes;   // parts of meshes that were left out or lost, one line each
};

// Returns false, with "FILE: PATH: what was expected" in `error`, if the file cannot be used.
bool readScene(const std::string& path, SceneFile& file, std::string& error);
// Reads the content of such a file, with "PATH: what was expected" in `error`. path: where meshes are relative to.
bool readSceneText(const std::string& text, const std::string& path, SceneFile& file, std::string& error);
}  // namespace drape
