#include "examples/window/window_scenes.h"

#include <algorithm>

#include "scenes/models.h"
#include "scenes/shapes.h"
#include "tools/scene_file/built_in_scene.h"

namespace drape::window
{
namespace
{
constexpr float kThickness = 0.02f;  // m

// Adds the mesh, and a floor of 8 x 8 m below it.
void addObstacles(TriangleMesh mesh, ClothScene& scene)
{
    TriangleMesh floor = makeBox(8, 0.2f, 8);
    for (std::size_t i = 1; i < floor.m_positions.size(); i += 3)
        floor.m_positions[i] -= 0.1f;
    scene.m_obstacles.push_back({std::move(mesh), nullptr});
    scene.m_obstacles.push_back({std::move(floor), nullptr});
}

void addSheet(int detail, float size, float height, ClothScene& scene)
{
    SceneCloth cloth;
    const int nodes = 24 * detail + 1;
    cloth.m_rest = makeClothGrid(nodes, nodes, size, height);
    cloth.m_positions = cloth.m_rest.m_mesh.m_positions;
    cloth.m_mass = 0.5;
    scene.m_cloths.push_back(std::move(cloth));
    scene.m_thickness = double(kThickness);
    scene.m_stepsPerFrame = 1;
    scene.m_iterations = 5;
}
}  // namespace

const std::vector<std::string>& windowSceneNames()
{
    static const std::vector<std::string> names = []
    {
        std::vector<std::string> all = {"bunny", "ball"};
        all.insert(all.end(), clothSceneNames().begin(), clothSceneNames().end());
        return all;
    }();
    return names;
}

bool isWindowScene(const std::string& name)
{
    const std::vector<std::string>& names = windowSceneNames();
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool hasFloor(const std::string& name)
{
    return name == "bunny" || name == "ball";
}

bool makeWindowScene(const std::string& name, int detail, const std::string& models, ClothScene& scene,
                     std::string& error)
{
    scene = ClothScene();
    scene.m_name = name;
    TriangleMesh mesh;
    if (!isWindowScene(name) && isSceneFile(name))
    {
        SceneFile file;
        if (!readScene(name, file, error)) return false;
        scene = std::move(file.m_scene);
        scene.m_name = name;
        return true;
    }
    if (name == "bunny")
    {
        if (!makeModel("bunny", modelFolders(models), mesh, error)) return false;
        placeOnFloor(mesh, 1.4f);
        addSheet(detail, 1.7f, 1.6f, scene);
        addObstacles(std::move(mesh), scene);
        return true;
    }
    if (name == "ball")
    {
        mesh = makeSphere(0.5f, 4);
        placeOnFloor(mesh, 1);
        addSheet(detail, 1.8f, 1.3f, scene);
        addObstacles(std::move(mesh), scene);
        return true;
    }
    if (makeClothScene(name, {detail, 4}, 1, scene)) return true;
    error = "there is no scene " + name;
    return false;
}
}  // namespace drape::window
