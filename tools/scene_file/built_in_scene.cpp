#include "tools/scene_file/built_in_scene.h"

#include <cmath>
#include <filesystem>

namespace drape
{
bool makeBuiltInScene(const std::string& name, const ClothSceneSize& size, std::uint32_t seed, SceneFile& file)
{
    file = SceneFile();
    if (!makeClothScene(name, size, seed, file.m_scene)) return false;
    file.m_description = clothSceneText(name);
    file.m_frames = int(std::lround(file.m_scene.m_seconds / file.m_scene.m_frameTime));
    return true;
}

bool isSceneFile(const std::string& text)
{
    std::error_code code;
    return text.find_first_of("./") != std::string::npos || std::filesystem::is_regular_file(text, code);
}

std::string sceneTable()
{
    std::string table;
    for (const std::string& name : clothSceneNames())
        table += name + std::string(20 - std::min<std::size_t>(19, name.size()), ' ') + clothSceneText(name) + "\n";
    return table;
}
}  // namespace drape
