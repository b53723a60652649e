#include "study/traversal/single_traversal.h"

namespace drape
{
namespace
{
// The largest group that may be assumed: there is only one.
constexpr std::size_t kGroup = 256;
}  // namespace

SingleTraversal::SingleTraversal(Device& device, const cl::Program& program, std::size_t spill)
{
    m_traverse.create(device, program);
    m_spill.reserve(device, spill);
}

void SingleTraversal::setTopology(Device&, const Hierarchy& cloth, const Hierarchy& obstacle)
{
    m_clothRoot = cloth.m_root;
    m_obstacleRoot = obstacle.m_root;
}

void SingleTraversal::enqueue(Device& device, const TraversalStep& step)
{
    const BroadPhaseBuffers &cloth = step.m_cloth, &obstacle = step.m_obstacle;
    const SingleValues values = {step.list(), m_clothRoot, m_obstacleRoot, cl_uint(m_spill.capacity())};
    m_traverse.launch(device, kGroup, kGroup, values, cloth.m_nodes, cloth.m_order, cloth.m_triangles, obstacle.m_nodes,
                      obstacle.m_order, obstacle.m_triangles, step.m_thickness, step.m_candidates, step.m_counters,
                      m_spill);
}

bool SingleTraversal::grow(Device& device, const TraversalCounters& counters, bool& limitReached)
{
    if (counters.m_spill <= m_spill.capacity()) return false;
    // Takes twice the demand seen, so that few runs are needed: pairs that were lost would have opened further.
    const std::size_t most = device.maxAllocationBytes() / sizeof(NodePair);
    limitReached = counters.m_spill > most;
    if (!limitReached) m_spill.reserve(device, std::min(2 * std::size_t(counters.m_spill), most));
    return true;
}
}  // namespace drape
