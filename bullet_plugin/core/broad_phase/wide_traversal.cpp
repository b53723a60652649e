#include "wide_traversal.h"

#include <algorithm>

namespace drape
{
namespace
{
constexpr std::size_t kGatherGroup = 64;
// Few leaves a group: a CPU's threads take groups as they come, which evens out leaves in and out of contact.
constexpr std::size_t kLeafGroup = 16;
// Eight pairs of a leaf and a wide node a round.
constexpr std::size_t kSharedGroup = 64;
// Groups wanted per compute unit before a group takes more than one leaf: twice as many as a GPU's unit holds at a
// time.
constexpr std::size_t kGroupsPerUnit = 32;
// More leaves a group give its work-items nothing more to do at a time.
constexpr std::size_t kMostLeavesPerGroup = 16;
}  // namespace

WideTraversal::WideTraversal(Device& device, const cl::Program& program, bool groups) : m_groups(groups)
{
    m_gather.create(device, program, "wideGather");
    m_traverse.create(device, program, groups ? "broadPhaseWideGroups" : "broadPhaseWideLeaves");
}

void WideTraversal::setObstacles(Device& device, const Hierarchy& obstacle)
{
    const WideLayout layout = makeWideLayout(obstacle);
    const WaitAtEnd wait(device);
    m_nodes.assign(device, layout.m_nodes);
    m_sources.assign(device, layout.m_sources);
    m_slots = cl_uint(layout.m_sources.size());
}

void WideTraversal::setTopology(Device& device, const Hierarchy& cloth, const Hierarchy&)
{
    const std::vector<std::uint32_t> leaves = leafNodes(cloth);
    const WaitAtEnd wait(device);
    m_leaves.assign(device, leaves);
    m_leafCount = cl_uint(leaves.size());
}

void WideTraversal::obstaclesRefitted(Device& device, Buffer<BvhNode>& obstacleNodes)
{
    m_gather.launch(device, m_slots, kGatherGroup, obstacleNodes.handle(), m_sources.handle(), m_slots,
                    m_nodes.handle());
}

void WideTraversal::enqueue(Device& device, const TraversalStep& step)
{
    if (m_groups) return enqueueGroups(device, step);
    m_traverse.launch(device, m_leafCount, kLeafGroup, step.m_cloth.m_nodes.handle(), step.m_cloth.m_order.handle(),
                      step.m_cloth.m_triangles.handle(), m_leaves.handle(), m_leafCount, m_nodes.handle(),
                      step.m_obstacle.m_triangles.handle(), step.m_thickness.handle(), step.meshes(),
                      step.m_candidates.handle(), step.m_counters.handle(), step.capacity(), step.limit());
}

void WideTraversal::enqueueGroups(Device& device, const TraversalStep& step)
{
    const std::size_t wanted = device.computeUnits() * kGroupsPerUnit;
    const std::size_t share = std::clamp(m_leafCount / wanted, std::size_t(1), kMostLeavesPerGroup);
    const std::size_t groups = (m_leafCount + share - 1) / share;
    m_traverse.launch(device, groups * kSharedGroup, kSharedGroup, step.m_cloth.m_nodes.handle(),
                      step.m_cloth.m_order.handle(), step.m_cloth.m_triangles.handle(), m_leaves.handle(), m_leafCount,
                      cl_uint(share), m_nodes.handle(), step.m_obstacle.m_triangles.handle(), step.m_thickness.handle(),
                      step.meshes(), step.m_candidates.handle(), step.m_counters.handle(), step.capacity(),
                      step.limit());
}
}  // namespace drape
