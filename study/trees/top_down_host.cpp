#include "study/trees/top_down.h"

#include <numeric>

namespace drape
{
namespace
{
Dop hullOf(const std::vector<Dop>& volumes)
{
    Dop hull;
    dopClear(&hull);
    for (const Dop& volume : volumes)
        dopAddDop(&hull, &volume);
    return hull;
}
}  // namespace

Tree buildTopDownOnHost(const std::vector<Triangle>& triangles, const float* positions, const TopDownSettings& settings)
{
    Tree tree;
    const std::uint32_t count = std::uint32_t(triangles.size());
    resizeTree(tree, count);
    if (count == 0) return tree;
    std::iota(tree.m_order.begin(), tree.m_order.end(), 0u);
    std::vector<Vec3> centroids(count);
    std::vector<Dop> volumes(count);
    for (std::uint32_t i = 0; i < count; ++i)
    {
        centroids[i] = triangleCentroid(&triangles[i], positions);
        leafVolume(&volumes[i], &triangles[i], positions, positions, 0.0f);
    }
    const Dop root = hullOf(volumes);
    dopStore(tree.m_nodes.data(), &root);
    if (count == 1) treeSetLeaf(tree.m_nodes.data(), 0, 0);

    const TriangleSummary summary = {centroids.data(), volumes.data()};
    std::vector<std::uint32_t> other(count);
    std::vector<OpenNode> queue, next;
    if (count > 1) queue.push_back(OpenNode{0, 0, count});
    for (std::uint32_t depth = 0; !queue.empty(); ++depth)
    {
        const SplitRule rule = {depth, settings.m_leafSize, settings.m_medianSplit ? 1u : 0u};
        next.clear();
        for (const OpenNode& node : queue)
        {
            OpenNode children[2];
            splitSerial(tree.m_nodes.data(), tree.m_splits.data(), tree.m_order.data(), other.data(), &summary, &rule,
                        &node, children);
            for (const OpenNode& child : children)
            {
                if (child.m_end > child.m_first) next.push_back(child);
            }
        }
        queue.swap(next);
    }
    return tree;
}
}  // namespace drape
