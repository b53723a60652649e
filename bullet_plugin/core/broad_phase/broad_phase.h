// Broad phase: all pairs of a cloth and an obstacle triangle whose volumes overlap and whose meshes are paired. The set
// is the same on device and host, and equal to testing every pair of leaf volumes; its order is not defined on a
// device.
#pragma once

#include <vector>

#include "bullet_plugin/core/bvh/bvh_layout.h"
#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"

namespace drape
{
// One side as the traversal sees it.
struct BroadPhaseSide
{
    const std::vector<BvhNode>& m_nodes;
    const BvhLayout& m_layout;
    const std::vector<std::uint32_t>& m_order;
    const std::vector<Triangle>& m_triangles;
};

// Most candidates that a step can have: all fifteen feature tests of each stay countable in 32 bits.
constexpr std::size_t kMostCandidates = std::size_t(1) << 28;

// thickness: m, cloth slots × obstacle slots, negative where the pair is not tested. False when there are more than
// limit candidates; the list is incomplete then.
bool broadPhaseOnHost(const BroadPhaseSide& cloth, const BroadPhaseSide& obstacle, const std::vector<float>& thickness,
                      std::size_t obstacleMeshes, std::vector<Candidate>& candidates,
                      std::size_t limit = kMostCandidates);

struct BroadPhaseBuffers
{
    Buffer<BvhNode>& m_nodes;
    Buffer<cl_uint>& m_order;
    Buffer<Triangle>& m_triangles;
    const BvhLayout& m_layout;
};

class BroadPhaseStage
{
public:
    void create(Device& device, const cl::Program& program);

    // Returns after enqueueing. counters' candidates must be zero; they count the demand, also past the list's
    // capacity. The count is exact up to limit; a greater one says only that there are more.
    void enqueue(Device& device, BroadPhaseBuffers cloth, BroadPhaseBuffers obstacle, Buffer<float>& thickness,
                 std::size_t obstacleMeshes, Buffer<Candidate>& candidates, Buffer<StepCounters>& counters,
                 std::size_t limit = kMostCandidates);

private:
    Kernel m_traverse;
};
}  // namespace drape
