// Scene files as texts: reads them, and expects their mistakes.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/tools/tool.h"
#include "tools/scene_file/read_scene.h"
#include "tools/scene_world/scene_world.h"

namespace drape::test
{
// A sheet of 3 x 3 nodes, 1 m wide, with a place for more keys.
inline std::string sheetWith(const std::string& more)
{
    return R"({"shape": {"type": "grid", "columns": 3, "rows": 3, "size": 1})" + more + "}";
}

inline std::string sceneWith(const std::string& cloth, const std::string& more = "")
{
    return R"({"frames": 4, "cloths": [)" + cloth + "]" + more + "}";
}

inline Settings hostAlone()
{
    Settings settings;
    settings.m_backend = Backend::Host;
    return settings;
}

class SceneFiles : public ToolTest
{
protected:
    // Returns the hash of a run of the program on the host.
    std::string hashOf(std::vector<std::string> arguments) const
    {
        for (const char* more : {"--backend", "host", "--quiet", "--json", "-"})
            arguments.emplace_back(more);
        const ToolRun result = run(arguments);
        EXPECT_EQ(result.m_exitCode, 0) << result.m_err;
        return result.m_exitCode == 0 ? nlohmann::json::parse(result.m_out).at("hash").get<std::string>() : "";
    }

    SceneFile read(const std::string& text) const
    {
        SceneFile file;
        std::string error;
        EXPECT_TRUE(readScene(write("scene.json", text), file, error)) << error;
        return file;
    }

    // Expects that the text is refused with the path and the words.
    void expectMistake(const std::string& text, const std::vector<std::string>& words) const
    {
        SceneFile file;
        std::string error;
        const std::string path = write("bad.json", text);
        EXPECT_FALSE(readScene(path, file, error)) << text;
        EXPECT_EQ(error.rfind(path + ": ", 0), 0u) << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
        for (const std::string& word : words)
            EXPECT_NE(error.find(word), std::string::npos) << word << " is not in: " << error;
    }
};
}  // namespace drape::test
