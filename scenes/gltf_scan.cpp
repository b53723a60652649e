#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/mesh_scan.h"

namespace drape
{
namespace
{
// Of brackets and of nodes: readers go down both by calling themselves.
constexpr std::size_t kMostDepth = 512;

constexpr int kFloat = 5126;  // of an accessor's componentType, as in OpenGL
// How the names of extensions begin that change materials, textures and lights alone.
constexpr const char* kOfLooks[] = {"KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_", "EXT_lights_"};
// Assimp reads it, or says that it was built without.
constexpr const char* kDraco = "KHR_draco_mesh_compression";

using Json = nlohmann::json;

// Before anything parses it.
bool isNestedTooDeep(const std::string& text)
{
    std::size_t depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size() && depth <= kMostDepth; ++i)
    {
        const char c = text[i];
        if (quoted && c == '\\')
            ++i;
        else if (c == '"')
            quoted = !quoted;
        if (quoted) continue;
        if (c == '[' || c == '{') ++depth;
        if ((c == ']' || c == '}') && depth > 0) --depth;
    }
    return depth > kMostDepth;
}

std::vector<std::size_t> childrenOf(const Json& node)
{
    std::vector<std::size_t> children;
    if (!node.is_object() || !node.contains("children") || !node["children"].is_array()) return children;
    for (const Json& child : node["children"])
        if (child.is_number_unsigned()) children.push_back(child.get<std::size_t>());
    return children;
}

// Nodes are trees, as the format says: a node with two parents would be read twice, and its children four times.
std::string nodesProblem(const Json& nodes)
{
    std::vector<std::vector<std::size_t>> children;
    std::vector<bool> hasParent(nodes.size(), false);
    for (const Json& node : nodes)
    {
        children.push_back(childrenOf(node));
        for (const std::size_t child : children.back())
        {
            if (child >= nodes.size()) return "node " + std::to_string(child) + " is out of range";
            if (hasParent[child]) return "node " + std::to_string(child) + " has two parents";
            hasParent[child] = true;
        }
    }
    std::vector<std::size_t> level;
    for (std::size_t node = 0; node < nodes.size(); ++node)
        if (!hasParent[node]) level.push_back(node);
    for (std::size_t depth = 0; !level.empty(); ++depth)
    {
        if (depth > kMostDepth) return "nodes hang deeper than " + std::to_string(kMostDepth);
        std::vector<std::size_t> next;
        for (const std::size_t node : level)
            next.insert(next.end(), children[node].begin(), children[node].end());
        level.swap(next);
    }
    return "";
}

// What an object has under a name; null where there is none.
const Json& under(const Json& object, const std::string& name)
{
    static const Json none;
    const auto found = object.find(name);
    return found == object.end() ? none : *found;
}

// Null where there is none.
const Json& accessorOf(const Json& accessors, const Json& key)
{
    if (key.is_string()) return under(accessors, key.get<std::string>());
    static const Json none;
    const bool there = accessors.is_array() && key.is_number_unsigned() && key.get<std::size_t>() < accessors.size();
    return there ? accessors[key.get<std::size_t>()] : none;
}

// Assimp copies what an accessor has, whatever it is, to where three floats should be. One that is not there it tells
// of.
std::string positionsProblem(const Json& content)
{
    for (const Json& mesh : under(content, "meshes"))
        for (const Json& primitive : under(mesh, "primitives"))
            for (const auto& attribute : under(primitive, "attributes").items())
            {
                const Json& accessor = accessorOf(under(content, "accessors"), attribute.value());
                if (attribute.key().rfind("POSITION", 0) != 0 || accessor.is_null()) continue;
                const Json& type = under(accessor, "componentType");
                if (!type.is_number_integer() || type != kFloat || under(accessor, "type") != "VEC3")
                    return "accessor " + attribute.value().dump() + ": positions are not VEC3 of floats, which alone " +
                           "are read";
            }
    return "";
}

bool leavesPositions(const std::string& extension)
{
    for (const char* start : kOfLooks)
        if (extension.rfind(start, 0) == 0) return true;
    return extension == kDraco;
}

// What a file does not only use but require changes what its numbers mean.
std::string extensionsProblem(const Json& extensions)
{
    for (const Json& extension : extensions)
        if (!extension.is_string() || !leavesPositions(extension.get<std::string>()))
            return "requires the extension " + extension.dump().substr(0, 64) + ", which is not read";
    return "";
}
}  // namespace

std::string scanGltf(const std::string& text)
{
    if (isNestedTooDeep(text)) return "not a mesh: brackets nested deeper than " + std::to_string(kMostDepth);
    const Json content = Json::parse(text, nullptr, false);
    if (content.is_discarded() || !content.is_object()) return "not a mesh: not glTF";
    // Version 1 names its nodes, meshes and accessors; what it lacks Assimp says.
    std::string problem = under(content, "nodes").is_array() ? nodesProblem(content["nodes"]) : "";
    if (problem.empty()) problem = extensionsProblem(under(content, "extensionsRequired"));
    return problem.empty() ? positionsProblem(content) : problem;
}
}  // namespace drape
