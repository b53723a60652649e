#include "study/trees/tree_quality.h"

#include <algorithm>
#include <cstring>

#include "kernels/lib/geometry/dop.h"
#include "study/kernels/lib/tree_layout.h"

namespace drape
{
namespace
{
struct Visit
{
    std::uint32_t m_node;
    std::uint32_t m_depth;
    std::uint32_t m_waiting;  // siblings of it and its ancestors that a traversal has on its stack
};

// Calls visit for every node below the root, parents first, until it returns false. More visits than there are nodes
// mean that links are no tree.
template <typename Function>
bool walk(const std::vector<BvhNode>& nodes, std::uint32_t root, Function visit)
{
    if (nodes.empty()) return true;
    std::vector<Visit> stack = {Visit{root, 0, 0}};
    for (std::size_t visits = 0; !stack.empty(); ++visits)
    {
        const Visit top = stack.back();
        stack.pop_back();
        if (visits == nodes.size() || top.m_node >= nodes.size() || !visit(top)) return false;
        const BvhNode& node = nodes[top.m_node];
        for (std::uint32_t i = 0; i < node.m_count; ++i)
            stack.push_back(Visit{node.m_first + i, top.m_depth + 1, top.m_waiting + node.m_count - 1});
    }
    return true;
}

double extent(const BvhNode& node, int axis)
{
    return std::max(0.0, double(node.m_high[axis]) - double(node.m_low[axis]));
}

double area(const BvhNode& node)
{
    const double x = extent(node, 0), y = extent(node, 1), z = extent(node, 2);
    return 2 * (x * y + y * z + z * x);
}

bool sameVolume(const BvhNode& node, const Dop& dop)
{
    return std::memcmp(node.m_low, dop.m_low, sizeof(dop.m_low)) == 0 &&
           std::memcmp(node.m_high, dop.m_high, sizeof(dop.m_high)) == 0;
}

Dop hullOfChildren(const std::vector<BvhNode>& nodes, const BvhNode& node)
{
    Dop hull;
    dopClear(&hull);
    for (std::uint32_t child = node.m_first; child < node.m_first + node.m_count && child < nodes.size(); ++child)
    {
        for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
        {
            hull.m_low[i] = drapeMin(hull.m_low[i], nodes[child].m_low[i]);
            hull.m_high[i] = drapeMax(hull.m_high[i], nodes[child].m_high[i]);
        }
    }
    return hull;
}
}  // namespace

TreeQuality measureTree(const std::vector<BvhNode>& nodes, std::uint32_t root)
{
    TreeQuality quality;
    walk(nodes, root,
         [&](const Visit& visit)
         {
             const BvhNode& node = nodes[visit.m_node];
             quality.m_cost += area(node);
             quality.m_volume += extent(node, 0) * extent(node, 1) * extent(node, 2);
             quality.m_height = std::max(quality.m_height, visit.m_depth);
             quality.m_stack = std::max(quality.m_stack, visit.m_waiting + 1);
             ++quality.m_nodes;
             return true;
         });
    if (!nodes.empty() && area(nodes[root]) > 0) quality.m_cost /= area(nodes[root]);
    return quality;
}

std::string whyInvalid(const std::vector<BvhNode>& nodes, std::uint32_t root, const std::vector<std::uint32_t>& order,
                       const std::vector<Triangle>& triangles, const float* positions,
                       const std::vector<float>& meshRadius)
{
    if (order.size() != triangles.size()) return "leaves and triangles differ in number";
    if (nodes.empty()) return triangles.empty() ? "" : "no nodes";
    std::vector<int> seen(triangles.size(), 0);
    std::string why;
    const bool isTree =
        walk(nodes, root,
             [&](const Visit& visit)
             {
                 const BvhNode& node = nodes[visit.m_node];
                 if (visit.m_depth > DRAPE_TREE_HEIGHT) why = "too high";
                 Dop expected;
                 if (node.m_count == 0)
                 {
                     if (node.m_first >= order.size() || order[node.m_first] >= triangles.size())
                     {
                         why = "node " + std::to_string(visit.m_node) + " is a leaf of nothing";
                         return false;
                     }
                     const Triangle& triangle = triangles[order[node.m_first]];
                     ++seen[order[node.m_first]];
                     leafVolume(&expected, &triangle, positions, positions, meshRadius[triangle.m_mesh]);
                 }
                 else
                 {
                     expected = hullOfChildren(nodes, node);
                 }
                 if (!sameVolume(node, expected)) why = "volume of node " + std::to_string(visit.m_node);
                 return why.empty();
             });
    if (!why.empty()) return why;
    if (!isTree) return "links are no tree";
    for (std::size_t i = 0; i < seen.size(); ++i)
    {
        if (seen[i] != 1) return "triangle " + std::to_string(i) + " is in " + std::to_string(seen[i]) + " leaves";
    }
    return std::string();
}
}  // namespace drape
