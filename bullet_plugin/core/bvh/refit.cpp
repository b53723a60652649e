#include "refit.h"

#include <algorithm>

#include "kernels/lib/rigid_motion.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
// A height of at most this many nodes is cheaper in the climb of one group than as a launch (3 µs on an H200).
constexpr std::size_t kClimbGroup = 128;

void mergeUpwards(std::vector<BvhNode>& nodes, std::uint32_t first, std::uint32_t last)
{
    for (std::uint32_t node = first; node < last; ++node)
        dopMergeChildren(nodes.data(), node);
}
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
        dopStore(&nodes[layout.leafNode(leaf)], &dop);
    }
    mergeUpwards(nodes, 0, layout.nodeCount());
}

void refitMeshOnHost(std::vector<BvhNode>& nodes, const BvhLayout& layout, std::size_t slot,
                     const std::vector<std::uint32_t>& order, const std::vector<Triangle>& triangles,
                     const float* positions)
{
    for (std::uint32_t leaf = layout.blockLeaf(slot); leaf < layout.blockLeaf(slot + 1); ++leaf)
    {
        Dop dop;
        leafVolume(&dop, &triangles[order[leaf]], positions, positions, 0.0f);
        dopStore(&nodes[layout.leafNode(leaf)], &dop);
    }
    mergeUpwards(nodes, layout.blockNode(slot), layout.blockNode(slot + 1));
}

void refitTopOnHost(std::vector<BvhNode>& nodes, const BvhLayout& layout)
{
    mergeUpwards(nodes, layout.top(), layout.nodeCount());
}

void growByMotionsOnHost(std::vector<BvhNode>& nodes, const BvhLayout& layout, const std::vector<std::uint32_t>& order,
                         const std::vector<Triangle>& triangles, const float* start, const float* end,
                         const std::vector<float>& meshRadius, const std::vector<ObstacleMotion>& motions,
                         const std::vector<float>& thickness, std::size_t obstacleMeshes)
{
    if (motions.empty()) return;
    for (std::uint32_t leaf = 0; leaf < layout.leafCount(); ++leaf)
    {
        const Triangle& triangle = triangles[order[leaf]];
        const float radius = meshRadius[triangle.m_mesh];
        if (radius < 0.0f) continue;
        growByMotions(&nodes[layout.leafNode(leaf)], motions.data(), std::uint32_t(motions.size()),
                      &thickness[triangle.m_mesh * obstacleMeshes], &triangle, start, end, radius);
    }
    mergeUpwards(nodes, 0, layout.nodeCount());
}

void RefitStage::create(Device& device, const cl::Program& program)
{
    m_leaves.create(device, program, "refitLeaves");
    m_movingLeaves.create(device, program, "refitMovingLeaves");
    m_level.create(device, program, "refitLevel");
    m_top.create(device, program, "refitTop");
}

void RefitStage::makeLevels(Device& device, const BvhLayout& layout, Levels& levels) const
{
    levels.m_launched = 0;
    for (std::size_t height = 1; height < layout.m_heights.size(); ++height)
    {
        if (layout.m_heights[height].m_count > 2 * kClimbGroup) levels.m_launched = height;
    }
    std::vector<cl_uint> table, leafNodes(layout.leafCount());
    for (std::size_t height = levels.m_launched + 1; height < layout.m_heights.size(); ++height)
    {
        table.push_back(layout.m_heights[height].m_first);
        table.push_back(layout.m_heights[height].m_count);
    }
    for (std::uint32_t leaf = 0; leaf < leafNodes.size(); ++leaf)
        leafNodes[leaf] = layout.leafNode(leaf);
    levels.m_climbed = table.size() / 2;
    const WaitAtEnd wait(device);
    levels.m_table.assign(device, table);
    levels.m_leafNodes.assign(device, leafNodes);
}

void RefitStage::enqueue(Device& device, const BvhLayout& layout, Levels& levels, Buffer<BvhNode>& nodes,
                         Buffer<cl_uint>& order, Buffer<Triangle>& triangles, Buffer<float>& start, Buffer<float>& end,
                         Buffer<float>& meshRadius, Buffer<StepCounters>& counters, Motions* motions)
{
    const cl_uint leafCount = layout.leafCount();
    m_leaves.launch(device, leafCount, kGroup, nodes.handle(), levels.m_leafNodes.handle(), order.handle(),
                    triangles.handle(), start.handle(), end.handle(), meshRadius.handle(), counters.handle(),
                    leafCount);
    if (motions)
    {
        m_movingLeaves.launch(device, leafCount, kGroup, nodes.handle(), levels.m_leafNodes.handle(), order.handle(),
                              triangles.handle(), start.handle(), end.handle(), meshRadius.handle(),
                              motions->m_motions.handle(), cl_uint(motions->m_count), motions->m_thickness.handle(),
                              cl_uint(motions->m_obstacleMeshes), leafCount);
    }
    for (std::size_t height = 1; height <= levels.m_launched; ++height)
    {
        const BvhHeight& level = layout.m_heights[height];
        m_level.launch(device, level.m_count, kGroup, nodes.handle(), cl_uint(level.m_first), cl_uint(level.m_count));
    }
    if (levels.m_climbed > 0)
    {
        m_top.launch(device, kClimbGroup, kClimbGroup, nodes.handle(), levels.m_table.handle(),
                     cl_uint(levels.m_climbed));
    }
}

void RefitStage::warmUp(Device& device, Buffer<BvhNode>& nodes)
{
    Buffer<cl_uint> table;
    table.reserve(device, 2);
    m_level.launch(device, kGroup, kGroup, nodes.handle(), cl_uint(0), cl_uint(0));
    m_top.launch(device, kClimbGroup, kClimbGroup, nodes.handle(), table.handle(), cl_uint(0));
    device.wait();
}
}  // namespace drape
