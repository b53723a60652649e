#include "study/traversal/front_traversal.h"

#include <algorithm>

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
// Groups per compute unit: as many as a GPU's unit holds at a time, and enough on a CPU to even out unequal ones.
constexpr std::size_t kGroupsPerUnitGpu = 32;
constexpr std::size_t kGroupsPerUnitCpu = 16;
// Pairs to start from without a front: one a work-item of half the groups that a GPU holds. A front never climbs above
// them, so that no step has to go down from a few pairs.
constexpr std::size_t kStartPerUnitGpu = 1024;
constexpr std::size_t kStartPerUnitCpu = 128;
// Steps from one in which the front climbs to the next. Climbing tests a parent for most pairs of the front; pairs that
// came apart and stay cost a test a step.
constexpr std::uint32_t kRaiseInterval = 8;
}  // namespace

FrontTraversal::FrontTraversal(Device& device, const cl::Program& program, bool keepFront, std::size_t frontPairs)
    : m_keepFront(keepFront)
{
    m_traverse.create(device, program, "broadPhaseFront");
    reserveFront(device, keepFront ? frontPairs : 1);
}

void FrontTraversal::reserveFront(Device& device, std::size_t pairs)
{
    m_hasFront = false;
    m_front = Buffer<NodePair>();
    m_nextFront = Buffer<NodePair>();
    m_front.reserve(device, pairs);
    m_nextFront.reserve(device, pairs);
}

void FrontTraversal::setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle)
{
    m_hasFront = false;
    const std::vector<BvhLink> clothLinks = makeLinks(cloth), obstacleLinks = makeLinks(obstacle);
    const std::size_t perUnit = device.isGpu() ? kStartPerUnitGpu : kStartPerUnitCpu;
    const StartPairs start = makeStartPairs(cloth, obstacle, device.computeUnits() * perUnit);
    const WaitAtEnd wait(device);
    m_clothLinks.assign(device, clothLinks);
    m_obstacleLinks.assign(device, obstacleLinks);
    m_start.assign(device, start.m_pairs);
    m_startCount = start.m_pairs.size();
    m_floorDepth = start.m_depth;
}

void FrontTraversal::enqueue(Device& device, const TraversalStep& step)
{
    const BroadPhaseBuffers &cloth = step.m_cloth, &obstacle = step.m_obstacle;
    const std::size_t most = device.computeUnits() * (device.isGpu() ? kGroupsPerUnitGpu : kGroupsPerUnitCpu);
    const std::size_t groups = std::min(most, (startCount() + kGroup - 1) / kGroup);
    const cl_uint raise = m_hasFront && m_step % kRaiseInterval == 0;
    m_traverse.launch(device, groups * kGroup, kGroup, cloth.m_nodes.handle(), m_clothLinks.handle(),
                      cloth.m_order.handle(), cloth.m_triangles.handle(), obstacle.m_nodes.handle(),
                      m_obstacleLinks.handle(), obstacle.m_order.handle(), obstacle.m_triangles.handle(),
                      step.m_thickness.handle(), step.meshes(), (m_hasFront ? m_front : m_start).handle(),
                      cl_uint(startCount()), m_floorDepth, cl_uint(m_keepFront), raise, m_nextFront.handle(),
                      cl_uint(m_nextFront.capacity()), step.m_candidates.handle(), step.m_counters.handle(),
                      step.capacity(), step.limit());
}

void FrontTraversal::accept(Device& device, const TraversalCounters& counters)
{
    ++m_step;
    if (!m_keepFront) return;
    if (counters.m_front > m_nextFront.capacity())
    {
        const std::size_t wanted = std::size_t(counters.m_front) + counters.m_front / 4;
        m_hasFront = false;
        if (wanted * sizeof(NodePair) <= device.maxAllocationBytes()) reserveFront(device, wanted);
        return;
    }
    std::swap(m_front, m_nextFront);
    m_frontCount = counters.m_front;
    m_hasFront = true;
}
}  // namespace drape
