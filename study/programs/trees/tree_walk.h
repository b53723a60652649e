// Counts the work of a cloth's step in a tree: every cloth triangle looks for its candidates from the root.
#pragma once

#include <string>
#include <vector>

#include "study/programs/trees/tree_input.h"
#include "study/traversal/hierarchy.h"

namespace drape::bench
{
struct Found
{
    std::size_t m_tests = 0;  // tests of volumes
    std::vector<Candidate> m_candidates;

    // Sorts the candidates: their order is not defined.
    std::string hash();
};

void walkOnHost(const Hierarchy& obstacle, const ClothQueries& cloth, Found& found);

// Walks on a device, with a work-item per cloth triangle.
class DeviceWalk
{
public:
    // room: for candidates.
    DeviceWalk(Device& device, const Hierarchy& obstacle, const ClothQueries& cloth, std::size_t room);

    // Enqueues a walk over the hierarchy's nodes and order on the device, and waits. Host-to-host ms; kernelMs: of its
    // kernels.
    double run(Buffer<BvhNode>& nodes, Buffer<cl_uint>& order, double& kernelMs);
    // Returns the result of the last walk; m_tests is not counted.
    Found found();

private:
    Device& m_device;
    Kernel m_walk;
    cl_uint m_root, m_count;
    Buffer<BvhNode> m_volumes;  // volumes of the cloth's triangles
    Buffer<Candidate> m_candidates;
    Buffer<TraversalCounters> m_counters;
};
}  // namespace drape::bench
