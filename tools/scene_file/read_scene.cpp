#include "tools/scene_file/read_scene.h"

#include <algorithm>
#include <filesystem>

#include "mesh_io/read_file.h"
#include "tools/scene_file/materials.h"
#include "tools/scene_file/scene_parts.h"

namespace drape
{
namespace
{
constexpr int kMostFrames = 1000000;
constexpr int kMostSteps = 1000;

void readSolving(const JsonObject& object, SceneFile& file)
{
    ClothScene& scene = file.m_scene;
    object.read("gravity", scene.m_gravity, kSpeed);
    object.read("time_step", scene.m_frameTime, {1e-6, 1});
    object.read("frames", file.m_frames, 1, kMostFrames);
    object.read("steps_per_frame", scene.m_stepsPerFrame, 1, kMostSteps);
    object.read("iterations", scene.m_iterations, 1, kMostSteps);
    object.read("thickness", scene.m_thickness, kThicknesses);
    object.read("self_thickness", scene.m_selfThickness, kThicknesses);
    scene.m_seconds = file.m_frames * scene.m_frameTime;
}

void readWind(const JsonValue& value, ClothScene& scene)
{
    const JsonObject object(value, {"velocity", "air_density", "drag"});
    SceneWind wind;
    wind.m_velocity = object.at("velocity").vector(kSpeed);
    object.read("air_density", wind.m_airDensity, {1e-6, 1e4});
    object.read("drag", wind.m_drag, {0, 1e3});
    scene.m_wind = wind;
}

// Reads the path of a file to write. A scene that somebody else made writes nowhere but below the working folder.
void readOutput(const JsonObject& object, const char* key, std::string& path)
{
    object.read(key, path);
    const std::filesystem::path given(path);
    if (given.is_absolute() || std::find(given.begin(), given.end(), "..") != given.end())
        object.at(key).refuse("a path below the working folder");
}

void readOutputs(const JsonValue& value, SceneOutputs& outputs)
{
    const JsonObject object(value, {"csv", "json", "frames", "picture", "replay", "animation", "point_cache", "gltf"});
    readOutput(object, "csv", outputs.m_csv);
    readOutput(object, "json", outputs.m_json);
    readOutput(object, "frames", outputs.m_frames);
    readOutput(object, "picture", outputs.m_picture);
    readOutput(object, "replay", outputs.m_replay);
    readOutput(object, "animation", outputs.m_animation);
    readOutput(object, "point_cache", outputs.m_pointCache);
    readOutput(object, "gltf", outputs.m_gltf);
}

void readBodies(const JsonObject& object, SceneContext& context, ClothScene& scene)
{
    bool selfCollision = false;
    object.read("self_collision", selfCollision);
    if (object.has("obstacles"))
        object.at("obstacles")
            .each(0, [&](const JsonValue& item) { scene.m_obstacles.push_back(readObstacle(item, context)); });
    std::size_t nodes = 0;
    object.at("cloths").each(1,
                             [&](const JsonValue& item)
                             {
                                 scene.m_cloths.push_back(readCloth(item, context));
                                 if (!item.json().contains("self_collision"))
                                     scene.m_cloths.back().m_selfCollides = selfCollision;
                                 nodes += scene.m_cloths.back().nodeCount();
                                 if (nodes > std::size_t(kMostNodes)) item.fail("the cloths have too many nodes");
                             });
}

void readDocument(const std::string& text, const std::string& path, SceneFile& file)
{
    const SceneJson json = parseJson(text);
    const JsonObject object(
        JsonValue(json, ""),
        {"$schema", "name", "description", "gravity", "time_step", "frames", "steps_per_frame", "iterations",
         "thickness", "self_collision", "self_thickness", "wind", "materials", "cloths", "obstacles", "recording"});
    ClothScene& scene = file.m_scene;
    std::string schema;
    object.read("$schema", schema);
    scene.m_name = std::filesystem::path(path).stem().string();
    object.read("name", scene.m_name);
    object.read("description", file.m_description);
    readSolving(object, file);
    if (object.has("wind")) readWind(object.at("wind"), scene);
    SceneContext context = {std::filesystem::path(path).parent_path().string(), {}, &file};
    for (const NamedMaterial& preset : materialPresets())
        context.m_materials[preset.m_name] = preset.m_material;
    if (object.has("materials")) readMaterials(object.at("materials"), context);
    readBodies(object, context, scene);
    if (object.has("recording")) readOutputs(object.at("recording"), file.m_outputs);
}
}  // namespace

bool readSceneText(const std::string& text, const std::string& path, SceneFile& file, std::string& error)
{
    file = SceneFile();
    file.m_scene.m_thickness = 0.02;
    file.m_scene.m_stepsPerFrame = 1;
    file.m_scene.m_iterations = 5;
    try
    {
        readDocument(text, path, file);
    }
    catch (const std::runtime_error& mistake)
    {
        error = mistake.what();
        return false;
    }
    return true;
}

bool readScene(const std::string& path, SceneFile& file, std::string& error)
{
    std::string text;
    error = readWholeFile(path, "scene", text);
    if (error.empty() && readSceneText(text, path, file, error)) return true;
    error = path + ": " + error;
    return false;
}
}  // namespace drape
