// Materials of cloth by name. docs/scene_files.md has the values and their sources.
#pragma once

#include <string>
#include <vector>

#include "scenes/cloth_scene.h"

namespace drape
{
struct NamedMaterial
{
    std::string m_name;
    std::string m_text;  // one line without a full stop
    SceneMaterial m_material;
};

// Returns the presets, the default first.
const std::vector<NamedMaterial>& materialPresets();
std::vector<std::string> materialNames();

// Returns a table of the presets, a line each below a heading.
std::string materialTable();
}  // namespace drape
