#include "pair_traversal.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 32;
// Work-items that keep one compute unit busy: a GPU hides latency with many, a CPU evens out unequal subtrees with
// some.
constexpr std::size_t kItemsPerUnitGpu = 1024;
constexpr std::size_t kItemsPerUnitCpu = 128;
}  // namespace

void PairTraversal::setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle)
{
    const std::size_t perUnit = device.isGpu() ? kItemsPerUnitGpu : kItemsPerUnitCpu;
    const StartPairs start = makeStartPairs(cloth, obstacle, device.computeUnits() * perUnit);
    const WaitAtEnd wait(device);
    m_starts.assign(device, start.m_pairs);
    m_startCount = cl_uint(start.m_pairs.size());
}

void PairTraversal::enqueue(Device& device, const TraversalStep& step)
{
    const BroadPhaseBuffers &cloth = step.m_cloth, &obstacle = step.m_obstacle;
    m_traverse.launch(device, m_startCount, kGroup, cloth.m_nodes.handle(), cloth.m_order.handle(),
                      cloth.m_triangles.handle(), obstacle.m_nodes.handle(), obstacle.m_order.handle(),
                      obstacle.m_triangles.handle(), m_starts.handle(), m_startCount, step.m_thickness.handle(),
                      step.meshes(), step.m_candidates.handle(), step.m_counters.handle(), step.capacity(),
                      step.limit());
}
}  // namespace drape
