// The parts of a scene file, for read_scene.cpp. All functions throw SceneMistake.
#pragma once

#include <map>
#include <string>

#include "scenes/mesh.h"
#include "tools/scene_file/json_reader.h"
#include "tools/scene_file/read_scene.h"

namespace drape
{
// Limits of what a file has. They keep every number a finite float32 that is not rounded to 0.
constexpr Limits kLength = {1e-6, 1e4};       // m
constexpr Limits kCoordinate = {-1e4, 1e4};   // m
constexpr Limits kThicknesses = {1e-4, 1e4};  // m; Drape's least thickness
constexpr Limits kMass = {1e-9, 1e6};         // kg
constexpr Limits kSpeed = {-1e4, 1e4};        // m/s, rad/s, m/s²
constexpr Limits kAngle = {-1e6, 1e6};        // rad
constexpr Limits kTime = {0, 1e6};            // s
constexpr int kMostNodes = 1 << 24;

// The file that is read: its folder, for relative paths, and its materials.
struct SceneContext
{
    std::string m_folder;
    std::map<std::string, SceneMaterial> m_materials;
    SceneFile* m_file;
};

SceneMaterial readMaterial(const JsonValue& value, const SceneContext& context);
// Adds the materials of the file.
void readMaterials(const JsonValue& value, SceneContext& context);

// Reads a mesh from a file or from arrays. `object` has the keys of kMeshKeys.
TriangleMesh readMesh(const JsonObject& object, SceneContext& context);
extern const std::vector<std::string> kMeshKeys;

// Reads the keys position and rotation, which may be missing.
ScenePose readPose(const JsonObject& object);
// Reads a motion. `centre` is the centre of its turns and is replaced where the motion has one.
SceneMotion readMotion(const JsonValue& value, Vector3& centre);

// Reads the pins of a cloth whose nodes are there already.
void readPins(const JsonValue& value, SceneCloth& cloth);
// Reads the anchors of a cloth whose pins are there already, and the obstacles.
void readAnchors(const JsonValue& value, const std::vector<SceneObstacle>& obstacles, SceneCloth& cloth);

// Reads the shape of a rope, with its nodes at rest.
ClothGrid readRope(const JsonValue& value);
// Reads the keys pressure and volume_conservation, which may be missing. Turns the triangles outwards if one is there.
void readVolume(const JsonObject& object, SceneCloth& cloth);

SceneCloth readCloth(const JsonValue& value, SceneContext& context);
SceneObstacle readObstacle(const JsonValue& value, SceneContext& context);
}  // namespace drape
