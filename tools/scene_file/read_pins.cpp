#include <algorithm>
#include <array>
#include <set>

#include "tools/common/suggestion.h"
#include "tools/scene_file/scene_parts.h"

namespace drape
{
namespace
{
constexpr double kNear = 1e-3;  // share of the extent within which a node is at a side of the cloth

// The six sides of the bounds: axis and whether it is the upper one.
struct Side
{
    int m_axis;
    bool m_upper;
};

const std::vector<std::string>& sideNames()
{
    static const std::vector<std::string> names = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
    return names;
}

std::vector<std::string> cornerNames()
{
    std::vector<std::string> names;
    const std::vector<std::string>& sides = sideNames();
    for (std::size_t a = 0; a < sides.size(); ++a)
        for (std::size_t b = a / 2 * 2 + 2; b < sides.size(); ++b)
        {
            names.push_back(sides[a] + "_" + sides[b]);
            for (std::size_t c = b / 2 * 2 + 2; c < sides.size(); ++c)
                names.push_back(sides[a] + "_" + sides[b] + "_" + sides[c]);
        }
    return names;
}

// Returns the sides that a name such as x_min_z_max names.
std::vector<Side> sidesOf(const std::string& name)
{
    std::vector<Side> sides;
    for (std::size_t at = 0; at < name.size(); at += 6)
        sides.push_back({name[at] - 'x', name.compare(at + 2, 3, "max") == 0});
    return sides;
}

// Returns the nodes of the cloth at rest that lie at all of the sides of its bounds.
std::vector<int> nodesAt(const TriangleMesh& rest, const std::vector<Side>& sides)
{
    const Bounds bounds = boundsOf(rest);
    std::vector<int> nodes;
    for (std::size_t node = 0; node < rest.vertexCount(); ++node)
    {
        const auto isAt = [&](const Side& side)
        {
            const float wanted =
                side.m_upper ? bounds.m_high[std::size_t(side.m_axis)] : bounds.m_low[std::size_t(side.m_axis)];
            const double off = double(rest.m_positions[3 * node + std::size_t(side.m_axis)]) - double(wanted);
            return std::abs(off) <= kNear * double(bounds.largestExtent());
        };
        if (std::all_of(sides.begin(), sides.end(), isAt)) nodes.push_back(int(node));
    }
    return nodes;
}

void addNamed(const JsonValue& value, const std::vector<std::string>& names, const SceneCloth& cloth,
              std::set<int>& nodes)
{
    value.each(1,
               [&](const JsonValue& item)
               {
                   const std::vector<int> found = nodesAt(cloth.m_rest.m_mesh, sidesOf(item.word(names)));
                   if (found.empty()) item.fail("the cloth has no node there");
                   nodes.insert(found.begin(), found.end());
               });
}

void addBox(const JsonValue& value, const SceneCloth& cloth, std::set<int>& nodes)
{
    const JsonObject box(value, {"min", "max"});
    const Vector3 low = box.at("min").vector(kCoordinate), high = box.at("max").vector(kCoordinate);
    bool any = false;
    for (std::size_t node = 0; node < cloth.nodeCount(); ++node)
    {
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto coordinate = double(cloth.m_positions[3 * node + std::size_t(axis)]);
            inside = inside && coordinate >= low[axis] && coordinate <= high[axis];
        }
        if (inside) nodes.insert(int(node));
        any = any || inside;
    }
    if (!any) value.fail("no node of the cloth starts in the box");
}

// Reads the nodes of a group of pins or anchors.
std::vector<int> readNodes(const JsonObject& object, const char* group, const SceneCloth& cloth)
{
    std::set<int> nodes;
    if (object.has("nodes"))
        object.at("nodes").each(
            1, [&](const JsonValue& item) { nodes.insert(item.whole(0, int(cloth.nodeCount()) - 1)); });
    if (object.has("corners")) addNamed(object.at("corners"), cornerNames(), cloth, nodes);
    if (object.has("edges")) addNamed(object.at("edges"), sideNames(), cloth, nodes);
    if (object.has("box")) addBox(object.at("box"), cloth, nodes);
    if (nodes.empty()) object.value().fail(std::string(group) + " need nodes, corners, edges or a box");
    return {nodes.begin(), nodes.end()};
}

ScenePins readPinGroup(const JsonValue& value, const SceneCloth& cloth)
{
    const JsonObject object(value, {"nodes", "corners", "edges", "box", "motion"});
    ScenePins pins;
    pins.m_nodes = readNodes(object, "pins", cloth);
    if (object.has("motion")) pins.m_motion = readMotion(object.at("motion"), pins.m_centre);
    return pins;
}

// Returns the index of the obstacle with the name.
std::size_t readObstacleName(const JsonValue& value, const std::vector<SceneObstacle>& obstacles)
{
    std::vector<std::string> names;
    for (const SceneObstacle& obstacle : obstacles)
        if (!obstacle.m_name.empty()) names.push_back(obstacle.m_name);
    if (names.empty()) value.fail("no obstacle has a name");
    const std::string name = value.word(names);
    if (std::count(names.begin(), names.end(), name) > 1) value.fail("several obstacles are named '" + name + "'");
    const auto isNamed = [&](const SceneObstacle& obstacle) { return obstacle.m_name == name; };
    return std::size_t(std::find_if(obstacles.begin(), obstacles.end(), isNamed) - obstacles.begin());
}

SceneAnchors readAnchorGroup(const JsonValue& value, const std::vector<SceneObstacle>& obstacles,
                             const SceneCloth& cloth)
{
    const JsonObject object(value, {"nodes", "corners", "edges", "box", "obstacle", "collision", "influence"});
    SceneAnchors anchors;
    anchors.m_nodes = readNodes(object, "anchors", cloth);
    anchors.m_obstacle = readObstacleName(object.at("obstacle"), obstacles);
    object.read("collision", anchors.m_collides);
    object.read("influence", anchors.m_influence, {1e-3, 1});
    return anchors;
}
}  // namespace

void readPins(const JsonValue& value, SceneCloth& cloth)
{
    std::set<int> taken;
    value.each(0,
               [&](const JsonValue& item)
               {
                   const ScenePins pins = readPinGroup(item, cloth);
                   for (const int node : pins.m_nodes)
                       if (!taken.insert(node).second) item.fail("node " + std::to_string(node) + " is pinned twice");
                   cloth.m_pins.push_back(pins);
               });
}

void readAnchors(const JsonValue& value, const std::vector<SceneObstacle>& obstacles, SceneCloth& cloth)
{
    std::set<int> pinned, taken;
    for (const ScenePins& pins : cloth.m_pins)
        pinned.insert(pins.m_nodes.begin(), pins.m_nodes.end());
    value.each(0,
               [&](const JsonValue& item)
               {
                   const SceneAnchors anchors = readAnchorGroup(item, obstacles, cloth);
                   for (const int node : anchors.m_nodes)
                   {
                       const std::string name = "node " + std::to_string(node);
                       if (pinned.count(node) > 0) item.fail(name + " is pinned and cannot be anchored");
                       if (!taken.insert(node).second) item.fail(name + " is anchored twice");
                   }
                   cloth.m_anchors.push_back(anchors);
               });
}
}  // namespace drape
