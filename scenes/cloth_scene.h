// Seeded scenes of cloth with itself, with other cloth and with moving obstacles: the same name, size and seed give the
// same scene. What the scene moves is a function of time alone, so that any engine can run it.
//
// Lengths in metres, y up, seconds, kilograms.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenes/cloth_grid.h"
#include "scenes/mesh.h"
#include "scenes/vector3.h"

namespace drape
{
// A turn about an axis through a body's origin, and then a shift of it.
struct ScenePose
{
    Vector3 m_shift;
    Vector3 m_axis = {0, 1, 0};  // unit
    double m_angle = 0;          // rad
};

struct SceneCloth
{
    ClothGrid m_rest;                // with the lengths at rest
    std::vector<float> m_positions;  // x y z per node where the scene starts
    double m_mass = 0;
    std::vector<int> m_held;  // nodes that the scene moves
};

struct SceneObstacle
{
    TriangleMesh m_mesh;                             // closed, around its origin
    std::function<ScenePose(double time)> m_poseAt;  // null: it rests at its origin
};

struct ClothScene
{
    std::string m_name;
    std::vector<SceneCloth> m_cloths;
    std::vector<SceneObstacle> m_obstacles;
    double m_thickness = 0;  // at which cloth rests on cloth and on obstacles
    double m_seconds = 0;    // from the start to the end of the motion
    // Returns where a held node is: its cloth, where it started, and the time. Null if no node is held.
    std::function<Vector3(std::size_t cloth, const Vector3& start, double time)> m_heldAt;
};

// Names that makeClothScene() knows.
const std::vector<std::string>& clothSceneNames();

struct ClothSceneSize
{
    int m_detail = 1;  // 1 is a test's size; twice as much has four times as many triangles
    int m_sheets = 8;  // number, in the scenes that drop sheets
};

// Makes a scene. seed: of small displacements of the start, less than a fifth of the thickness. Returns false if the
// name is unknown.
bool makeClothScene(const std::string& name, const ClothSceneSize& size, std::uint32_t seed, ClothScene& scene);
}  // namespace drape
