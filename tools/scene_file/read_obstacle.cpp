#include <cmath>

#include "scenes/shapes.h"
#include "tools/common/suggestion.h"
#include "tools/scene_file/scene_parts.h"

namespace drape
{
namespace
{
using Kind = ObstacleShape::Kind;

constexpr int kMostPoints = 4097;  // a side of a height field

ObstacleShape readBox(const JsonValue& value)
{
    const JsonObject object(value, {"type", "size"});
    ObstacleShape shape;
    shape.m_kind = Kind::Box;
    shape.m_size = object.at("size").vector(kLength);
    return shape;
}

ObstacleShape readRound(const JsonValue& value, Kind kind)
{
    std::vector<std::string> keys = {"type", "radius"};
    if (kind != Kind::Sphere) keys.emplace_back("length");
    const JsonObject object(value, keys);
    ObstacleShape shape;
    shape.m_kind = kind;
    shape.m_radius = object.at("radius").number(kLength);
    if (kind != Kind::Sphere) shape.m_length = object.at("length").number(kLength);
    return shape;
}

ObstacleShape readPlane(const JsonValue& value)
{
    const JsonObject object(value, {"type", "normal", "offset"});
    ObstacleShape shape;
    shape.m_kind = Kind::Plane;
    if (object.has("normal")) shape.m_normal = object.at("normal").direction();
    object.read("offset", shape.m_offset, kCoordinate);
    return shape;
}

ObstacleShape readHeightField(const JsonValue& value)
{
    const JsonObject object(value, {"type", "columns", "rows", "cell", "heights"});
    ObstacleShape shape;
    shape.m_kind = Kind::HeightField;
    shape.m_columns = object.at("columns").whole(2, kMostPoints);
    shape.m_rows = object.at("rows").whole(2, kMostPoints);
    shape.m_cell = object.at("cell").number(kLength);
    for (const double height : object.at("heights").numbers(kCoordinate))
        shape.m_heights.push_back(float(height));
    const std::size_t count = std::size_t(shape.m_columns) * std::size_t(shape.m_rows);
    if (shape.m_heights.size() != count)
        object.at("heights").refuse("columns times rows = " + std::to_string(count) + " numbers");
    return shape;
}

TriangleMesh readBuiltIn(const JsonValue& value)
{
    const JsonObject object(value, {"type", "name", "fit"});
    TriangleMesh mesh;
    makeShape(object.at("name").word(shapeNames()), mesh);
    double fit = 0;
    object.read("fit", fit, kLength);
    if (fit > 0) placeOnFloor(mesh, float(fit));
    return mesh;
}

void readShape(const JsonValue& value, SceneContext& context, SceneObstacle& obstacle)
{
    const std::vector<std::string> types = {"mesh",     "box",   "sphere",       "capsule",
                                            "cylinder", "plane", "height_field", "built_in"};
    if (!value.json().is_object()) value.refuse("an object");
    const SceneJson none;
    const JsonValue type =
        value.json().contains("type") ? JsonValue(value.json().at("type"), value.path() + "/type") : value;
    if (!value.json().contains("type")) value.fail("the key 'type' is missing: one of " + joinedWords(types));
    const std::string word = type.word(types);
    if (word == "mesh") obstacle.m_mesh = readMesh(JsonObject(value, kMeshKeys), context);
    if (word == "built_in") obstacle.m_mesh = readBuiltIn(value);
    if (word == "box") obstacle.m_shape = readBox(value);
    if (word == "sphere") obstacle.m_shape = readRound(value, Kind::Sphere);
    if (word == "capsule") obstacle.m_shape = readRound(value, Kind::Capsule);
    if (word == "cylinder") obstacle.m_shape = readRound(value, Kind::Cylinder);
    if (word == "plane") obstacle.m_shape = readPlane(value);
    if (word == "height_field") obstacle.m_shape = readHeightField(value);
    if (obstacle.m_shape.m_kind != Kind::Mesh) obstacle.m_mesh = triangulated(obstacle.m_shape);
}

// Reads what makes the obstacle static, kinematic or dynamic.
void readState(const JsonObject& object, SceneObstacle& obstacle)
{
    const ScenePose start = readPose(object);
    object.exclude("motion", "mass", "an obstacle with a motion pushes and is not pushed");
    obstacle.m_moves = object.has("motion");
    obstacle.m_poseAt = [start](double) { return start; };
    if (object.has("motion"))
    {
        Vector3 centre = start.m_shift;
        const SceneMotion motion = readMotion(object.at("motion"), centre);
        obstacle.m_poseAt = [=](double time) { return movedPose(motion(time), centre, start); };
    }
    object.read("mass", obstacle.m_mass, kMass);
    const Kind kind = obstacle.m_shape.m_kind;
    if (obstacle.m_mass > 0 && (kind == Kind::Plane || kind == Kind::HeightField))
        object.at("mass").fail("a plane or height field cannot be dynamic");
    for (const char* key : {"velocity", "angular_velocity"})
        if (object.has(key) && !(obstacle.m_mass > 0))
            object.at(key).fail("only an obstacle with a mass has it; a motion moves the others");
    object.read("velocity", obstacle.m_velocity, kSpeed);
    object.read("angular_velocity", obstacle.m_angularVelocity, kSpeed);
}
}  // namespace

SceneObstacle readObstacle(const JsonValue& value, SceneContext& context)
{
    const JsonObject object(value, {"name", "shape", "position", "rotation", "motion", "mass", "friction", "margin",
                                    "velocity", "angular_velocity"});
    SceneObstacle obstacle;
    object.read("name", obstacle.m_name);
    readShape(object.at("shape"), context, obstacle);
    readState(object, obstacle);
    object.read("friction", obstacle.m_friction, {0, 10});
    object.read("margin", obstacle.m_margin, kThicknesses);
    return obstacle;
}
}  // namespace drape
