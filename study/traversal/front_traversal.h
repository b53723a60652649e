// Traversal::Front and Full: work-groups with a shared stack walk both hierarchies, from the front that the last step
// left or from fixed pairs of nodes.
//
// The front belongs to the topology of both hierarchies, not to positions: it stays exact under any motion and is
// dropped when the topology changes. One that outgrew its buffer is dropped too, after the buffer grew, and the next
// step starts from the fixed pairs: the candidates of a step never depend on the front that it writes.
#pragma once

#include "study/traversal/device_traversal.h"

namespace drape
{
class FrontTraversal : public DeviceTraversal
{
public:
    // keepFront: Front, else Full. frontPairs: room for a front, for a start.
    FrontTraversal(Device& device, const cl::Program& program, bool keepFront, std::size_t frontPairs = 1 << 16);

    // Drops the front.
    void setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle) override;
    void enqueue(Device& device, const TraversalStep& step) override;
    // The front that the step wrote becomes the next step's start.
    void accept(Device& device, const TraversalCounters& counters) override;

    bool hasFront() const { return m_hasFront; }

private:
    void reserveFront(Device& device, std::size_t pairs);
    // Pairs at which the next step starts.
    std::size_t startCount() const { return m_hasFront ? m_frontCount : m_startCount; }

    BoundKernel<kernels::broadPhaseFront> m_traverse;
    bool m_keepFront = false;
    // The cloths' links and order, then the obstacles'.
    Buffer<BvhLink> m_links;
    Buffer<cl_uint> m_orders;
    cl_uint m_obstacleLinks = 0, m_obstacleOrder = 0;  // first of the obstacles' entries
    Buffer<NodePair> m_start, m_front, m_nextFront;
    std::size_t m_startCount = 0, m_frontCount = 0;
    cl_uint m_floorDepth = 0;
    std::uint32_t m_step = 0;
    bool m_hasFront = false;
};
}  // namespace drape
