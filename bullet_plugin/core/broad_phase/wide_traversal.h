// Traversal::WideLeaves and WideGroups: cloth triangles against wide nodes of the obstacles' hierarchy.
#pragma once

#include "device_traversal.h"
#include "wide_layout.h"

namespace drape
{
class WideTraversal : public DeviceTraversal
{
public:
    // groups: WideGroups, else WideLeaves.
    WideTraversal(Device& device, const cl::Program& program, bool groups);

    void setObstacles(Device& device, const Hierarchy& obstacle) override;
    void obstaclesRefitted(Device& device, Buffer<BvhNode>& obstacleNodes) override;
    void setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle) override;
    void enqueue(Device& device, const TraversalStep& step) override;

private:
    void enqueueGroups(Device& device, const TraversalStep& step);

    Kernel m_gather, m_traverse;
    bool m_groups = false;
    Buffer<WideNode> m_nodes;
    Buffer<cl_uint> m_sources, m_leaves;
    cl_uint m_slots = 0, m_leafCount = 0;
};
}  // namespace drape
