// The drop of cloth_drop's options as a scene.
#pragma once

#include <string>

#include "tools/cloth_drop/options.h"
#include "tools/scene_file/read_scene.h"

namespace drape
{
// Makes the scene, which gives the positions of the drop bit for bit. Returns false, with one line in `error`, if the
// obstacle cannot be made.
bool dropAsScene(const Options& options, SceneFile& file, std::string& error);
}  // namespace drape
