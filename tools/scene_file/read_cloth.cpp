#include <cmath>

#include "scenes/cloth_mesh.h"
#include "scenes/cloth_rope.h"
#include "tools/common/suggestion.h"
#include "tools/scene_file/materials.h"
#include "tools/scene_file/scene_parts.h"

namespace drape
{
namespace
{
constexpr int kMostNodesASide = 4096;  // the limit of cloth_drop --cloth, too
constexpr double kPi = 3.14159265358979323846;

void readNumbers(const JsonObject& object, SceneMaterial& material)
{
    object.read("stretch", material.m_stretch, {1e-6, 1});
    object.read("bending", material.m_bending, {1e-6, 1});
    object.read("damping", material.m_damping, {0, 1});
    object.read("friction", material.m_friction, {0, 1});
    object.read("density", material.m_areaMass, {1e-6, 1e3});
}

SceneMaterial materialNamed(const JsonValue& value, const SceneContext& context)
{
    std::vector<std::string> names;
    for (const auto& known : context.m_materials)
        names.push_back(known.first);
    return context.m_materials.at(value.word(names));
}

ClothGrid readGrid(const JsonValue& value, ClothShape& shape)
{
    const JsonObject object(value, {"type", "columns", "rows", "size"});
    shape.m_kind = ClothShape::Kind::Grid;
    shape.m_columns = object.at("columns").whole(2, kMostNodesASide);
    shape.m_rows = object.at("rows").whole(2, kMostNodesASide);
    shape.m_size = object.at("size").number(kLength);
    return makeClothGrid(shape.m_columns, shape.m_rows, float(shape.m_size), 0);
}

ClothGrid readTube(const JsonValue& value, ClothShape& shape)
{
    const JsonObject object(value, {"type", "around", "rows", "radius", "height"});
    shape.m_kind = ClothShape::Kind::Tube;
    shape.m_columns = object.at("around").whole(5, kMostNodesASide);
    shape.m_rows = object.at("rows").whole(3, kMostNodesASide);
    shape.m_size = object.at("radius").number(kLength);
    shape.m_height = object.at("height").number(kLength);
    return makeClothTube(shape.m_columns, shape.m_rows, float(shape.m_size), float(shape.m_height));
}

void readShape(const JsonValue& value, SceneContext& context, SceneCloth& cloth)
{
    const std::vector<std::string> types = {"grid", "tube", "mesh", "rope"};
    if (!value.json().is_object()) value.refuse("an object");
    if (!value.json().contains("type")) value.fail("the key 'type' is missing: one of " + joinedWords(types));
    const std::string type = JsonValue(value.json().at("type"), value.path() + "/type").word(types);
    if (type == "grid") cloth.m_rest = readGrid(value, cloth.m_shape);
    if (type == "tube") cloth.m_rest = readTube(value, cloth.m_shape);
    if (type == "rope")
    {
        cloth.m_shape.m_kind = ClothShape::Kind::Rope;
        cloth.m_rest = readRope(value);
    }
    if (type == "mesh") cloth.m_rest = clothOfMesh(readMesh(JsonObject(value, kMeshKeys), context));
}

void readPlaces(const JsonObject& object, SceneCloth& cloth)
{
    const char* const reason = "'positions' says where each node starts";
    object.exclude("positions", "position", reason);
    object.exclude("positions", "rotation", reason);
    const std::vector<float>& rest = cloth.m_rest.m_mesh.m_positions;
    if (object.has("positions"))
    {
        for (const double coordinate : object.at("positions").numbers(kCoordinate))
            cloth.m_positions.push_back(float(coordinate));
        if (cloth.m_positions.size() != rest.size())
            object.at("positions").refuse("three numbers for each node = " + std::to_string(rest.size()));
        return;
    }
    const ScenePose pose = readPose(object);
    for (std::size_t i = 0; i < rest.size(); i += 3)
    {
        const Vector3 place = movedPoint(pose, {}, {rest[i], rest[i + 1], rest[i + 2]});
        cloth.m_positions.insert(cloth.m_positions.end(), {float(place.x), float(place.y), float(place.z)});
    }
}

// A grid's and a tube's nodes have equal masses. Those of a mesh have masses by the areas around them, those of a rope
// by the lengths beside them.
void readMasses(const JsonObject& object, SceneCloth& cloth)
{
    if (cloth.isRope())
    {
        if (!object.has("mass")) object.value().fail("the key 'mass' is missing: a rope has no area");
        object.read("mass", cloth.m_mass, kMass);
        cloth.m_nodeMasses = massesByLength(cloth.m_rest.m_mesh.m_positions, cloth.m_mass);
        return;
    }
    const double area = areaOf(cloth.m_rest.m_mesh);
    cloth.m_mass = cloth.m_material.m_areaMass * area;
    object.read("mass", cloth.m_mass, kMass);
    if (cloth.m_shape.m_kind != ClothShape::Kind::Mesh) return;
    if (!(area > 0)) object.at("shape").fail("the cloth has no area");
    cloth.m_nodeMasses = massesByArea(cloth.m_rest.m_mesh, cloth.m_mass);
    for (const double mass : cloth.m_nodeMasses)
        if (!(mass > 0)) object.at("shape").fail("a vertex belongs to no triangle with an area");
}
}  // namespace

SceneMaterial readMaterial(const JsonValue& value, const SceneContext& context)
{
    if (value.json().is_string()) return materialNamed(value, context);
    if (!value.json().is_object()) value.refuse("the name of a material, or an object");
    const JsonObject object(value, {"base", "stretch", "bending", "damping", "friction", "density"});
    SceneMaterial material = materialPresets().front().m_material;
    if (object.has("base")) material = materialNamed(object.at("base"), context);
    readNumbers(object, material);
    return material;
}

void readMaterials(const JsonValue& value, SceneContext& context)
{
    if (!value.json().is_object()) value.refuse("an object: materials by name");
    for (const auto& item : value.json().items())
    {
        const JsonValue material(item.value(), value.path() + "/" + item.key());
        if (item.key().empty()) value.fail("a material needs a name");
        if (!item.value().is_object()) material.refuse("an object");
        context.m_materials[item.key()] = readMaterial(material, context);
    }
}

SceneCloth readCloth(const JsonValue& value, SceneContext& context)
{
    const JsonObject object(value,
                            {"name", "shape", "position", "rotation", "positions", "rest", "material", "mass", "margin",
                             "self_collision", "velocity", "pins", "anchors", "pressure", "volume_conservation"});
    SceneCloth cloth;
    object.read("name", cloth.m_name);
    cloth.m_material = materialPresets().front().m_material;
    if (object.has("material")) cloth.m_material = readMaterial(object.at("material"), context);
    readShape(object.at("shape"), context, cloth);
    readPlaces(object, cloth);
    readMasses(object, cloth);
    readVolume(object, cloth);
    if (object.has("rest")) cloth.m_restsAtStart = object.at("rest").word({"shape", "start"}) == "start";
    object.read("margin", cloth.m_margin, kThicknesses);
    cloth.m_selfCollides = false;
    if (object.value().json().contains("self_collision")) object.read("self_collision", cloth.m_selfCollides);
    object.read("velocity", cloth.m_velocity, kSpeed);
    if (object.has("pins")) readPins(object.at("pins"), cloth);
    if (object.has("anchors")) readAnchors(object.at("anchors"), context.m_file->m_scene.m_obstacles, cloth);
    return cloth;
}
}  // namespace drape
