// Scenes of cloth with itself, with other cloth and with obstacles. Those of makeClothScene() are seeded: the same
// name, size and seed give the same scene. What a scene moves is a function of time alone, so that any engine can run
// it.
//
// Lengths in metres, y up, seconds, kilograms.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenes/cloth_grid.h"
#include "scenes/mesh.h"
#include "scenes/obstacle_shape.h"
#include "scenes/scene_pose.h"
#include "scenes/vector3.h"

namespace drape
{
// Parameters of Bullet's soft bodies, each from 0 to 1.
struct SceneMaterial
{
    double m_stretch = 1;     // kLST of edges
    double m_bending = 0.02;  // kLST of bending springs
    double m_damping = 0.02;  // kDP
    double m_friction = 0.6;  // kDF
    double m_areaMass = 0.2;  // kg/m²; used where a cloth has no mass of its own
};

// Nodes that the scene holds and moves together.
struct ScenePins
{
    std::vector<int> m_nodes;
    SceneMotion m_motion;  // null: they stay
    Vector3 m_centre;      // the motion turns about it

    // Returns where a node is that started at `start`.
    Vector3 at(const Vector3& start, double time) const
    {
        return m_motion ? movedPoint(m_motion(time), m_centre, start) : start;
    }
};

// Nodes that are attached to an obstacle where they start.
struct SceneAnchors
{
    std::vector<int> m_nodes;
    std::size_t m_obstacle = 0;  // its index
    bool m_collides = true;      // false: the whole cloth passes through the obstacle
    double m_influence = 1;      // share of the distance between node and obstacle that a correction removes
};

// The generator of a cloth at rest, and its arguments.
struct ClothShape
{
    enum class Kind
    {
        Grid,  // makeClothGrid()
        Tube,  // makeClothTube(): m_columns around, m_size is the radius
        Mesh,  // from a file or arrays
        Rope   // makeRope()
    };
    Kind m_kind = Kind::Mesh;
    int m_columns = 0, m_rows = 0;
    double m_size = 0, m_height = 0;
};

struct SceneCloth
{
    ClothGrid m_rest;                // with the lengths at rest
    std::vector<float> m_positions;  // x y z per node where the scene starts
    double m_mass = 0;
    std::vector<ScenePins> m_pins{};
    ClothShape m_shape{};
    std::string m_name{};
    SceneMaterial m_material{};
    std::vector<double> m_nodeMasses{};  // kg; empty: every node has the same share of m_mass
    std::vector<SceneAnchors> m_anchors{};
    double m_pressure = 0;            // overpressure times volume of a closed mesh, N·m; Bullet's kPR
    double m_volumeConservation = 0;  // pressure of a closed mesh by the volume that is missing, Pa/m³; kVC
    double m_margin = -1;             // below 0: half of the scene's thickness
    bool m_selfCollides = true;       // with itself and with other cloth for which it is on
    bool m_restsAtStart = false;      // springs have their lengths from m_positions
    Vector3 m_velocity{};             // at the start

    std::size_t nodeCount() const { return m_positions.size() / 3; }
    bool isRope() const { return m_shape.m_kind == ClothShape::Kind::Rope; }
    // Returns the links that show a rope, two nodes each. Triangles show other cloth.
    std::vector<std::int32_t> lines() const { return isRope() ? m_rest.m_edgeSprings : std::vector<std::int32_t>(); }
    double massOf(std::size_t node) const
    {
        return m_nodeMasses.empty() ? m_mass / double(nodeCount()) : m_nodeMasses[node];
    }
};

// A mesh that need not be written out: its file, or the name of one of makeShape().
struct MeshSource
{
    std::string m_file{}, m_builtIn{};
    double m_fit = 0;  // above 0: the mesh was put on the floor at this extent, m
};

struct SceneObstacle
{
    TriangleMesh m_mesh;      // around its origin; of other shapes what checks and pictures take for it
    SceneMotion m_poseAt{};   // null: it rests at its origin
    ObstacleShape m_shape{};  // a mesh by default
    MeshSource m_source{};
    std::string m_name{};
    bool m_moves = true;  // false: it stays at m_poseAt(0)
    double m_mass = 0;    // above 0: dynamic, starting from m_poseAt(0)
    double m_friction = 1;
    double m_margin = -1;         // below 0: half of the scene's thickness
    Vector3 m_velocity{};         // a dynamic body's at the start
    Vector3 m_angularVelocity{};  // rad/s
};

struct SceneWind
{
    Vector3 m_velocity;
    double m_airDensity = 1.2;  // kg/m³
    double m_drag = 1.2;        // drag coefficient of a flat plate that faces the wind
};

struct ClothScene
{
    std::string m_name;
    std::vector<SceneCloth> m_cloths;
    std::vector<SceneObstacle> m_obstacles;
    double m_thickness = 0;      // at which cloth rests on cloth and on obstacles
    double m_selfThickness = 0;  // at which cloth rests on cloth; 0: twice its margin
    double m_seconds = 0;        // from the start to the end of the motion
    Vector3 m_gravity = {0, -9.81, 0};
    double m_frameTime = 1.0 / 60;
    int m_stepsPerFrame = 4;
    int m_iterations = 2;  // piterations; cloth in folds needs short steps more than iterations
    std::optional<SceneWind> m_wind;
};

// Names that makeClothScene() knows.
const std::vector<std::string>& clothSceneNames();
// Returns one line about a scene, without a full stop. Empty if the name is unknown.
std::string clothSceneText(const std::string& name);

struct ClothSceneSize
{
    int m_detail = 1;  // 1 is a test's size; twice as much has four times as many triangles
    int m_sheets = 8;  // number, in the scenes that drop sheets
};

// Makes a scene. seed: of small displacements of the start, less than a fifth of the thickness. Returns false if the
// name is unknown.
bool makeClothScene(const std::string& name, const ClothSceneSize& size, std::uint32_t seed, ClothScene& scene);
}  // namespace drape
