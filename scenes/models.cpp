#include "scenes/models.h"

#include <cstdlib>
#include <filesystem>
#include <utility>

#include "scenes/mesh_loader.h"
#include "scenes/shapes.h"

namespace drape
{
namespace
{
constexpr float kSize = 2.0f;  // m, largest extent: as in cloth_drop

struct ModelFile
{
    const char* m_name;
    std::vector<const char*> m_files;  // any of them
    int m_subdivisions;
};

const ModelFile kFiles[] = {{"bunny", {"bunny_69k.obj", "bunny.obj"}, 0},
                            {"bunny_1m", {"bunny_69k.obj", "bunny.obj"}, 2},
                            {"dragon", {"dragon_871k.ply"}, 0},
                            {"spot", {"spot_6k.obj"}, 0}};

bool loadFile(const ModelFile& model, const std::vector<std::string>& folders, TriangleMesh& mesh, std::string& error)
{
    for (const std::string& folder : folders)
        for (const char* file : model.m_files)
        {
            const std::string path = folder + "/" + file;
            if (!std::filesystem::exists(path)) continue;
            if (!loadMesh(path, mesh, error)) return false;
            for (int i = 0; i < model.m_subdivisions; ++i)
                mesh = subdivide(mesh);
            return true;
        }
    error = std::string("no file for model ") + model.m_name + " (" + model.m_files.front() + ")";
    return false;
}

// Makes shapes with the sizes of the thesis's scans that are not available: 16,301 is a torus less one triangle.
bool makeShapeNamed(const std::string& name, TriangleMesh& mesh)
{
    const std::pair<const char*, int> spheres[] = {{"sphere_1k", 3},  {"sphere_5k", 4},   {"sphere_20k", 5},
                                                   {"sphere_82k", 6}, {"sphere_328k", 7}, {"sphere_1m", 8}};
    for (const auto& sphere : spheres)
    {
        if (name == sphere.first) mesh = makeSphere(0.5f * kSize, sphere.second);
    }
    if (name == "terrain_6272") mesh = makeTerrain(kSize, 0.15f, 56, 1);
    if (name == "torus_16301") mesh = makeTorus(0.7f, 0.3f, 143, 57);
    if (name == "torus_16301") mesh.m_triangles.resize(mesh.m_triangles.size() - 3);
    if (name == "torus_345944") mesh = makeTorus(0.7f, 0.3f, 521, 332);
    return mesh.triangleCount() > 0;
}
}  // namespace

const std::vector<std::string>& studyModelNames()
{
    static const std::vector<std::string> names = {"spot",         "terrain_6272", "torus_16301", "bunny",
                                                   "torus_345944", "dragon",       "bunny_1m"};
    return names;
}

std::vector<std::string> modelFolders(const std::string& given)
{
    std::vector<std::string> folders;
    if (!given.empty()) folders.push_back(given);
    const char* variable = std::getenv("DRAPE_MODELS_DIR");
    if (variable != nullptr && *variable != '\0') folders.push_back(variable);
    folders.push_back("/usr/share/glmark2/models");
    return folders;
}

bool makeModel(const std::string& name, const std::vector<std::string>& folders, TriangleMesh& mesh, std::string& error)
{
    mesh = TriangleMesh();
    for (const ModelFile& model : kFiles)
    {
        if (name != model.m_name) continue;
        if (!loadFile(model, folders, mesh, error)) return false;
        placeOnFloor(mesh, kSize);
        return true;
    }
    if (!makeShapeNamed(name, mesh))
    {
        error = "unknown model '" + name + "'";
        return false;
    }
    placeOnFloor(mesh, kSize);
    return true;
}
}  // namespace drape
