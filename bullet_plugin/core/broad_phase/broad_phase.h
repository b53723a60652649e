// Broad phase: all pairs of a cloth and an obstacle triangle whose volumes overlap and whose meshes are paired. The set
// is the same on device and host and for every Traversal, and equal to testing every pair of leaf volumes; its order is
// not defined on a device.
#pragma once

#include <functional>
#include <memory>

#include "device_traversal.h"
#include "drape/methods.h"
#include "host_traversal.h"

namespace drape
{
class BroadPhaseStage
{
public:
    // Gives the program of kernels/<name>.cl.
    using Programs = std::function<cl::Program(const char* name)>;

    // Builds what the traversal needs and nothing else.
    void create(Device& device, Traversal traversal, const Programs& program);

    // Takes one that was made already.
    void use(std::unique_ptr<DeviceTraversal> traversal) { m_traversal = std::move(traversal); }

    // As DeviceTraversal; hierarchies may be empty.
    void setObstacles(Device& device, const Hierarchy& obstacle);
    void setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle);
    void obstaclesRefitted(Device& device, Buffer<BvhNode>& nodes) { m_traversal->obstaclesRefitted(device, nodes); }
    void enqueue(Device& device, const TraversalStep& step);
    bool grow(Device& device, const StepCounters& counters, bool& limitReached)
    {
        return m_traversal->grow(device, counters, limitReached);
    }
    void accept(Device& device, const StepCounters& counters) { m_traversal->accept(device, counters); }

private:
    std::unique_ptr<DeviceTraversal> m_traversal;
    bool m_empty = true;
};
}  // namespace drape
