#include "tools/scene_file/materials.h"

#include <cstdio>

namespace drape
{
// Masses are those of common qualities in the trade: g/m², oz/yd² (33.906 g/m²) and momme (4.340 g/m²). The other
// numbers are choices. docs/scene_files.md lists their effects on cloth that hangs and on a strip over an edge.
const std::vector<NamedMaterial>& materialPresets()
{
    static const std::vector<NamedMaterial> presets = {
        {"cotton", "bed sheet, 150 g/m²", {1, 0.02, 0.02, 0.6, 0.15}},
        {"silk", "charmeuse, 16 momme", {1, 0.005, 0.01, 0.3, 0.069}},
        {"denim", "jeans, 11 oz/yd²", {1, 0.2, 0.03, 0.6, 0.373}},
        {"terry", "towel, 450 g/m²", {0.9, 0.1, 0.05, 0.8, 0.45}},
        {"leather", "jacket, 0.7 mm of 0.8 g/cm³", {1, 0.4, 0.05, 0.6, 0.56}},
        {"rubber", "latex sheet, 0.5 mm of 0.93 g/cm³", {0.7, 0.05, 0.02, 1, 0.465}}};
    return presets;
}

std::vector<std::string> materialNames()
{
    std::vector<std::string> names;
    for (const NamedMaterial& preset : materialPresets())
        names.push_back(preset.m_name);
    return names;
}

std::string materialTable()
{
    std::string table = "name      density  stretch  bending  damping  friction  what it is\n";
    for (const NamedMaterial& preset : materialPresets())
    {
        const SceneMaterial& material = preset.m_material;
        char line[160];
        std::snprintf(line, sizeof line, "%-8s  %7g  %7g  %7g  %7g  %8g  %s\n", preset.m_name.c_str(),
                      material.m_areaMass, material.m_stretch, material.m_bending, material.m_damping,
                      material.m_friction, preset.m_text.c_str());
        table += line;
    }
    return table;
}
}  // namespace drape
