#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/mesh_scan.h"

namespace drape
{
namespace
{
// Of brackets and of nodes: readers go down both by calling themselves.
constexpr std::size_t kMostDepth = 512;

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
}  // namespace

std::string scanGltf(const std::string& text)
{
    if (isNestedTooDeep(text)) return "not a mesh: brackets nested deeper than " + std::to_string(kMostDepth);
    const Json content = Json::parse(text, nullptr, false);
    if (content.is_discarded() || !content.is_object()) return "not a mesh: not glTF";
    // Version 1 names its nodes; what it lacks Assimp says.
    return content.contains("nodes") && content["nodes"].is_array() ? nodesProblem(content["nodes"]) : "";
}
}  // namespace drape
