// Refit: new volumes for a hierarchy whose topology stays, on the device or the host. Volumes are exact minima and
// maxima of the padded leaves, so both give the same bits.
#pragma once

#include <vector>

#include "bullet_plugin/core/device/bound_kernel.h"
#include "bullet_plugin/core/probe/bvh_layout.h"
#include "kernels/queries/queries_bindings.h"
#include "kernels/shared/mesh.h"

namespace drape
{
// nodes: links set. order: triangle per leaf. start, end: m, x y z per vertex (may be the same). meshRadius: m per mesh
// slot, negative to leave a mesh out. Adds invalid vertices (positionIsValid) to invalidNodes.
void refitOnHost(std::vector<BvhNode>& nodes, const BvhLayout& layout, const std::vector<std::uint32_t>& order,
                 const std::vector<Triangle>& triangles, const float* start, const float* end,
                 const std::vector<float>& meshRadius, std::size_t& invalidNodes);

class RefitStage
{
public:
    void create(Device& device, const cl::Program& program);

    // A layout as the device reads it, and where the one-group climb begins.
    struct Levels
    {
        Buffer<NodeRange> m_table;
        std::size_t m_launched = 0;  // heights 1 … m_launched get a launch each
        std::size_t m_climbed = 0;   // the rest, in one group
    };
    void makeLevels(Device& device, const BvhLayout& layout, Levels& levels) const;

    // Returns after enqueueing. Adds to counters' invalid nodes.
    void enqueue(Device& device, const BvhLayout& layout, Levels& levels, Buffer<BvhNode>& nodes,
                 Buffer<cl_uint>& order, Buffer<Triangle>& triangles, Buffer<float>& start, Buffer<float>& end,
                 Buffer<float>& meshRadius, Buffer<StepCounters>& counters);

private:
    BoundKernel<kernels::refitLeaves> m_leaves;
    BoundKernel<kernels::refitLevel> m_level;
    BoundKernel<kernels::refitTop> m_top;
};
}  // namespace drape
