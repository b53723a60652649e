// Traversal::Pairs: a work-item per pair of subtrees walks both hierarchies with a stack of its own.
#pragma once

#include "device_traversal.h"

namespace drape
{
class PairTraversal : public DeviceTraversal
{
public:
    PairTraversal(Device& device, const cl::Program& program)
    {
        m_traverse.create(device, program, "broadPhaseTraverse");
    }

    void setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle) override;
    void enqueue(Device& device, const TraversalStep& step) override;

private:
    Kernel m_traverse;
    Buffer<NodePair> m_starts;
    cl_uint m_startCount = 0;
};
}  // namespace drape
