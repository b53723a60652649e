#include "broad_phase.h"

#include "kernels/lib/dop.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 32;
// Work-items that keep one compute unit busy: a GPU hides latency with many, a CPU evens out unequal subtrees with
// some.
constexpr std::size_t kItemsPerUnitGpu = 1024;
constexpr std::size_t kItemsPerUnitCpu = 128;

struct NodePair
{
    std::uint32_t m_cloth;
    std::uint32_t m_obstacle;
};

// The heights whose node pairs are the traversals' starts: down from the roots until there are enough, cloth first.
struct StartHeights
{
    BvhHeight m_cloth;
    BvhHeight m_obstacle;
};

StartHeights startHeights(const Device& device, const BvhLayout& cloth, const BvhLayout& obstacle)
{
    const std::size_t wanted = device.computeUnits() * (device.isGpu() ? kItemsPerUnitGpu : kItemsPerUnitCpu);
    std::size_t a = cloth.m_heights.size() - 1, b = obstacle.m_heights.size() - 1;
    while (a > 0 && cloth.m_heights[a].m_count < wanted)
        --a;
    while (b > 0 && std::size_t(cloth.m_heights[a].m_count) * obstacle.m_heights[b].m_count < wanted)
        --b;
    return {cloth.m_heights[a], obstacle.m_heights[b]};
}
}  // namespace

bool broadPhaseOnHost(const BroadPhaseSide& cloth, const BroadPhaseSide& obstacle, const std::vector<float>& thickness,
                      std::size_t obstacleMeshes, std::vector<Candidate>& candidates, std::size_t limit)
{
    candidates.clear();
    if (cloth.m_layout.nodeCount() == 0 || obstacle.m_layout.nodeCount() == 0) return true;
    NodePair stack[DRAPE_STACK_DEPTH];
    std::uint32_t depth = 0;
    stack[depth++] = NodePair{cloth.m_layout.root(), obstacle.m_layout.root()};
    while (depth > 0)
    {
        const NodePair pair = stack[--depth];
        const BvhNode& a = cloth.m_nodes[pair.m_cloth];
        const BvhNode& b = obstacle.m_nodes[pair.m_obstacle];
        if (!nodesOverlap(&a, &b)) continue;
        if (a.m_count == 0 && b.m_count == 0)
        {
            const Candidate candidate = {cloth.m_order[a.m_first], obstacle.m_order[b.m_first]};
            const std::size_t clothMesh = cloth.m_triangles[candidate.m_cloth].m_mesh;
            const std::size_t obstacleMesh = obstacle.m_triangles[candidate.m_obstacle].m_mesh;
            if (thickness[clothMesh * obstacleMeshes + obstacleMesh] < 0.0f) continue;
            if (candidates.size() == limit) return false;
            candidates.push_back(candidate);
            continue;
        }
        if (opensFirst(&a, &b))
        {
            for (std::uint32_t i = 0; i < a.m_count; ++i)
                stack[depth++] = NodePair{a.m_first + i, pair.m_obstacle};
        }
        else
        {
            for (std::uint32_t i = 0; i < b.m_count; ++i)
                stack[depth++] = NodePair{pair.m_cloth, b.m_first + i};
        }
    }
    return true;
}

void BroadPhaseStage::create(Device& device, const cl::Program& program)
{
    m_traverse.create(device, program, "broadPhaseTraverse");
}

void BroadPhaseStage::enqueue(Device& device, BroadPhaseBuffers cloth, BroadPhaseBuffers obstacle,
                              Buffer<float>& thickness, std::size_t obstacleMeshes, Buffer<Candidate>& candidates,
                              Buffer<StepCounters>& counters, std::size_t limit)
{
    if (cloth.m_layout.leafCount() == 0 || obstacle.m_layout.leafCount() == 0) return;
    const StartHeights start = startHeights(device, cloth.m_layout, obstacle.m_layout);
    m_traverse.launch(device, std::size_t(start.m_cloth.m_count) * start.m_obstacle.m_count, kGroup,
                      cloth.m_nodes.handle(), cloth.m_order.handle(), cloth.m_triangles.handle(),
                      cl_uint(start.m_cloth.m_first), cl_uint(start.m_cloth.m_count), obstacle.m_nodes.handle(),
                      obstacle.m_order.handle(), obstacle.m_triangles.handle(), cl_uint(start.m_obstacle.m_first),
                      cl_uint(start.m_obstacle.m_count), thickness.handle(), cl_uint(obstacleMeshes),
                      candidates.handle(), counters.handle(), cl_uint(candidates.capacity()), cl_uint(limit));
}
}  // namespace drape
