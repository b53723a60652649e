#include "study/trees/top_down.h"

#include <algorithm>
#include <cassert>

#include "study/trees/radix_sort.h"

namespace drape
{
namespace
{
constexpr std::size_t kItemGroup = 64;  // for kernels in which a work-item works alone
// Triangles of a large node that a work-group goes through: some rounds of the largest group, so that the second kernel
// of a pair has few blocks to put together.
constexpr cl_uint kLargeBlock = 2048;
// Work-groups a compute unit gets when the nodes of a level are dealt out: enough to even out unequal nodes.
constexpr std::size_t kGroupsPerUnit = 32;
// Nodes a work-group takes at most: the list of those it puts aside must fit into local memory beside the rest.
constexpr std::size_t kNodesPerGroup = 512;
// The median's pivot has a histogram for each digit, like study/kernels/top_down_large.cl.
constexpr cl_uint kMedianBits = 8;
constexpr std::size_t kMedianBins = 1 << kMedianBits;
constexpr cl_uint kCellBits = 24;
static_assert(DRAPE_CENTROID_CELLS == 1u << kCellBits && kCellBits % kMedianBits == 0, "digits make up a cell");
// The least group of the adaptive switch, the thesis's last.
constexpr std::uint32_t kLeastGroup = 16;

cl::LocalSpaceArg floatsOfHulls(std::size_t group)
{
    return cl::Local(2 * DRAPE_DOP_DIRECTIONS * group * sizeof(cl_float));
}
cl::LocalSpaceArg sums(std::size_t group)
{
    return cl::Local(group * sizeof(cl_ulong));
}
cl::LocalSpaceArg words(std::size_t group)
{
    return cl::Local(group * sizeof(cl_uint));
}

// The thesis's estimate of a level's nodes: those of a full tree. On the last levels it says few triangles a node, as
// it should, though they have few nodes.
std::uint32_t groupSizeFor(const TopDownSettings& settings, cl_uint count, cl_uint depth)
{
    std::uint32_t size = settings.m_groupSize;
    if (!settings.m_adaptiveGroups) return size;
    const std::uint32_t mean = count >> std::min<cl_uint>(depth, 31);
    while (size > kLeastGroup && size / 2 >= mean)
        size /= 2;
    return size;
}
}  // namespace

void TopDownStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program program = load("top_down");
    m_summaries.create(device, program, "topDownSummaries");
    m_root.create(device, program, "topDownRoot");
    m_splitGroups.create(device, program);
    m_splitItems.create(device, program);
    m_compactSmall.create(device, program, "topDownCompactSmall");
    m_compactBlocks.create(device, program, "topDownCompactBlocks");
    m_compactScan.create(device, program, "topDownCompactScan");
    m_compactMove.create(device, program, "topDownCompactMove");
    const cl::Program large = load("top_down_large");
    m_largeSums.create(device, large, "largeSums");
    m_largePivots.create(device, large, "largePivots");
    m_largeHistograms.create(device, large, "largeHistograms");
    m_largeMedianDigits.create(device, large, "largeMedianDigits");
    m_largeCounts.create(device, large, "largeCounts");
    m_largeReorder.create(device, large, "largeReorder");
    m_largeVolumes.create(device, large, "largeVolumes");
    m_largeLinks.create(device, large, "largeLinks");
    m_rootBlocks.create(device, large, "largeRootBlocks");
}

void TopDownStage::reserve(Device& device, cl_uint count, const TopDownSettings& settings)
{
    m_centroids.reserve(device, count);
    m_volumes.reserve(device, count);
    m_other.reserve(device, count);
    m_queue.reserve(device, count);  // open nodes have two triangles or more each
    m_children.reserve(device, count + 1);
    m_places.reserve(device, count + 1);
    m_blockCounts.reserve(device, count / settings.m_compactionGroup + 2);
    m_level.reserve(device, 2);
    const std::size_t large = settings.m_largeNodes ? count / settings.m_largeSize + 1 : 1;
    const std::size_t blocks = count / kLargeBlock + large + 1;
    m_large.reserve(device, large);
    m_pivots.reserve(device, large);
    m_blocks.reserve(device, blocks);
    if (settings.m_medianSplit)
    {
        m_histograms.reserve(device, large * kMedianBins);
        m_medianBelow.reserve(device, large);
    }
    m_sums.reserve(device, blocks);
    m_leftCounts.reserve(device, blocks);
    m_hulls.reserve(device, 2 * blocks);
}

void TopDownStage::buildRoot(Device& device, cl_uint count, const TopDownSettings& settings, DeviceTree& tree)
{
    const std::size_t group = settings.m_groupSize;
    if (settings.m_largeNodes && count >= settings.m_largeSize)
    {
        const cl_uint blocks = (count + kLargeBlock - 1) / kLargeBlock;
        launch(device, m_rootBlocks, blocks * group, group, m_volumes.handle(), count, kLargeBlock, m_hulls.handle(),
               floatsOfHulls(group));
        launch(device, m_root, group, group, tree.m_nodes.handle(), m_hulls.handle(), blocks, count, m_queue.handle(),
               floatsOfHulls(group));
        return;
    }
    launch(device, m_root, group, group, tree.m_nodes.handle(), m_volumes.handle(), count, count, m_queue.handle(),
           floatsOfHulls(group));
}

void TopDownStage::findMeans(Device& device, cl_uint depth, const TopDownSettings& settings, DeviceTree& tree)
{
    const std::size_t group = settings.m_groupSize;
    launch(device, m_largeSums, m_blockTable.size() * group, group, tree.m_nodes.handle(), tree.m_order.handle(),
           m_centroids.handle(), m_queue.handle(), m_large.handle(), m_blocks.handle(), m_sums.handle(), sums(group));
    launch(device, m_largePivots, m_largeTable.size() * group, group, m_queue.handle(), m_large.handle(),
           m_sums.handle(), m_pivots.handle(), depth, cl_uint(settings.m_leafSize), sums(group));
}

void TopDownStage::findMedians(Device& device, cl_uint depth, const TopDownSettings& settings, DeviceTree& tree)
{
    const std::size_t group = settings.m_groupSize, nodes = m_largeTable.size();
    m_histograms.fill(device, 0, nodes * kMedianBins);
    m_medianBelow.fill(device, 0, nodes);
    m_pivots.fill(device, 0, nodes);
    for (cl_uint shift = kCellBits; shift > 0;)
    {
        shift -= kMedianBits;
        launch(device, m_largeHistograms, m_blockTable.size() * group, group, tree.m_nodes.handle(),
               tree.m_order.handle(), m_centroids.handle(), m_queue.handle(), m_large.handle(), m_blocks.handle(),
               m_pivots.handle(), shift, m_histograms.handle(), words(kMedianBins));
        launch(device, m_largeMedianDigits, nodes * group, group, m_queue.handle(), m_large.handle(),
               m_histograms.handle(), m_pivots.handle(), m_medianBelow.handle(), shift, depth,
               cl_uint(settings.m_leafSize), words(group));
    }
}

// While a level may hold large nodes the host has its queue, and deals their triangles out in blocks.
void TopDownStage::splitLarge(Device& device, cl_uint depth, const TopDownSettings& settings, DeviceTree& tree)
{
    std::vector<LargeNode>& large = m_largeTable;
    std::vector<LargeBlock>& blocks = m_blockTable;
    large.clear();
    blocks.clear();
    for (std::size_t i = 0; i < m_open.size(); ++i)
    {
        const OpenNode& node = m_open[i];
        if (node.m_end - node.m_first < settings.m_largeSize) continue;
        const cl_uint firstBlock = cl_uint(blocks.size());
        for (cl_uint first = node.m_first; first < node.m_end; first += kLargeBlock)
        {
            blocks.push_back(
                LargeBlock{cl_uint(large.size()), first, std::min(node.m_end, first + kLargeBlock), firstBlock});
        }
        large.push_back(LargeNode{cl_uint(i), firstBlock, cl_uint(blocks.size()) - firstBlock});
    }
    m_levels.back().m_largeNodes = std::uint32_t(large.size());
    if (large.empty()) return;
    m_large.write(device, large.data(), large.size());
    m_blocks.write(device, blocks.data(), blocks.size());
    const std::size_t group = settings.m_groupSize;
    const std::size_t onBlocks = blocks.size() * group, onNodes = large.size() * group;
    if (settings.m_medianSplit)
        findMedians(device, depth, settings, tree);
    else
        findMeans(device, depth, settings, tree);
    launch(device, m_largeCounts, onBlocks, group, tree.m_nodes.handle(), tree.m_order.handle(), m_centroids.handle(),
           m_queue.handle(), m_large.handle(), m_blocks.handle(), m_pivots.handle(), m_leftCounts.handle(),
           sums(group));
    launch(device, m_largeReorder, onBlocks, group, tree.m_nodes.handle(), tree.m_order.handle(), m_other.handle(),
           m_centroids.handle(), m_queue.handle(), m_large.handle(), m_blocks.handle(), m_pivots.handle(),
           m_leftCounts.handle(), sums(group), words(group));
    launch(device, m_largeVolumes, onBlocks, group, tree.m_order.handle(), m_other.handle(), m_volumes.handle(),
           m_queue.handle(), m_large.handle(), m_blocks.handle(), m_leftCounts.handle(), m_hulls.handle(), sums(group),
           floatsOfHulls(group));
    launch(device, m_largeLinks, onNodes, group, tree.m_nodes.handle(), tree.m_splits.handle(), m_queue.handle(),
           m_large.handle(), m_leftCounts.handle(), m_hulls.handle(), m_children.handle(), sums(group),
           floatsOfHulls(group));
}

void TopDownStage::splitLevel(Device& device, cl_uint depth, const TopDownSettings& settings, DeviceTree& tree)
{
    TopDownLevel& level = m_levels.back();
    const cl_uint nodes = level.m_nodes;
    const cl_uint largeSize = settings.m_largeNodes ? settings.m_largeSize : ~0u;
    if (settings.m_largeNodes && !m_open.empty()) splitLarge(device, depth, settings, tree);
    if (level.m_largeNodes == nodes) return;
    SplitValues values = {{depth, settings.m_leafSize, settings.m_medianSplit ? 1u : 0u}, nodes, 0, 0, largeSize};
    const bool direct = settings.m_smallSplits && float(level.m_smallNodes) >= settings.m_smallShare * float(nodes);
    if (direct)
    {
        launch(device, m_splitItems, nodes, kItemGroup, values, tree.m_nodes, tree.m_splits, tree.m_order, m_other,
               m_centroids, m_volumes, m_queue, m_children);
        return;
    }
    const std::size_t group = groupSizeFor(settings, tree.m_leafCount, depth);
    level.m_groupSize = std::uint32_t(group);
    const std::size_t wanted = std::max(kGroupsPerUnit * device.computeUnits(), nodes / kNodesPerGroup + 1);
    values.m_nodesPerGroup = cl_uint((nodes + wanted - 1) / wanted);
    values.m_smallSize = settings.m_smallSplits ? settings.m_smallSize : 0;
    const std::size_t groups = (nodes + values.m_nodesPerGroup - 1) / values.m_nodesPerGroup;
    launch(device, m_splitGroups, groups * group, group, values, tree.m_nodes, tree.m_splits, tree.m_order, m_other,
           m_centroids, m_volumes, m_queue, m_children, group, group + values.m_nodesPerGroup,
           2 * DRAPE_DOP_DIRECTIONS * group);
}

void TopDownStage::compact(Device& device, const TopDownSettings& settings)
{
    const cl_uint count = 2 * m_levels.back().m_nodes;
    const std::size_t group = settings.m_compactionGroup;
    const cl_uint smallSize = settings.m_smallSize;
    m_level.fill(device, 0, 2);
    if (count <= 2 * group)
    {
        launch(device, m_compactSmall, group, group, m_children.handle(), count, smallSize, m_queue.handle(),
               m_level.handle(), words(group));
        return;
    }
    const cl_uint blocks = cl_uint((count + group - 1) / group);
    launch(device, m_compactBlocks, count, group, m_children.handle(), count, m_places.handle(), m_blockCounts.handle(),
           words(group));
    launch(device, m_compactScan, group, group, m_blockCounts.handle(), blocks, m_level.handle(), words(group));
    launch(device, m_compactMove, count, group, m_children.handle(), count, smallSize, m_places.handle(),
           m_blockCounts.handle(), m_queue.handle(), m_level.handle());
}

void TopDownStage::build(Device& device, Buffer<Triangle>& triangles, Buffer<float>& positions, cl_uint count,
                         const TopDownSettings& settings, DeviceTree& tree)
{
    assert(count > 0 && settings.m_leafSize > 0);
    m_levels.assign(1, TopDownLevel());
    m_levels.back().m_nodes = 1;
    reserve(device, count, settings);
    launch(device, m_summaries, count, kItemGroup, triangles.handle(), positions.handle(), count, m_centroids.handle(),
           m_volumes.handle(), tree.m_order.handle());
    buildRoot(device, count, settings, tree);
    m_open.assign(1, OpenNode{0, 0, count});
    cl_uint open[2] = {count > 1 ? 1u : 0u, count <= settings.m_smallSize ? 1u : 0u};
    for (cl_uint depth = 0; open[0] > 0 && !device.failed(); ++depth)
    {
        m_levels.push_back(TopDownLevel());
        m_levels.back().m_nodes = open[0];
        m_levels.back().m_smallNodes = open[1];
        splitLevel(device, depth, settings, tree);
        compact(device, settings);
        m_level.read(device, open, 2);
        // There are no more large nodes than fit into all triangles, and where there were none there are none below.
        const std::size_t most = m_levels.back().m_largeNodes > 0 ? 2 * std::size_t(m_levels.back().m_nodes) : 0;
        m_open.resize(std::min<std::size_t>(most, count));
        m_queue.read(device, m_open.data(), m_open.size());
        device.wait();
        m_open.resize(std::min<std::size_t>(m_open.size(), open[0]));
    }
}
}  // namespace drape
