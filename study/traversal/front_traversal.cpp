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
    m_traverse.create(device, program);
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
    const std::vector<BvhLink> obstacleLinks = makeLinks(obstacle);
    std::vector<BvhLink> links = makeLinks(cloth);
    std::vector<cl_uint> orders = cloth.m_order;
    m_obstacleLinks = cl_uint(links.size());
    m_obstacleOrder = cl_uint(orders.size());
    links.insert(links.end(), obstacleLinks.begin(), obstacleLinks.end());
    orders.insert(orders.end(), obstacle.m_order.begin(), obstacle.m_order.end());
    const std::size_t perUnit = device.isGpu() ? kStartPerUnitGpu : kStartPerUnitCpu;
    const StartPairs start = makeStartPairs(cloth, obstacle, device.computeUnits() * perUnit);
    const WaitAtEnd wait(device);
    m_links.assign(device, links);
    m_orders.assign(device, orders);
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
    const FrontValues values = {
        step.list(),          m_obstacleLinks, m_obstacleOrder, cl_uint(startCount()),
        cl_uint(m_keepFront), raise,           m_floorDepth,    cl_uint(m_nextFront.capacity())};
    m_traverse.launch(device, groups * kGroup, kGroup, values, cloth.m_nodes, obstacle.m_nodes, m_links, m_orders,
                      cloth.m_triangles, obstacle.m_triangles, step.m_thickness, m_hasFront ? m_front : m_start,
                      m_nextFront, step.m_candidates, step.m_counters);
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
