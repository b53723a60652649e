// Traversal::Leaves: a work-item per cloth triangle walks the obstacles' hierarchy with a stack of its own.
#pragma once

#include "device_traversal.h"

namespace drape
{
class LeafTraversal : public DeviceTraversal
{
public:
    LeafTraversal(Device& device, const cl::Program& program)
    {
        m_traverse.create(device, program, "broadPhaseLeaves");
    }

    void setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle) override;
    void enqueue(Device& device, const TraversalStep& step) override;

private:
    Kernel m_traverse;
    Buffer<cl_uint> m_leaves;
    cl_uint m_leafCount = 0, m_obstacleRoot = 0;
};
}  // namespace drape
