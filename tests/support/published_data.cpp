#include "tests/support/published_data.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <vector>

#include "scenes/mesh_loader.h"
#include "scenes/models.h"

namespace drape::test
{
namespace
{
// Returns "" if the variable is not set.
std::string variable(const char* name)
{
    const char* const value = std::getenv(name);
    return value ? value : "";
}

bool isNeeded()
{
    return variable("DRAPE_TEST_NEED_DATA") == "1";
}

// Skips the test, or fails it where its data has to be there.
void endWithout(const std::string& missing)
{
    if (isNeeded()) GTEST_FAIL() << missing << ", which DRAPE_TEST_NEED_DATA asks for";
    GTEST_SKIP() << missing;
}

void require(bool good, const std::string& error)
{
    ASSERT_TRUE(good) << error;
}
}  // namespace

bool loadBunny(TriangleMesh& bunny)
{
    std::vector<std::string> paths = {"/usr/share/glmark2/models/bunny.obj"};
    const std::string folder = variable("DRAPE_MODELS_DIR");
    if (!folder.empty()) paths.insert(paths.begin(), folder + "/bunny_69k.obj");
    std::string error;
    for (const std::string& path : paths)
    {
        if (!std::ifstream(path)) continue;
        const bool loaded = loadMesh(path, bunny, error);
        require(loaded, error);
        return loaded;
    }
    endWithout("no bunny: neither DRAPE_MODELS_DIR with a bunny_69k.obj nor Debian's glmark2-data is there");
    return false;
}

bool findTruth(const std::string& name, std::string& path)
{
    const std::string folder = variable("DRAPE_TRUTH_DIR");
    path = folder + "/" + name;
    if (folder.empty())
        endWithout("no " + name + ": DRAPE_TRUTH_DIR names no folder of published queries");
    else if (!std::ifstream(path))
        endWithout(path + " is not there");
    else
        return true;
    return false;
}

bool loadStudyModel(const std::string& name, TriangleMesh& mesh)
{
    std::string error;
    if (makeModel(name, modelFolders(""), mesh, error)) return true;
    EXPECT_TRUE(variable("DRAPE_MODELS_DIR").empty() && !isNeeded()) << error;
    return false;
}
}  // namespace drape::test
