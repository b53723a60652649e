// The decay of a tree under refits, measured on the device, and when to rebuild.
//
// Cost: the areas of all nodes' boxes over the root's, as TreeQuality::m_cost up to the rounding of each node's share
// down to 2^-30. One launch that reads a third of the nodes; the same on the host and on every device.
#pragma once

#include "bullet_plugin/core/device/program.h"
#include "bullet_plugin/core/device/buffer.h"
#include "kernels/shared/mesh.h"

namespace drape
{
double treeCostOnHost(const std::vector<BvhNode>& nodes, std::uint32_t root);

class TreeCostStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Both return after enqueueing; cost() is valid once the device was waited for.
    void enqueue(Device& device, Buffer<BvhNode>& nodes, cl_uint nodeCount, cl_uint root);
    double cost() const;

private:
    Kernel m_sums;
    Buffer<cl_ulong> m_partial;
    std::vector<cl_ulong> m_read;
};

// Whether a tree that cost costAtBuild when it was built is due for a rebuild: when its cost is more than rebuildDecay
// times that; 0: never.
inline bool isDecayed(double cost, double costAtBuild, float rebuildDecay)
{
    return rebuildDecay > 0.0f && cost > double(rebuildDecay) * costAtBuild;
}
}  // namespace drape
