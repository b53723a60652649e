#include "scenes/cloth_rope.h"
#include "tools/scene_file/scene_parts.h"

namespace drape
{
namespace
{
constexpr int kMostNodesInRow = 65536;

std::vector<float> readEnds(const JsonObject& object)
{
    const Vector3 from = object.at("from").vector(kCoordinate), to = object.at("to").vector(kCoordinate);
    return nodesBetween(from, to, object.at("nodes").whole(2, kMostNodesInRow));
}

std::vector<float> readPositions(const JsonObject& object)
{
    for (const char* key : {"from", "to", "nodes"})
        object.exclude("positions", key, "a rope has ends and a number of nodes, or the position of each node");
    const JsonValue positions = object.at("positions");
    std::vector<float> nodes;
    for (const double coordinate : positions.numbers(kCoordinate))
        nodes.push_back(float(coordinate));
    if (nodes.size() < 6 || nodes.size() % 3 != 0 || nodes.size() > 3 * std::size_t(kMostNodesInRow))
        positions.refuse("three numbers for each of 2 to " + std::to_string(kMostNodesInRow) + " nodes");
    return nodes;
}
}  // namespace

ClothGrid readRope(const JsonValue& value)
{
    const JsonObject object(value, {"type", "from", "to", "nodes", "positions", "bending"});
    const bool listed = object.has("positions");
    if (!listed && !object.has("from") && !object.has("to"))
        value.fail("a rope needs 'from', 'to' and 'nodes', or 'positions'");
    std::vector<float> nodes = listed ? readPositions(object) : readEnds(object);
    for (std::size_t i = 3; i < nodes.size(); i += 3)
        if (nodes[i] == nodes[i - 3] && nodes[i + 1] == nodes[i - 2] && nodes[i + 2] == nodes[i - 1])
            (listed ? object.at("positions") : value)
                .fail("nodes " + std::to_string(i / 3 - 1) + " and " + std::to_string(i / 3) + " are at one point");
    bool bends = false;
    object.read("bending", bends);
    return makeRope(std::move(nodes), bends);
}
}  // namespace drape
