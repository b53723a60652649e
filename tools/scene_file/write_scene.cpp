#include "tools/scene_file/write_scene.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "scenes/atomic_file.h"

namespace drape
{
namespace
{
namespace fs = std::filesystem;

constexpr std::size_t kLine = 110;  // columns of an object in one line
constexpr std::size_t kSpaced = 8;  // items of it

// Returns the shortest decimal number that rounds to the float.
double shortest(float value)
{
    char text[32];
    double number = 0;
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    std::from_chars(text, end, number);
    return number;
}

SceneJson asJson(const Vector3& v)
{
    return SceneJson::array({v.x, v.y, v.z});
}

SceneJson asJson(const std::vector<float>& values)
{
    SceneJson all = SceneJson::array();
    for (const float value : values)
        all.push_back(shortest(value));
    return all;
}

bool isZero(const Vector3& v)
{
    return v.x == 0 && v.y == 0 && v.z == 0;
}

// Adds the shift under a name and the turn, without what is 0.
void addPose(SceneJson& json, const char* shift, const ScenePose& pose)
{
    if (!isZero(pose.m_shift)) json[shift] = asJson(pose.m_shift);
    if (pose.m_angle != 0) json["rotation"] = {{"axis", asJson(pose.m_axis)}, {"angle", pose.m_angle}};
}

bool samePose(const ScenePose& a, const ScenePose& b)
{
    return isZero(a.m_shift - b.m_shift) && a.m_angle == b.m_angle && (a.m_angle == 0 || isZero(a.m_axis - b.m_axis));
}

// Samples a motion where the steps of the run end. Leaves out what lies between equal neighbours.
std::vector<SceneKey> keysOf(const SceneMotion& motion, const SceneFile& file)
{
    std::vector<SceneKey> keys;
    const double dt = file.m_scene.m_frameTime / file.m_scene.m_stepsPerFrame;
    const long steps = long(file.m_frames) * file.m_scene.m_stepsPerFrame;
    double time = 0;  // summed up as by the world, so that keys and steps have the same times
    for (long step = 0; step <= steps; ++step, time += dt)
    {
        const SceneKey key = {time, motion(time)};
        const std::size_t count = keys.size();
        if (count > 1 && samePose(keys[count - 1].m_pose, key.m_pose) && samePose(keys[count - 2].m_pose, key.m_pose))
            keys.pop_back();
        keys.push_back(key);
    }
    if (keys.size() == 2 && samePose(keys[0].m_pose, keys[1].m_pose)) keys.pop_back();
    return keys;
}

SceneJson asJson(const std::vector<SceneKey>& keys)
{
    SceneJson all = SceneJson::array();
    for (const SceneKey& key : keys)
    {
        SceneJson json = {{"time", key.m_time}};
        addPose(json, "shift", key.m_pose);
        all.push_back(std::move(json));
    }
    return {{"keyframes", std::move(all)}};
}

SceneJson asJson(const SceneMaterial& material)
{
    return {{"stretch", material.m_stretch},
            {"bending", material.m_bending},
            {"damping", material.m_damping},
            {"friction", material.m_friction},
            {"density", material.m_areaMass}};
}

SceneJson meshJson(const TriangleMesh& mesh)
{
    return {{"type", "mesh"}, {"positions", asJson(mesh.m_positions)}, {"triangles", mesh.m_triangles}};
}

SceneJson clothShape(const SceneCloth& cloth)
{
    const ClothShape& shape = cloth.m_shape;
    if (shape.m_kind == ClothShape::Kind::Grid)
        return {{"type", "grid"}, {"columns", shape.m_columns}, {"rows", shape.m_rows}, {"size", shape.m_size}};
    if (shape.m_kind == ClothShape::Kind::Tube)
        return {{"type", "tube"},
                {"around", shape.m_columns},
                {"rows", shape.m_rows},
                {"radius", shape.m_size},
                {"height", shape.m_height}};
    if (cloth.isRope())
    {
        SceneJson json = {{"type", "rope"}, {"positions", asJson(cloth.m_rest.m_mesh.m_positions)}};
        if (!cloth.m_rest.m_bendingSprings.empty()) json["bending"] = true;
        return json;
    }
    return meshJson(cloth.m_rest.m_mesh);
}

// Writes the nodes' places as a shift of the shape where it is one.
void addPlaces(SceneJson& json, const SceneCloth& cloth)
{
    const std::vector<float>& rest = cloth.m_rest.m_mesh.m_positions;
    double shift[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
        shift[axis] = double(cloth.m_positions[axis]) - double(rest[axis]);
    bool shifted = true;
    for (std::size_t i = 0; i < rest.size() && shifted; ++i)
        shifted = float(double(rest[i]) + shift[i % 3]) == cloth.m_positions[i];
    if (!shifted)
        json["positions"] = asJson(cloth.m_positions);
    else if (!isZero({shift[0], shift[1], shift[2]}))
        json["position"] = {shift[0], shift[1], shift[2]};
}

SceneJson asJson(const ScenePins& pins, const SceneFile& file)
{
    SceneJson json = {{"nodes", pins.m_nodes}};
    if (!pins.m_motion) return json;
    const std::vector<SceneKey> keys = keysOf(pins.m_motion, file);
    if (keys.size() == 1 && samePose(keys[0].m_pose, {})) return json;
    json["motion"] = asJson(keys);
    if (!isZero(pins.m_centre)) json["motion"]["centre"] = asJson(pins.m_centre);
    return json;
}

SceneJson asJson(const SceneAnchors& anchors, const SceneFile& file)
{
    SceneJson json = {{"nodes", anchors.m_nodes}, {"obstacle", file.m_scene.m_obstacles[anchors.m_obstacle].m_name}};
    if (!anchors.m_collides) json["collision"] = false;
    if (anchors.m_influence != 1) json["influence"] = anchors.m_influence;
    return json;
}

SceneJson asJson(const SceneCloth& cloth, const SceneFile& file)
{
    SceneJson json;
    if (!cloth.m_name.empty()) json["name"] = cloth.m_name;
    json["shape"] = clothShape(cloth);
    addPlaces(json, cloth);
    if (cloth.m_restsAtStart) json["rest"] = "start";
    json["material"] = asJson(cloth.m_material);
    json["mass"] = cloth.m_mass;
    if (cloth.m_margin >= 0) json["margin"] = cloth.m_margin;
    json["self_collision"] = cloth.m_selfCollides;
    if (!isZero(cloth.m_velocity)) json["velocity"] = asJson(cloth.m_velocity);
    for (const ScenePins& pins : cloth.m_pins)
        json["pins"].push_back(asJson(pins, file));
    for (const SceneAnchors& anchors : cloth.m_anchors)
        json["anchors"].push_back(asJson(anchors, file));
    if (cloth.m_pressure > 0) json["pressure"] = cloth.m_pressure;
    if (cloth.m_volumeConservation > 0) json["volume_conservation"] = cloth.m_volumeConservation;
    return json;
}

SceneJson primitiveJson(const ObstacleShape& shape)
{
    using Kind = ObstacleShape::Kind;
    switch (shape.m_kind)
    {
        case Kind::Box:
            return {{"type", "box"}, {"size", asJson(shape.m_size)}};
        case Kind::Sphere:
            return {{"type", "sphere"}, {"radius", shape.m_radius}};
        case Kind::Capsule:
            return {{"type", "capsule"}, {"radius", shape.m_radius}, {"length", shape.m_length}};
        case Kind::Cylinder:
            return {{"type", "cylinder"}, {"radius", shape.m_radius}, {"length", shape.m_length}};
        case Kind::Plane:
            return {{"type", "plane"}, {"normal", asJson(shape.m_normal)}, {"offset", shape.m_offset}};
        case Kind::HeightField:
            return {{"type", "height_field"},
                    {"columns", shape.m_columns},
                    {"rows", shape.m_rows},
                    {"cell", shape.m_cell},
                    {"heights", asJson(shape.m_heights)}};
        case Kind::Mesh:
            break;
    }
    return {};
}

SceneJson obstacleShape(const SceneObstacle& obstacle, const std::string& folder)
{
    if (obstacle.m_shape.m_kind != ObstacleShape::Kind::Mesh) return primitiveJson(obstacle.m_shape);
    const MeshSource& source = obstacle.m_source;
    SceneJson json;
    if (!source.m_builtIn.empty())
        json = {{"type", "built_in"}, {"name", source.m_builtIn}};
    else if (!source.m_file.empty())
    {
        const fs::path path = fs::weakly_canonical(source.m_file), near = path.lexically_proximate(folder);
        json = {{"type", "mesh"}, {"file", *near.begin() == ".." ? path.string() : near.string()}};
    }
    else
        return meshJson(obstacle.m_mesh);
    if (source.m_fit > 0) json["fit"] = source.m_fit;
    return json;
}

SceneJson asJson(const SceneObstacle& obstacle, const SceneFile& file, const std::string& folder)
{
    SceneJson json;
    if (!obstacle.m_name.empty()) json["name"] = obstacle.m_name;
    json["shape"] = obstacleShape(obstacle, folder);
    const bool moves = obstacle.m_poseAt && obstacle.m_moves && !(obstacle.m_mass > 0);
    std::vector<SceneKey> keys;
    if (moves) keys = keysOf(obstacle.m_poseAt, file);
    if (keys.size() > 1)
        json["motion"] = asJson(keys);
    else if (obstacle.m_poseAt)
        addPose(json, "position", obstacle.m_poseAt(0));
    if (obstacle.m_mass > 0) json["mass"] = obstacle.m_mass;
    json["friction"] = obstacle.m_friction;
    if (obstacle.m_margin >= 0) json["margin"] = obstacle.m_margin;
    if (!isZero(obstacle.m_velocity)) json["velocity"] = asJson(obstacle.m_velocity);
    if (!isZero(obstacle.m_angularVelocity)) json["angular_velocity"] = asJson(obstacle.m_angularVelocity);
    return json;
}

bool isNumbers(const SceneJson& json)
{
    return json.is_array() &&
           std::all_of(json.begin(), json.end(), [](const SceneJson& item) { return item.is_number(); });
}

// Returns the value in one line; long arrays of numbers without spaces.
std::string oneLine(const SceneJson& json)
{
    if (!json.is_structured() || (isNumbers(json) && json.size() > kSpaced)) return json.dump();
    std::string text;
    for (const auto& item : json.items())
        text += (text.empty() ? "" : ", ") + (json.is_object() ? SceneJson(item.key()).dump() + ": " : "") +
                oneLine(item.value());
    return json.is_object() ? "{" + text + "}" : "[" + text + "]";
}

// Returns true for arrays of bodies, which have a line for each of their keys.
bool hasLines(const SceneJson& json)
{
    return json.is_array() && !json.empty() && json[0].is_object() && json[0].contains("shape");
}

void addText(const SceneJson& json, std::size_t indent, std::string& text)
{
    const std::string line = json.is_structured() && !isNumbers(json) && (json.size() > kSpaced || hasLines(json))
                                 ? std::string(kLine + 1, ' ')
                                 : oneLine(json);
    if (!json.is_structured() || isNumbers(json) || line.size() + indent <= kLine)
    {
        text += line;
        return;
    }
    text += json.is_object() ? "{\n" : "[\n";
    std::size_t left = json.size();
    for (const auto& item : json.items())
    {
        text += std::string(indent + 2, ' ');
        if (json.is_object()) text += SceneJson(item.key()).dump() + ": ";
        addText(item.value(), indent + 2, text);
        text += --left > 0 ? ",\n" : "\n";
    }
    text += std::string(indent, ' ') + (json.is_object() ? "}" : "]");
}
}  // namespace

SceneJson sceneDocument(const SceneFile& file, const std::string& folder)
{
    const ClothScene& scene = file.m_scene;
    SceneJson json = {{"name", scene.m_name}};
    if (!file.m_description.empty()) json["description"] = file.m_description;
    json["gravity"] = asJson(scene.m_gravity);
    json["time_step"] = scene.m_frameTime;
    json["frames"] = file.m_frames;
    json["steps_per_frame"] = scene.m_stepsPerFrame;
    json["iterations"] = scene.m_iterations;
    json["thickness"] = scene.m_thickness;
    if (scene.m_selfThickness > 0) json["self_thickness"] = scene.m_selfThickness;
    if (scene.m_wind)
        json["wind"] = {{"velocity", asJson(scene.m_wind->m_velocity)},
                        {"air_density", scene.m_wind->m_airDensity},
                        {"drag", scene.m_wind->m_drag}};
    for (const SceneCloth& cloth : scene.m_cloths)
        json["cloths"].push_back(asJson(cloth, file));
    for (const SceneObstacle& obstacle : scene.m_obstacles)
        json["obstacles"].push_back(asJson(obstacle, file, folder));
    return json;
}

std::string sceneText(const SceneJson& document)
{
    std::string text;
    addText(document, 0, text);
    return text + "\n";
}

bool writeScene(const std::string& path, const SceneFile& file, std::string& error)
{
    const std::string no = "this scene cannot be a scene file: ";
    if (double(file.m_frames) * file.m_scene.m_stepsPerFrame > kMostWrittenSteps)
    {
        error = no + "it has more than " + std::to_string(kMostWrittenSteps) + " steps";
        return false;
    }
    std::error_code code;
    const std::string folder = fs::weakly_canonical(fs::absolute(path, code), code).parent_path().string();
    const std::string text = sceneText(sceneDocument(file, folder));
    SceneFile back;
    if (readSceneText(text, path, back, error)) return writeFileAtomically(path, text, error);
    error = no + error;
    return false;
}
}  // namespace drape
