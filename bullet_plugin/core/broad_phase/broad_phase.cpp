#include "broad_phase.h"

#include "kernels/lib/dop.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
// Work-items that fill one compute unit of a GPU; a leaf's traversal is split among subtrees until there are that many.
constexpr std::size_t kItemsPerUnit = 1024;

void traverseOnHost(const Dop& dop, std::uint32_t cloth, const BroadPhaseSide& obstacle, const float* pairs,
                    std::vector<Candidate>& candidates)
{
    std::uint32_t stack[DRAPE_STACK_DEPTH];
    std::uint32_t depth = 0;
    stack[depth++] = obstacle.m_layout.root();
    while (depth > 0)
    {
        const BvhNode& node = obstacle.m_nodes[stack[--depth]];
        if (!dopOverlaps(&dop, &node)) continue;
        if (node.m_count > 0)
        {
            for (std::uint32_t i = node.m_count; i > 0; --i) stack[depth++] = node.m_first + i - 1;
            continue;
        }
        const std::uint32_t triangle = obstacle.m_order[node.m_first];
        if (pairs[obstacle.m_triangles[triangle].m_mesh] >= 0.0f) candidates.push_back(Candidate{cloth, triangle});
    }
}

// The height at which traversals start: the root on a CPU, on a GPU the first with enough subtrees to fill it.
std::size_t startHeight(const Device& device, const BvhLayout& cloth, const BvhLayout& obstacle)
{
    std::size_t height = obstacle.m_heights.size() - 1;
    if (!device.isGpu()) return height;
    const std::size_t wanted = kItemsPerUnit * device.computeUnits();
    while (height > 0 && std::size_t(cloth.leafCount()) * obstacle.m_heights[height].m_count < wanted) --height;
    return height;
}
}  // namespace

void broadPhaseOnHost(const BroadPhaseSide& cloth, const BroadPhaseSide& obstacle, const std::vector<float>& thickness,
                      std::size_t obstacleMeshes, std::vector<Candidate>& candidates)
{
    candidates.clear();
    if (obstacle.m_layout.nodeCount() == 0) return;
    for (std::uint32_t leaf = 0; leaf < cloth.m_layout.leafCount(); ++leaf)
    {
        Dop dop;
        dopLoad(&dop, &cloth.m_nodes[leaf]);
        const std::uint32_t triangle = cloth.m_order[leaf];
        const float* pairs = thickness.data() + cloth.m_triangles[triangle].m_mesh * obstacleMeshes;
        traverseOnHost(dop, triangle, obstacle, pairs, candidates);
    }
}

void BroadPhaseStage::create(Device& device, const cl::Program& program)
{
    m_traverse.create(device, program, "broadPhaseTraverse");
}

void BroadPhaseStage::enqueue(Device& device, BroadPhaseBuffers cloth, BroadPhaseBuffers obstacle,
                              Buffer<float>& thickness, std::size_t obstacleMeshes, Buffer<Candidate>& candidates,
                              Buffer<StepCounters>& counters)
{
    if (cloth.m_layout.leafCount() == 0 || obstacle.m_layout.leafCount() == 0) return;
    const BvhHeight& start = obstacle.m_layout.m_heights[startHeight(device, cloth.m_layout, obstacle.m_layout)];
    const cl_uint leaves = cloth.m_layout.leafCount();
    m_traverse.launch(device, std::size_t(leaves) * start.m_count, kGroup, cloth.m_nodes.handle(), cloth.m_order.handle(),
                      cloth.m_triangles.handle(), leaves, obstacle.m_nodes.handle(), obstacle.m_order.handle(),
                      obstacle.m_triangles.handle(), cl_uint(start.m_first), cl_uint(start.m_count), thickness.handle(),
                      cl_uint(obstacleMeshes), candidates.handle(), counters.handle(), cl_uint(candidates.capacity()));
}
}  // namespace drape
