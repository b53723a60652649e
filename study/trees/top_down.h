// Construction from the root down, level by level, as the thesis builds it, with its optimisations as switches.
//
// Input: triangles and positions. Output: order, links and volumes. The tree depends on the rule (mean or median, leaf
// size) alone: no switch, group size or device changes a bit. Waits for the device once a level.
#pragma once

#include <vector>

#include "bullet_plugin/core/device/bound_kernel.h"
#include "study/methods.h"
#include "study/kernels/lib/top_down.h"
#include "study/kernels/top_down_bindings.h"
#include "study/trees/tree.h"

namespace drape
{
Tree buildTopDownOnHost(const std::vector<Triangle>& triangles, const float* positions,
                        const TopDownSettings& settings);

// Figures of a level's construction, for the study.
struct TopDownLevel
{
    std::uint32_t m_nodes = 0;
    std::uint32_t m_smallNodes = 0;
    std::uint32_t m_largeNodes = 0;
    std::uint32_t m_groupSize = 0;  // 0: a work-item per node
    std::uint32_t m_launches = 0;   // kernel launches of the level, its compaction included
};

class TopDownStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Waits. count ≥ 1; the tree has room.
    void build(Device& device, Buffer<Triangle>& triangles, Buffer<float>& positions, cl_uint count,
               const TopDownSettings& settings, DeviceTree& tree);

    // Returns the levels of the last build; the first is the root's.
    const std::vector<TopDownLevel>& levels() const { return m_levels; }

private:
    // Equals the struct in study/kernels/top_down_large.cl.
    struct LargeBlock
    {
        cl_uint m_node, m_first, m_end, m_firstBlock;
    };
    struct LargeNode
    {
        cl_uint m_queued, m_firstBlock, m_blockCount;
    };

    void reserve(Device& device, cl_uint count, const TopDownSettings& settings);
    void buildRoot(Device& device, cl_uint count, const TopDownSettings& settings, DeviceTree& tree);
    void splitLevel(Device& device, cl_uint depth, const TopDownSettings& settings, DeviceTree& tree);
    void splitLarge(Device& device, cl_uint depth, const TopDownSettings& settings, DeviceTree& tree);
    // Pivots of the level's large nodes, by blocks of their triangles: the means, or the medians.
    void findMeans(Device& device, cl_uint depth, const TopDownSettings& settings, DeviceTree& tree);
    void findMedians(Device& device, cl_uint depth, const TopDownSettings& settings, DeviceTree& tree);
    void compact(Device& device, const TopDownSettings& settings);
    template <typename AnyKernel, typename... Arguments>
    void launch(Device& device, AnyKernel& kernel, std::size_t items, std::size_t group, Arguments&&... arguments)
    {
        ++m_levels.back().m_launches;
        kernel.launch(device, items, group, arguments...);
    }

    Kernel m_summaries, m_root;
    BoundKernel<kernels::topDownSplitGroups> m_splitGroups;
    BoundKernel<kernels::topDownSplitItems> m_splitItems;
    Kernel m_compactSmall, m_compactBlocks, m_compactScan, m_compactMove;
    Kernel m_largeSums, m_largePivots, m_largeHistograms, m_largeMedianDigits, m_largeCounts, m_largeReorder,
        m_largeVolumes, m_largeLinks, m_rootBlocks;

    std::vector<TopDownLevel> m_levels;
    std::vector<OpenNode> m_open;  // the queue on the host, while it may hold large nodes
    std::vector<LargeNode> m_largeTable;
    std::vector<LargeBlock> m_blockTable;
    Buffer<Vec3> m_centroids;
    Buffer<Dop> m_volumes, m_hulls;
    Buffer<OpenNode> m_queue, m_children;
    Buffer<cl_uint> m_other, m_level, m_places, m_blockCounts, m_pivots, m_leftCounts, m_histograms, m_medianBelow;
    Buffer<cl_ulong> m_sums;
    Buffer<LargeNode> m_large;
    Buffer<LargeBlock> m_blocks;
};
}  // namespace drape
