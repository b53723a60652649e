#include "study/trees/tree_refit.h"

#include "study/kernels/lib/tree_refit.h"
#include "study/trees/radix_sort.h"

namespace drape
{
namespace
{
// These constants equal those of study/kernels/tree_refit.cl.
constexpr std::size_t kSubtreeGroup = 128;
constexpr cl_uint kSubtreeWindow = kSubtreeGroup - DRAPE_SUBTREE_LEAVES;
constexpr cl_uint kSerialWindow = 64;
constexpr std::size_t kGroveGroup = 256;
constexpr std::size_t kGroup = 64;
// Windows of leaves that a serial work-group goes through: a work-group's start costs a CPU as much as some leaves.
constexpr std::size_t kSerialGroup = 8;

std::size_t windowsOf(cl_uint leafCount, cl_uint window)
{
    return (std::size_t(leafCount) + window - 1) / window;
}
}  // namespace

void refitTreeOnHost(Tree& tree, const std::vector<Triangle>& triangles, const float* start, const float* end,
                     const std::vector<float>& meshRadius, std::size_t& invalidNodes)
{
    BvhNode* nodes = tree.m_nodes.data();
    const std::uint32_t leafCount = tree.leafCount();
    for (std::uint32_t leaf = 0; leaf < leafCount; ++leaf)
    {
        const Triangle& triangle = triangles[tree.m_order[leaf]];
        Dop dop;
        invalidNodes += leafVolume(&dop, &triangle, start, end, meshRadius[triangle.m_mesh]);
        dopStore(nodes + leafPlace(nodes, leaf, leafCount), &dop);
    }
    if (leafCount == 0) return;
    forEachFromBelow(tree.m_nodes, tree.m_splits,
                     [&](std::uint32_t split, std::uint32_t place) { mergePair(nodes, split, place); });
}

void TreeRefitStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program program = load("tree_refit");
    m_subtreesSerial.create(device, program, "refitSubtreesSerial");
    m_grovesSerial.create(device, program, "refitGrovesSerial");
    m_topsSerial.create(device, program, "refitTopsSerial");
    m_subtreesGroups.create(device, program, "refitSubtreesGroups");
    m_grovesGroups.create(device, program, "refitGrovesGroups");
    m_topsGroup.create(device, program, "refitTopsGroup");
    m_countTops.create(device, program, "treeCountTops");
    m_listTopsSerial.create(device, program, "treeListTopsSerial");
    m_listTopsGroups.create(device, program, "treeListTopsGroups");
    m_leaves.create(device, program, "refitTreeLeaves");
    m_level.create(device, program, "refitTreeLevel");
}

void TreeRefitStage::prepare(Device& device, DeviceTree& tree, const TreeMethods& methods)
{
    if (methods.m_refit == RefitMethod::Levels)
        listHeights(device, tree);
    else
        listTops(device, tree, methods.m_workShape);
}

void TreeRefitStage::enqueue(Device& device, DeviceTree& tree, LeafBuffers leaves, const TreeMethods& methods)
{
    if (methods.m_refit == RefitMethod::Levels)
        enqueueLevels(device, tree, leaves);
    else
        enqueueSubtrees(device, tree, leaves, methods.m_workShape);
}

void TreeRefitStage::listTops(Device& device, DeviceTree& tree, WorkShape shape)
{
    if (tree.m_leafCount <= DRAPE_GROVE_LEAVES) return;
    if (runsGroups(device, shape))
    {
        tree.m_tops.fill(device, 0, 1);
        m_listTopsGroups.launch(device, tree.m_leafCount, kGroup, tree.m_splits.handle(), tree.m_leafCount,
                                tree.m_tops.handle());
        return;
    }
    const std::size_t windows = windowsOf(tree.m_leafCount, DRAPE_GROVE_LEAVES);
    m_topCounts.reserve(device, windows);
    m_countTops.launch(device, windows * kGroveGroup, kGroveGroup, tree.m_splits.handle(), tree.m_leafCount,
                       m_topCounts.handle());
    m_listTopsSerial.launch(device, windows, kGroup, tree.m_splits.handle(), tree.m_leafCount, m_topCounts.handle(),
                            cl_uint(windows), tree.m_tops.handle());
}

void TreeRefitStage::enqueueSubtrees(Device& device, DeviceTree& tree, LeafBuffers leaves, WorkShape shape)
{
    const cl_uint count = tree.m_leafCount;
    const bool groups = runsGroups(device, shape);
    const std::size_t windows = windowsOf(count, groups ? kSubtreeWindow : kSerialWindow);
    const std::size_t groves = count > DRAPE_SUBTREE_LEAVES ? windowsOf(count, DRAPE_GROVE_LEAVES) : 0;
    Kernel& subtrees = groups ? m_subtreesGroups : m_subtreesSerial;
    subtrees.launch(device, groups ? windows * kSubtreeGroup : windows, groups ? kSubtreeGroup : kSerialGroup,
                    tree.m_nodes.handle(), tree.m_splits.handle(), tree.m_order.handle(), leaves.m_triangles.handle(),
                    leaves.m_start.handle(), leaves.m_end.handle(), leaves.m_meshRadius.handle(),
                    leaves.m_counters.handle(), count);
    if (groups)
    {
        m_grovesGroups.launch(device, groves * kGroveGroup, kGroveGroup, tree.m_nodes.handle(), tree.m_splits.handle(),
                              count);
    }
    else
    {
        m_grovesSerial.launch(device, groves, 1, tree.m_nodes.handle(), tree.m_splits.handle(), count);
    }
    if (count <= DRAPE_GROVE_LEAVES) return;
    if (groups)
    {
        m_topsGroup.launch(device, kGroveGroup, kGroveGroup, tree.m_nodes.handle(), tree.m_splits.handle(),
                           tree.m_tops.handle());
    }
    else
    {
        m_topsSerial.launch(device, 1, 1, tree.m_nodes.handle(), tree.m_splits.handle(), tree.m_tops.handle(), count);
    }
}

void TreeRefitStage::listHeights(Device& device, DeviceTree& tree)
{
    const TreeHeights heights = heightsOf(tree.download(device));
    const WaitAtEnd wait(device);
    tree.m_heightSplits.assign(device, heights.m_splits);
    tree.m_heights = heights.m_ranges;
}

void TreeRefitStage::enqueueLevels(Device& device, DeviceTree& tree, LeafBuffers leaves)
{
    m_leaves.launch(device, tree.m_leafCount, kGroup, tree.m_nodes.handle(), tree.m_order.handle(),
                    leaves.m_triangles.handle(), leaves.m_start.handle(), leaves.m_end.handle(),
                    leaves.m_meshRadius.handle(), leaves.m_counters.handle(), tree.m_leafCount);
    for (const BvhHeight& range : tree.m_heights)
    {
        m_level.launch(device, range.m_count, kGroup, tree.m_nodes.handle(), tree.m_splits.handle(),
                       tree.m_heightSplits.handle(), cl_uint(range.m_first), cl_uint(range.m_count));
    }
}
}  // namespace drape
