#include "leaf_traversal.h"

namespace drape
{
namespace
{
// One warp: leaves that are neighbours walk alike.
constexpr std::size_t kGroup = 32;
}  // namespace

void LeafTraversal::setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle)
{
    const std::vector<std::uint32_t> leaves = leafNodes(cloth);
    const WaitAtEnd wait(device);
    m_leaves.assign(device, leaves);
    m_leafCount = cl_uint(leaves.size());
    m_obstacleRoot = obstacle.m_root;
}

void LeafTraversal::enqueue(Device& device, const TraversalStep& step)
{
    const BroadPhaseBuffers &cloth = step.m_cloth, &obstacle = step.m_obstacle;
    m_traverse.launch(device, m_leafCount, kGroup, cloth.m_nodes.handle(), cloth.m_order.handle(),
                      cloth.m_triangles.handle(), m_leaves.handle(), m_leafCount, obstacle.m_nodes.handle(),
                      obstacle.m_order.handle(), obstacle.m_triangles.handle(), m_obstacleRoot,
                      step.m_thickness.handle(), step.meshes(), step.m_candidates.handle(), step.m_counters.handle(),
                      step.capacity(), step.limit());
}
}  // namespace drape
