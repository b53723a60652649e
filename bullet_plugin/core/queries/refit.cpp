#include "refit.h"

#include <algorithm>

#include "kernels/lib/geometry/dop.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
// A height of at most this many nodes is cheaper in the climb of one group than as a launch (3 µs on an H200).
constexpr std::size_t kClimbGroup = 128;
}  // namespace

void refitOnHost(std::vector<BvhNode>& nodes, const BvhLayout& layout, const std::vector<std::uint32_t>& order,
                 const std::vector<Triangle>& triangles, const float* start, const float* end,
                 const std::vector<float>& meshRadius, std::size_t& invalidNodes)
{
    for (std::uint32_t leaf = 0; leaf < layout.leafCount(); ++leaf)
    {
        const Triangle& triangle = triangles[order[leaf]];
        Dop dop;
        invalidNodes += leafVolume(&dop, &triangle, start, end, meshRadius[triangle.m_mesh]);
        dopStore(&nodes[leaf], &dop);
    }
    for (std::uint32_t node = layout.leafCount(); node < layout.nodeCount(); ++node)
        dopMergeChildren(nodes.data(), node);
}

void RefitStage::create(Device& device, const cl::Program& program)
{
    m_leaves.create(device, program);
    m_level.create(device, program);
    m_top.create(device, program);
}

void RefitStage::makeLevels(Device& device, const BvhLayout& layout, Levels& levels) const
{
    levels.m_launched = 0;
    for (std::size_t height = 1; height < layout.m_heights.size(); ++height)
    {
        if (layout.m_heights[height].m_count > 2 * kClimbGroup) levels.m_launched = height;
    }
    std::vector<NodeRange> table;
    for (std::size_t height = levels.m_launched + 1; height < layout.m_heights.size(); ++height)
        table.push_back({layout.m_heights[height].m_first, layout.m_heights[height].m_count});
    levels.m_climbed = table.size();
    const WaitAtEnd wait(device);
    levels.m_table.assign(device, table);
}

void RefitStage::enqueue(Device& device, const BvhLayout& layout, Levels& levels, Buffer<BvhNode>& nodes,
                         Buffer<cl_uint>& order, Buffer<Triangle>& triangles, Buffer<float>& start, Buffer<float>& end,
                         Buffer<float>& meshRadius, Buffer<StepCounters>& counters)
{
    const cl_uint leafCount = layout.leafCount();
    m_leaves.launch(device, leafCount, kGroup, {0, leafCount}, nodes, order, triangles, start, end, meshRadius,
                    counters);
    for (std::size_t height = 1; height <= levels.m_launched; ++height)
    {
        const BvhHeight& level = layout.m_heights[height];
        m_level.launch(device, level.m_count, kGroup, {level.m_first, level.m_count}, nodes);
    }
    if (levels.m_climbed > 0)
    {
        m_top.launch(device, kClimbGroup, kClimbGroup, cl_uint(levels.m_climbed), nodes, levels.m_table);
    }
}
}  // namespace drape
