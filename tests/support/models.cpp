#include "tests/support/models.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <vector>

#include "scenes/mesh_loader.h"
#include "scenes/models.h"

namespace drape::test
{
std::string loadBunny(TriangleMesh& bunny)
{
    std::vector<std::string> paths = {"/usr/share/glmark2/models/bunny.obj"};
    if (const char* folder = std::getenv("DRAPE_MODELS_DIR"))
        paths.insert(paths.begin(), std::string(folder) + "/bunny_69k.obj");
    std::string error = "no bunny: neither DRAPE_MODELS_DIR with a bunny_69k.obj nor Debian's glmark2-data is there";
    for (const std::string& path : paths)
        if (std::ifstream(path)) return loadMesh(path, bunny, error) ? std::string() : error;
    return error;
}

bool loadStudyModel(const std::string& name, TriangleMesh& mesh)
{
    std::string error;
    if (makeModel(name, modelFolders(""), mesh, error)) return true;
    const char* const folder = std::getenv("DRAPE_MODELS_DIR");
    EXPECT_TRUE(!folder || *folder == '\0') << error;
    return false;
}
}  // namespace drape::test
