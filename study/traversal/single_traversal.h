// Traversal::Single: one work-group with a queue in local memory that spills into global memory.
#pragma once

#include "study/traversal/device_traversal.h"

namespace drape
{
class SingleTraversal : public DeviceTraversal
{
public:
    // spill: pairs that may wait in global memory, for a start. Few do: the latest are taken back first.
    SingleTraversal(Device& device, const cl::Program& program, std::size_t spill = 1 << 14);

    void setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle) override;
    void enqueue(Device& device, const TraversalStep& step) override;
    bool grow(Device& device, const TraversalCounters& counters, bool& limitReached) override;

private:
    BoundKernel<kernels::broadPhaseSingle> m_traverse;
    Buffer<NodePair> m_spill;
    cl_uint m_clothRoot = 0, m_obstacleRoot = 0;
};
}  // namespace drape
